#include "closed_loop/check/machine_reading.h"

#include "core/linkage.h"
#include "core/units.h"
#include "estimator/wrench/dynamics.h"
#include "estimator/wrench/statics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Instants that are looked at; poses that count as seen each for itself lie so far apart, and no
// more than so many of them count: what a file has wrong by some per cent it has in all of them.
enum { INSTANTS = 240, MOST_POSES = 100 };
static const double pose_rad = 0.1;

// What may be left of a load without anything being mixed up.
static const double allowed_share = 0.07;

// Taken off before: 1 sigma of an offset and of a factor of the load, and how far that goes.
static const double noise_share = 0.03; // of averaged readings
static const double offset_Pa   = 2e6;
static const double load_share  = 0.25;
static const double most_share  = 0.5;
static const double beyond_rad  = 3.0 * DIG_RAD_PER_DEG; // of a joint's range
static const double each_change = 5.0; // log odds against one thing being mixed up

// Angles beyond this, turns and all, are degrees.
static const double most_rad = 7.0;

// True pressure over what the column says: tens, and the units that are taken for each other (bar,
// kPa, MPa, Pa, psi).
static const double factors[] = { 1.0,  0.1, 10.0, 0.01, 100.0,     1e-3,     1e3,
                                  1e-5, 1e5, 1e-6, 1e6,  0.0689476, 14.50377, 6894.76 };
enum { FACTORS = sizeof factors / sizeof factors[0] };

static const enum dig_joint orders[][DIG_JOINTS] = {
    { 0, 1, 2 }, { 1, 0, 2 }, { 2, 1, 0 }, { 0, 2, 1 }, { 1, 2, 0 }, { 2, 0, 1 },
};
enum { ORDERS = sizeof orders / sizeof orders[0] };

// As the columns say.
static struct dig_reading plain_reading(void)
{
    struct dig_reading plain = { .degrees = false };
    for (int j = 0; j < DIG_JOINTS; j++) {
        plain.drive[j]  = (enum dig_joint)j;
        plain.factor[j] = 1.0;
    }
    return plain;
}

static double angle_rad(const struct dig_reading *const reading, const int joint, const double read)
{
    const double rad = reading->degrees ? DIG_RAD_PER_DEG * read : read;
    return (reading->turned[joint] ? -rad : rad) - reading->zero_rad[joint];
}

static size_t chamber_signal(const enum dig_joint joint, const size_t chamber)
{
    return (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + (size_t)DIG_CHAMBERS * (size_t)joint + chamber;
}

void dig_reading_apply(const struct dig_reading *const     reading,
                       struct dig_machine_recording *const recording)
{
    assert(reading != NULL && recording != NULL);
    for (size_t i = 0; i < recording->rows; i++) {
        const struct dig_sample  read = recording->row[i];
        struct dig_sample *const told = &recording->row[i];
        for (int j = 0; j < DIG_JOINTS; j++) {
            const size_t a = (size_t)DIG_SIGNAL_BOOM_rad + (size_t)j;
            told->value[a] = read.valid[a] ? angle_rad(reading, j, read.value[a]) : 0.0;
            for (size_t c = 0; c < DIG_CHAMBERS; c++) {
                const size_t to = chamber_signal((enum dig_joint)j, c);
                const size_t from =
                    chamber_signal(reading->drive[j], reading->swapped[j] ? 1U - c : c);
                told->value[to] = reading->factor[j] * read.value[from];
                told->valid[to] = read.valid[from];
            }
        }
    }
}

// What the search works on.
struct search {
    const struct dig_machine *machine;
    const bool               *moves;
    size_t                    n;
    double                    poses;            // that count
    bool                      told[DIG_JOINTS]; // columns that hold both pressures
    struct dig_air_point     *at;               // angles in radians
    struct dig_reading        best;
    size_t                    answer[DIG_READING_QUESTIONS][DIG_JOINTS];         // of the best
    double                    cost;                                              // of the best
    double                    least[DIG_READING_QUESTIONS][DIG_JOINTS][FACTORS]; // with each answer
};

bool dig_reading_in_degrees(const struct dig_machine_dig *const dig)
{
    assert(dig != NULL);
    double most = 0.0;
    for (size_t i = 0; i < dig->samples; i++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            most = fmax(most, fabs(dig->sample[i].value[(size_t)DIG_SIGNAL_BOOM_rad + j]));
        }
    }
    return most > most_rad;
}

