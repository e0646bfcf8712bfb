#include "closed_loop/check/machine_causes.h"

#include "closed_loop/machine/machine_fit.h"
#include "closed_loop/machine/machine_noise.h"
#include "core/units.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Tolerances that a machine file does not state, 1 sigma: an angle sensor is set to half a degree,
// a transmitter is of class 0.5 of its valve's relief pressure, its span known to a hundredth; a
// gateway hands on what it has within ten milliseconds.
static const double zero_rad    = 0.5 * DIG_RAD_PER_DEG;
static const double span_share  = 0.01;
static const double class_share = 0.005;
static const double late_s      = 0.01;
// An inertia is known to a fifth.
static const double inertia_share = 0.2;

// 1 sigma of a cause that is wrong.
static const double wrong_rad    = 10.0 * DIG_RAD_PER_DEG;
static const double wrong_share  = 0.2;  // of a span
static const double wrong_weight = 0.45; // of a weight
static const double wrong_Pa     = 3e6;
static const double wrong_late_s = 0.1;

// The parameters of the effects, in the order of estimator/effects/.
enum { OF_A_SEAL = 4, COULOMB = 0, STRIBECK = 3, GAINS = 6, SEALS = 12 };

// A link's weight and where it lies are known together.
static double weight_tolerance_kg(const struct dig_machine *const machine, const size_t joint)
{
    const struct dig_link *const link = &machine->link[joint];

    const double lies_m = dig_vec2_norm(link->com_m);
    const double share =
        lies_m > 0.0 ? machine->tolerance.com_share * link->length_m / lies_m : 0.0;
    return link->mass_kg * hypot(machine->tolerance.mass_share, share);
}

static int at_joint(const enum dig_cause_kind kind, const size_t joint)
{
    return (int)((size_t)kind * DIG_JOINTS + joint);
}

// The cause that a column belongs to (-1: none), and 1 sigma of its prior: as allowed and as a
// cause, in the unit of the column's scale (docs/numerics/machine_side.md).
struct meaning {
    int    cause;
    double tolerance, wrong;
};

static struct meaning meaning_of(const struct dig_machine *const      machine,
                                 const struct dig_lines_column *const column)
{
    static const enum dig_joint drive[DIG_JOINTS] = { DIG_JOINT_BUCKET, DIG_JOINT_ARM,
                                                      DIG_JOINT_BOOM };
    const size_t                p                 = column->parameter;
    if (column->effect == DIG_EFFECT_UNLISTED && p >= DIG_FILE_LINKS) {
        const size_t j = (p - DIG_FILE_LINKS) / 3;
        return (struct meaning){ at_joint(DIG_CAUSE_WEIGHT, j), weight_tolerance_kg(machine, j),
                                 wrong_weight * machine->link[j].mass_kg };
    }
    if (column->effect == DIG_EFFECT_ANGLE_OFFSET) {
        return (struct meaning){ at_joint(DIG_CAUSE_ZERO, p), zero_rad, wrong_rad };
    }
    if (column->effect == DIG_EFFECT_PRESSURE_OFFSET) {
        const size_t j = p % GAINS / DIG_CHAMBERS;
        return p < GAINS
                   ? (struct meaning){ at_joint(DIG_CAUSE_OFFSET, j),
                                       class_share * machine->cylinder[j].relief_Pa, wrong_Pa }
                   : (struct meaning){ at_joint(DIG_CAUSE_FACTOR, j), span_share, wrong_share };
    }
    if (column->effect == DIG_EFFECT_SENSOR_DELAY) {
        return (struct meaning){ (int)DIG_CAUSE_DELAY, late_s, wrong_late_s };
    }
    double tolerance = 0.0; // a payload is the bucket's weight here
    if (column->effect == DIG_EFFECT_UNLISTED) {
        tolerance = DIG_FILE_LEVEL_SIGMA_rad;
    } else if (column->effect == DIG_EFFECT_LINKAGE_GEOMETRY) {
        tolerance = machine->tolerance.pin_m;
    } else if (column->effect == DIG_EFFECT_BUCKET_INERTIA) {
        tolerance = inertia_share * machine->link[DIG_JOINT_BUCKET].inertia_kgm2;
    } else if (column->effect == DIG_EFFECT_CYLINDER_FRICTION && p < SEALS) {
        tolerance = p % OF_A_SEAL == COULOMB
                        ? dig_cylinder_seal_N(&machine->cylinder[drive[p / OF_A_SEAL]])
                    : p % OF_A_SEAL == STRIBECK ? 0.0
                                                : column->scale;
    }
    return (struct meaning){ -1, tolerance, tolerance };
}