// Points of the air, evenly, whose readings are averaged: of a light bucket one reading's noise is
// as large as its load.
static void pick(const struct dig_air *const air, const bool degrees, struct search *const s)
{
    const double unit = degrees ? DIG_RAD_PER_DEG : 1.0;
    double       way  = 0.0;
    const size_t most = air->points < INSTANTS ? air->points : INSTANTS;
    for (size_t i = 0; i < most; i++) {
        struct dig_air_point *const at = &s->at[s->n];
        *at = air->point[most > 1 ? i * (air->points - 1) / (most - 1) : 0];
        if (!dig_sample_has_moment(&at->sample)) {
            continue; // in a gap
        }
        const size_t k = s->n++;
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            at->sample.value[(size_t)DIG_SIGNAL_BOOM_rad + j] *= unit;
            at->rates.velocity_radps[j] *= unit;
            at->rates.acceleration_radps2[j] *= unit;
            way += k > 0 ? fabs(at->sample.value[(size_t)DIG_SIGNAL_BOOM_rad + j] -
                                s->at[k - 1].sample.value[(size_t)DIG_SIGNAL_BOOM_rad + j])
                         : 0.0;
        }
    }
    s->poses = fmin(1.0 + way / pose_rad, fmin(MOST_POSES, (double)s->n));
    for (size_t j = 0; j < DIG_JOINTS && s->n > 0; j++) {
        s->told[j] = s->at[0].sample.valid[chamber_signal((enum dig_joint)j, DIG_CHAMBER_HEAD)];
    }
}

// What each drive would have to push, N; NaN where its joint cannot stand like that.
static void loads(const struct search *const s, const struct dig_reading *const reading,
                  double load_N[INSTANTS][DIG_JOINTS])
{
    for (size_t k = 0; k < s->n; k++) {
        const struct dig_air_point *const at    = &s->at[k];
        struct dig_rates                  rates = at->rates;
        double                            rad[DIG_JOINTS];
        double                            mass_Nm[DIG_JOINTS];
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double sign = reading->turned[j] ? -1.0 : 1.0;
            rad[j] = sign * at->sample.value[DIG_SIGNAL_BOOM_rad + j] - reading->zero_rad[j];
            rates.velocity_radps[j] *= sign;
            rates.acceleration_radps2[j] *= sign;
        }
        const struct dig_front front = dig_front_place(s->machine, rad);
        const double           pitch_rad =
            at->sample.valid[DIG_SIGNAL_PITCH_rad] ? at->sample.value[DIG_SIGNAL_PITCH_rad] : 0.0;
        dig_dynamics_Nm(s->machine, &front, &rates, pitch_rad, mass_Nm);
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_link *const link = &s->machine->link[j];
            struct dig_lever             lever;
            const bool                   stands =
                rad[j] > link->min_rad - beyond_rad && rad[j] < link->max_rad + beyond_rad &&
                dig_lever_solve(s->machine, (enum dig_joint)j, rad[j], &lever) == DIG_OK;
            load_N[k][j] = stands ? -mass_Nm[j] / lever.arm_m : (double)NAN;
        }
    }
}

// Sums over instants of a load and of the push of one pair of chambers.
struct sums {
    double n, l, ll, p, pp, lp;
    double chambers; // of the squares of what either chamber pushes
};

static struct sums add_up(const struct search *const s, double load_N[INSTANTS][DIG_JOINTS],
                          const int joint, const int drive, const bool swapped)
{
    const struct dig_cylinder *const cylinder = &s->machine->cylinder[joint];

    const double head_m2 = cylinder->count * dig_cylinder_head_m2(cylinder);
    const double rod_m2  = cylinder->count * dig_cylinder_rod_m2(cylinder);
    const size_t head    = chamber_signal((enum dig_joint)drive, swapped ? 1U : 0U);
    const size_t rod     = chamber_signal((enum dig_joint)drive, swapped ? 0U : 1U);
    struct sums  sums    = { .n = 0.0 };
    for (size_t k = 0; k < s->n; k++) {
        const double l = load_N[k][joint];
        if (isfinite(l)) {
            const double *const Pa = s->at[k].sample.value;
            const double        p  = head_m2 * Pa[head] - rod_m2 * Pa[rod];
            sums.chambers += pow(head_m2 * Pa[head], 2.0) + pow(rod_m2 * Pa[rod], 2.0);
            sums.n += 1.0;
            sums.l += l;
            sums.ll += l * l;
            sums.p += p;
            sums.pp += p * p;
            sums.lp += l * p;
        }
    }
    return sums;
}

// Minus the log likelihood of one drive's readings: of e = push - load, less offset + share * load,
// both with normal priors, the share within its bounds. What may be left is a share of the push and
// some noise of its chambers: of what is read, whatever the factor.
static double misfit(const struct search *const s, const struct sums *const sums, const int joint,
                     const double factor)
{
    const struct dig_cylinder *const cylinder = &s->machine->cylinder[joint];

    const double each     = s->poses / (double)s->n; // poses an instant
    const double nothing  = 1.0 / (allowed_share * allowed_share);
    const double missing  = ((double)s->n - sums->n) * each * nothing;
    const double offset_N = cylinder->count * dig_cylinder_head_m2(cylinder) * offset_Pa;
    if (!(sums->n > 0.0)) {
        return missing;
    }
    const double p  = factor * sums->p;
    const double pp = factor * factor * sums->pp;
    const double lp = factor * sums->lp;
    const double read_N2 =
        allowed_share * allowed_share * sums->pp + noise_share * noise_share * sums->chambers;
    const double w = each * sums->n / fmax(factor * factor * read_N2, 1e-9);

    const double e  = p - sums->l;
    const double el = lp - sums->ll;
    const double ee = pp - 2.0 * lp + sums->ll;
    // The share that is best with its own best offset.
    const double oo = w * sums->n + 1.0 / (offset_N * offset_N);
    const double os = w * sums->l;
    const double ss = w * sums->ll + 1.0 / (load_share * load_share);
    const double share =
        fmin(fmax((w * el - os * w * e / oo) / (ss - os * os / oo), -most_share), most_share);
    const double offset = (w * e - os * share) / oo;
    const double chi2   = w * ee - 2.0 * offset * w * e - 2.0 * share * w * el +
                        oo * offset * offset + 2.0 * os * offset * share + ss * share * share;
    return 0.5 * (fmax(chi2, 0.0) + missing);
}

typedef double costs[DIG_JOINTS][DIG_JOINTS][2][FACTORS];

// How the pressures of one drive are read.
struct answer {
    size_t swapped, factor;
    double cost;
};

// What an answer of drive j costs where a factor is common to all, its chambers in the columns of
// another drive; a joint that hardly moves is read as its columns say.
static struct answer answer_of(const struct search *const s, costs cost, const size_t j,
                               const enum dig_joint drive, const size_t swapped,
                               const size_t factor, const size_t common)
{
    const bool   asked = s->moves[j] || (swapped == 0 && factor == common);
    const double more =
        (swapped > 0 ? each_change : 0.0) + (factor != common ? 2.0 * each_change : 0.0);
    return (struct answer){ swapped, factor,
                            asked ? cost[j][drive][swapped][factor] + more : (double)INFINITY };
}