enum { ROUNDS = 8 };

static const double false_alarm = 0.01;

// Two sets of causes whose log evidence differs by less cannot be told apart.
static const double tie = 5.0;

// A chamber that changes a push by less than this share of what the other does is a return side.
static const double little_share = 0.5;

// A column is of the fit's set where its cause is named.
struct work {
    struct dig_air *air;
    struct dig_fit  fit;
    double          tolerance[DIG_CAUSES];
    unsigned        asked; // a bit each
};

static const struct dig_cylinder *cylinder_of(const struct work *const w, const size_t joint)
{
    return &w->air->machine.cylinder[joint];
}

// How much a drive's push changes by one of its chambers, N rms.
static double changes_N(const struct work *const w, const size_t joint, const size_t chamber)
{
    const struct dig_cylinder *const cylinder = cylinder_of(w, joint);

    const double m2   = chamber == DIG_CHAMBER_HEAD ? dig_cylinder_head_m2(cylinder)
                                                    : dig_cylinder_rod_m2(cylinder);
    const size_t s    = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + DIG_CHAMBERS * joint + chamber;
    double       n    = 0.0;
    double       mean = 0.0;
    double       sum2 = 0.0;
    for (size_t p = 0; p < w->air->points; p++) {
        if (w->air->point[p].sample.valid[s]) {
            const double Pa  = w->air->point[p].sample.value[s];
            const double off = Pa - mean;
            n += 1.0;
            mean += off / n;
            sum2 += off * (Pa - mean);
        }
    }
    return n > 0.0 ? m2 * sqrt(sum2 / n) : 0.0;
}

static bool is_return_side(const struct work *const w, const size_t joint, const size_t chamber)
{
    return changes_N(w, joint, chamber) < little_share * changes_N(w, joint, chamber ^ 1U);
}

static void set_widths(struct work *const w)
{
    for (size_t c = 0; c < w->fit.lines.columns; c++) {
        const struct dig_lines_column *const column = &w->fit.lines.column[c];

        const struct meaning meaning = meaning_of(&w->air->machine, column);
        const int            cause   = meaning.cause;

        w->fit.of[c]   = cause;
        w->fit.base[c] = meaning.tolerance / column->scale;
        w->fit.wide[c] = meaning.wrong / column->scale;
        if (cause < 0) {
            continue;
        }
        w->tolerance[cause] = meaning.tolerance;
        // Of a return side, whose pressure hardly changes, a factor is an offset.
        const bool factor  = cause / DIG_JOINTS == (int)DIG_CAUSE_FACTOR;
        const bool returns = factor && is_return_side(w, (size_t)cause % DIG_JOINTS,
                                                      column->parameter % DIG_CHAMBERS);
        if (((w->asked >> cause) & 1U) == 0 || returns) {
            w->fit.wide[c] = w->fit.base[c];
        }
    }
}

// The log evidence where these are named.
static double solve(struct work *const w, const unsigned named, const enum dig_fit_leave leave)
{
    double widths[DIG_LINES_COLUMNS_MAX];
    dig_fit_widths(&w->fit, named, 1.0, widths);
    return dig_fit_solve_each(&w->fit, widths, leave).log_evidence;
}

// Of causes that are asked for.
static double evidence(void *const context, const unsigned named)
{
    struct work *const w = context;
    return (named & ~w->asked) == 0 ? solve(w, named, DIG_FIT_NOTHING) : -(double)INFINITY;
}