static struct answer best_answer(const struct search *const s, costs cost, const size_t j,
                                 const enum dig_joint drive, const size_t common)
{
    struct answer best = { .cost = INFINITY };
    for (size_t w = 0; w < 2; w++) {
        for (size_t f = 0; f < FACTORS; f++) {
            const struct answer one = answer_of(s, cost, j, drive, w, f, common);
            best                    = one.cost < best.cost ? one : best;
        }
    }
    return best;
}

static void lower(double *const least, const double cost)
{
    *least = cost < *least ? cost : *least;
}

static void keep(struct search *const s, struct dig_reading reading,
                 const struct answer answer[DIG_JOINTS], const double cost)
{
    size_t given[DIG_READING_QUESTIONS][DIG_JOINTS];
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        reading.swapped[j]            = answer[j].swapped > 0;
        reading.factor[j]             = factors[answer[j].factor];
        given[DIG_READING_TURNED][j]  = reading.turned[j] ? 1 : 0;
        given[DIG_READING_DRIVE][j]   = reading.drive[j];
        given[DIG_READING_SWAPPED][j] = answer[j].swapped;
        given[DIG_READING_FACTOR][j]  = answer[j].factor;
        for (size_t q = 0; q < DIG_READING_QUESTIONS; q++) {
            lower(&s->least[q][j][given[q][j]], cost);
        }
    }
    if (cost < s->cost) {
        s->cost = cost;
        s->best = reading;
        memcpy(s->answer, given, sizeof given);
    }
}

// One order of the cylinders and one common factor: the best of every drive, and then one other
// answer at a time.
static void try_order(struct search *const s, const struct dig_reading *const reading,
                      const double before, costs cost, const size_t common)
{
    struct answer best[DIG_JOINTS];
    double        sum = before;
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        best[j] = best_answer(s, cost, j, reading->drive[j], common);
        sum += best[j].cost;
    }
    keep(s, *reading, best, sum);
    for (size_t i = 0; i < (size_t)DIG_JOINTS * 2 * FACTORS; i++) {
        const size_t        j    = i % DIG_JOINTS;
        const size_t        w    = i / DIG_JOINTS % 2;
        const size_t        f    = i / DIG_JOINTS / 2;
        const struct answer one  = answer_of(s, cost, j, reading->drive[j], w, f, common);
        const double        with = sum - best[j].cost + one.cost;
        lower(&s->least[DIG_READING_SWAPPED][j][w], with);
        lower(&s->least[DIG_READING_FACTOR][j][f], with);
    }
}

// All pressures for one reading of the angles: a unit common to all is one change, another of one
// drive is two.
static void try_pressures(struct search *const s, struct dig_reading reading, const double before,
                          costs cost)
{
    for (size_t common = 0; common < FACTORS; common++) {
        for (size_t o = 0; o < ORDERS; o++) {
            memcpy(reading.drive, orders[o], sizeof reading.drive);
            try_order(s, &reading,
                      before + (common > 0 ? each_change : 0.0) + (o > 0 ? each_change : 0.0), cost,
                      common);
        }
    }
}

// What every answer of a drive leaves. A drive that is not recorded says nothing, for or against.
static void fill_costs(const struct search *const s, double load_N[INSTANTS][DIG_JOINTS],
                       const int joint, const int drive, double cost[2][FACTORS])
{
    for (size_t w = 0; w < 2; w++) {
        struct sums sums = { .n = 0.0 };
        if (s->told[drive]) {
            sums = add_up(s, load_N, joint, drive, w > 0);
        }
        for (size_t f = 0; f < FACTORS; f++) {
            cost[w][f] = s->told[drive]   ? misfit(s, &sums, joint, factors[f])
                         : joint == drive ? 0.0
                                          : (double)INFINITY;
        }
    }
}