// Sums the equations where the lines stand; s2 by what everything together leaves. A rod that
// stands may be held by what it rubs with at other values.
static void take_slopes(struct work *const w, const double rubs_at[])
{
    double stood[DIG_LINES_COLUMNS_MAX];
    memcpy(stood, w->fit.lines.at, w->fit.lines.columns * sizeof stood[0]);
    memmove(w->fit.lines.at, rubs_at, w->fit.lines.columns * sizeof stood[0]);
    (void)dig_lines_judge(&w->fit.lines);
    memcpy(w->fit.lines.at, stood, w->fit.lines.columns * sizeof stood[0]);
    dig_lines_update(&w->fit.lines, DIG_LINES_ALL);
    dig_fit_sum(&w->fit, NULL);
}

// The causes named, with the lines where they lead.
static unsigned find(struct work *const w)
{
    const struct dig_greedy  causes = { DIG_CAUSES, log(DIG_CAUSES / false_alarm), evidence, w };
    unsigned                 named  = 0;
    struct dig_machine_noise noise;
    double                   widths[DIG_LINES_COLUMNS_MAX];
    take_slopes(w, w->fit.lines.at);
    // Rows of valves that hunt scatter more than their sensors.
    (void)solve(w, (1U << DIG_CAUSES) - 1U, DIG_FIT_VALUES);
    dig_machine_noise_tell(&w->fit.lines, w->fit.at, &noise);
    (void)dig_machine_noise_widen(&noise, w->air);
    for (int round = 0; round < ROUNDS; round++) {
        const unsigned before = named;
        take_slopes(w, w->fit.at);
        named = dig_greedy_select(&causes, 0);
        (void)solve(w, named, DIG_FIT_VALUES);
        dig_fit_widths(&w->fit, named, 1.0, widths);
        // Near its end this moves within a fortieth of what is allowed.
        if (dig_fit_step(&w->fit, widths) < 0.025 && named == before) {
            break;
        }
    }
    take_slopes(w, w->fit.lines.at);
    return named;
}

// How sure a column is, with the covariance as last solved; 0 where it was not asked.
static double sureness(const struct work *const w, const size_t column)
{
    return w->fit.wide[column] > w->fit.base[column]
               ? 1.0 / fmax(w->fit.covariance[column * w->fit.lines.columns + column], 1e-12)
               : 0.0;
}

// How much a column counts in the figure of its cause, with the covariance as last solved.
static double share_of(const struct work *const w, const size_t cause, const size_t column)
{
    const struct dig_lines_column *const c     = &w->fit.lines.column[column];
    const size_t                         joint = cause % DIG_JOINTS;
    if (w->fit.of[column] != (int)cause) {
        return 0.0;
    }
    if (c->effect != DIG_EFFECT_PRESSURE_OFFSET) {
        return c->scale;
    }
    const size_t chamber = c->parameter % DIG_CHAMBERS;
    if (cause / DIG_JOINTS == DIG_CAUSE_FACTOR) {
        // The mean of the chambers that were asked, as sure as each is.
        const double mine  = sureness(w, column);
        const double other = sureness(w, chamber == DIG_CHAMBER_HEAD ? column + 1 : column - 1);
        return mine > 0.0 ? c->scale * mine / (mine + other) : 0.0;
    }
    return chamber == DIG_CHAMBER_HEAD ? c->scale
                                       : -c->scale * dig_cylinder_rod_m2(cylinder_of(w, joint)) /
                                             dig_cylinder_head_m2(cylinder_of(w, joint));
}

// Value and sigma of a cause where these are named.
static void value_of(struct work *const w, const unsigned named, const size_t k,
                     struct dig_cause *const cause)
{
    const size_t n = w->fit.lines.columns;
    (void)solve(w, named, DIG_FIT_COVARIANCE);
    double value    = 0.0;
    double variance = 0.0;
    for (size_t a = 0; a < n; a++) {
        const double share = share_of(w, k, a);
        value += share * w->fit.at[a];
        for (size_t b = 0; b < n && fabs(share) > 0.0; b++) {
            variance += share * share_of(w, k, b) * w->fit.covariance[a * n + b];
        }
    }
    cause->value = value;
    cause->sigma = sqrt(fmax(variance, 0.0));
}