// One reading of the angles; what it costs to be no other than the columns'.
static void try_angles(struct search *const s, const struct dig_reading *const angles)
{
    double before = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        before += angles->turned[j] ? each_change : 0.0;
        before += fabs(angles->zero_rad[j]) > 0.0 ? each_change : 0.0;
    }
    double load_N[INSTANTS][DIG_JOINTS];
    costs  cost;
    loads(s, angles, load_N);
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int d = 0; d < DIG_JOINTS; d++) {
            fill_costs(s, load_N, j, d, cost[j][d]);
        }
    }
    try_pressures(s, *angles, before, cost);
}

// Every zero of one joint, turned or not.
static void try_zeros(struct search *const s, struct dig_reading angles, const int joint)
{
    const int turns = 180 / DIG_READING_ZERO_STEP_deg;
    for (int way = 0; way < 2; way++) {
        for (int z = -turns; z < turns; z++) {
            angles.turned[joint]   = way > 0;
            angles.zero_rad[joint] = (double)(z * DIG_READING_ZERO_STEP_deg) * DIG_RAD_PER_DEG;
            try_angles(s, &angles);
        }
    }
}

// The cost of the columns' own answer, where the best reading has another; else the least of the
// other answers.
static double other_of(const double cost[FACTORS], const size_t best, const size_t plain)
{
    double other = INFINITY;
    for (size_t a = 0; a < FACTORS; a++) {
        other = a == best ? other : fmin(other, cost[a]);
    }
    return best != plain ? cost[plain] : other;
}

static void write_finding(const struct search *const s, struct dig_reading_finding *const finding)
{
    finding->best = s->best;
    for (size_t q = 0; q < DIG_READING_QUESTIONS; q++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const size_t plain = q == DIG_READING_DRIVE ? j : 0;
            const double other = other_of(s->least[q][j], s->answer[q][j], plain);

            finding->plain[q][j]  = s->answer[q][j] == plain;
            finding->sigmas[q][j] = s->moves[j] && isfinite(other)
                                        ? sqrt(2.0 * fmax(other - s->cost, 0.0))
                                        : (double)NAN;
        }
    }
}

enum dig_status dig_reading_find(const struct dig_machine *const machine,
                                 const struct dig_air *const air, const bool degrees,
                                 const bool                        moves[DIG_JOINTS],
                                 struct dig_reading_finding *const finding)
{
    assert(machine != NULL && air != NULL && moves != NULL && finding != NULL);
    enum { PASSES = 3 };
    struct search s = { .machine = machine, .moves = moves };
    s.at            = malloc(INSTANTS * sizeof *s.at);
    if (s.at == NULL) {
        return DIG_ENOMEM;
    }
    struct dig_reading angles = plain_reading();
    angles.degrees            = degrees;
    pick(air, degrees, &s);
    s.cost = INFINITY;
    for (size_t i = 0; i < sizeof s.least / sizeof(double); i++) {
        (&s.least[0][0][0])[i] = INFINITY;
    }
    for (unsigned turned = 0; turned < 1U << DIG_JOINTS; turned++) {
        bool asked = true;
        for (int j = 0; j < DIG_JOINTS; j++) {
            angles.turned[j] = ((turned >> j) & 1U) != 0;
            asked            = asked && (moves[j] || !angles.turned[j]);
        }
        if (asked) {
            try_angles(&s, &angles);
        }
        for (int j = 0; j < DIG_JOINTS && asked; j++) {
            if (moves[j]) {
                try_zeros(&s, angles, j);
            }
        }
    }
    // More than one zero: from the best, another joint's besides.
    double before = INFINITY;
    for (int pass = 0; pass < PASSES && s.cost < before; pass++) {
        before = s.cost;
        for (int j = 0; j < DIG_JOINTS; j++) {
            if (moves[j]) {
                try_zeros(&s, s.best, j);
            }
        }
    }
    write_finding(&s, finding);
    free(s.at);
    return DIG_OK;
}