// The best in the place of a cause that is named, if it does as well; or -1.
static int tied(struct work *const w, const unsigned named, const unsigned k)
{
    double most  = evidence(w, named) - tie;
    int    other = -1;
    for (unsigned o = 0; o < DIG_CAUSES; o++) {
        const unsigned instead = (named & ~(1U << k)) | 1U << o;
        const double   then = ((named >> o) & 1U) == 0 ? evidence(w, instead) : -(double)INFINITY;
        if (then > most) {
            most  = then;
            other = (int)o;
        }
    }
    return other;
}

static void figures(struct work *const w, const unsigned named, struct dig_cause cause[DIG_CAUSES])
{
    for (unsigned k = 0; k < DIG_CAUSES; k++) {
        const unsigned one = 1U << k;
        value_of(w, named | one, k, &cause[k]);
        cause[k].tolerance = w->tolerance[k];
        cause[k].named     = (named & one) != 0;
        cause[k].or_cause  = cause[k].named ? tied(w, named, k) : -1;
    }
    for (unsigned k = 0; k < DIG_CAUSES; k++) {
        const int o = cause[k].or_cause;
        if (o >= 0) {
            value_of(w, (named & ~(1U << k)) | 1U << (unsigned)o, (size_t)o, &cause[o]);
        }
    }
}

// Of each joint what is left, rms: in sigmas, and at the rod.
static void rests(const struct work *const w, const double at[], double rms[DIG_JOINTS],
                  double rms_N[DIG_JOINTS])
{
    double *const rest               = w->fit.lines.work;
    double        sum[DIG_JOINTS]    = { 0.0 };
    double        sum_N2[DIG_JOINTS] = { 0.0 };
    double        count[DIG_JOINTS]  = { 0.0 };
    dig_lines_rest(&w->fit.lines, at, rest);
    for (size_t r = 0; r < w->air->rows; r++) {
        sum[w->air->row[r].joint] += pow(w->fit.lines.trust[r] * rest[r], 2.0);
        sum_N2[w->air->row[r].joint] += pow(rest[r] * w->air->row[r].sigma_N, 2.0);
        count[w->air->row[r].joint] += 1.0;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        rms[j]   = count[j] > 0.0 ? sqrt(sum[j] / count[j]) : (double)NAN;
        rms_N[j] = count[j] > 0.0 ? sqrt(sum_N2[j] / count[j]) : (double)NAN;
    }
}

static enum dig_status work_make(struct dig_air *const air, struct work *const w)
{
    double scale[DIG_FILE_ERRORS] = { [DIG_FILE_LEVEL_rad] = DIG_RAD_PER_DEG };
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        scale[(size_t)DIG_FILE_LINKS + 3 * j] = air->machine.link[j].mass_kg;
    }
    w->air = air;
    return dig_fit_make(air, scale, &w->fit);
}

enum dig_status dig_causes_find(struct dig_air *const air, const bool moves[DIG_JOINTS],
                                struct dig_causes *const causes, struct dig_correction correction[])
{
    assert(air != NULL && moves != NULL && causes != NULL && correction != NULL);
    struct work           w      = { .asked = 1U << DIG_CAUSE_DELAY };
    const enum dig_status status = work_make(air, &w);
    if (status == DIG_OK) {
        double alone[DIG_LINES_COLUMNS_MAX];
        for (size_t k = 0; k < DIG_CAUSE_DELAY; k++) {
            w.asked |= moves[k % DIG_JOINTS] ? 1U << k : 0U;
        }
        set_widths(&w);
        const unsigned named = find(&w);
        rests(&w, w.fit.lines.absent, causes->rest_plain, causes->rest_N);
        rests(&w, w.fit.lines.at, causes->rest, causes->rest_N);
        figures(&w, named, causes->cause);
        // The causes alone: what is within its tolerance is no one's to mend.
        for (size_t c = 0; c < w.fit.lines.columns; c++) {
            const bool is_named = w.fit.of[c] >= 0 && ((named >> w.fit.of[c]) & 1U) != 0;
            alone[c]            = is_named ? w.fit.lines.at[c] : 0.0;
        }
        dig_lines_correct(&w.fit.lines, alone, correction);
    }
    dig_fit_finish(&w.fit);
    return status;
}
