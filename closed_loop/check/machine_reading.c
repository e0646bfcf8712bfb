#include "closed_loop/check/machine_reading.h"

#include "closed_loop/check/drive_misfit.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Instants that are looked at; poses that count as seen each for itself lie so far apart, and no
// more than so many of them count: what a file has wrong by some per cent it has in all of them.
enum { INSTANTS = 240, MOST_POSES = 100 };
static const double pose_rad = 0.1;

// Log odds against one thing being mixed up.
static const double each_change = 5.0;

// Angles beyond this, turns and all, are degrees.
static const double most_rad = 7.0;

// True pressure over what the column says: tens, and the units that are taken for each other (bar,
// kPa, MPa, Pa, psi).
static const double factors[] = { 1.0,  0.1, 10.0, 0.01, 100.0,     1e-3,     1e3,
                                  1e-5, 1e5, 1e-6, 1e6,  0.0689476, 14.50377, 6894.76 };
// How a drive's pressures are read: by which factor, and from FACTORS on with its sides exchanged.
enum { FACTORS = sizeof factors / sizeof factors[0], ANSWERS = 2 * FACTORS };

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

typedef double costs[DIG_JOINTS][DIG_JOINTS][ANSWERS]; // of a joint by the columns of another

// What an answer of drive j costs where a factor is common to all; a joint that hardly moves is
// read as its columns say.
static double cost_of(const struct search *const s, const size_t j, const double misfit,
                      const size_t answer, const size_t common)
{
    const bool   asked = s->moves[j] || answer == common;
    const double more  = (answer >= FACTORS ? each_change : 0.0) +
                        (answer % FACTORS != common ? 2.0 * each_change : 0.0);
    return asked ? misfit + more : (double)INFINITY;
}

// The answers of a joint by the columns of one drive, where a factor is common to all.
struct priced {
    double cost[ANSWERS];
    size_t best;
};

static struct priced price(const struct search *const s, const size_t j,
                           const double misfit[ANSWERS], const size_t common)
{
    struct priced priced = { .best = 0 };
    for (size_t a = 0; a < ANSWERS; a++) {
        priced.cost[a] = cost_of(s, j, misfit[a], a, common);
        priced.best    = priced.cost[a] < priced.cost[priced.best] ? a : priced.best;
    }
    return priced;
}

static void lower(double *const least, const double cost)
{
    *least = cost < *least ? cost : *least;
}

static void keep(struct search *const s, struct dig_reading reading,
                 const size_t answer[DIG_JOINTS], const double cost)
{
    size_t given[DIG_READING_QUESTIONS][DIG_JOINTS];
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        reading.swapped[j]            = answer[j] >= FACTORS;
        reading.factor[j]             = factors[answer[j] % FACTORS];
        given[DIG_READING_TURNED][j]  = reading.turned[j] ? 1 : 0;
        given[DIG_READING_DRIVE][j]   = reading.drive[j];
        given[DIG_READING_SWAPPED][j] = answer[j] / FACTORS;
        given[DIG_READING_FACTOR][j]  = answer[j] % FACTORS;
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
                      const double before, struct priced priced[DIG_JOINTS][DIG_JOINTS])
{
    size_t best[DIG_JOINTS];
    double sum = before;
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const struct priced *const of = &priced[j][reading->drive[j]];

        best[j] = of->best;
        sum += of->cost[of->best];
    }
    keep(s, *reading, best, sum);
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const struct priced *const of     = &priced[j][reading->drive[j]];
        const double               others = sum - of->cost[of->best];
        for (size_t a = 0; a < ANSWERS; a++) {
            const double with = others + of->cost[a];
            lower(&s->least[DIG_READING_SWAPPED][j][a / FACTORS], with);
            lower(&s->least[DIG_READING_FACTOR][j][a % FACTORS], with);
        }
    }
}

// All pressures for one reading of the angles: a unit common to all is one change, another of one
// drive is two.
static void try_pressures(struct search *const s, struct dig_reading reading, const double before,
                          costs cost)
{
    struct priced priced[DIG_JOINTS][DIG_JOINTS]; // of a joint by the columns of another
    for (size_t common = 0; common < FACTORS; common++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            for (size_t drive = 0; drive < DIG_JOINTS; drive++) {
                priced[j][drive] = price(s, j, cost[j][drive], common);
            }
        }
        for (size_t o = 0; o < ORDERS; o++) {
            memcpy(reading.drive, orders[o], sizeof reading.drive);
            try_order(s, &reading,
                      before + (common > 0 ? each_change : 0.0) + (o > 0 ? each_change : 0.0),
                      priced);
        }
    }
}

// What every answer of a drive leaves. A drive that is not recorded says nothing, for or against.
static void fill_costs(const struct search *const s, const struct dig_drive_load load[],
                       const int joint, const int drive, double cost[ANSWERS])
{
    for (size_t a = 0; a < ANSWERS; a++) {
        cost[a] = joint == drive ? 0.0 : (double)INFINITY;
    }
    for (size_t w = 0; w < 2 && s->told[drive]; w++) {
        const struct dig_drive_read read = {
            .cylinder = &s->machine->cylinder[joint],
            .head     = chamber_signal((enum dig_joint)drive, w),
            .rod      = chamber_signal((enum dig_joint)drive, 1U - w),
        };
        dig_drive_misfits(&read, s->n, s->at, &load[s->n * (size_t)joint], s->poses, FACTORS,
                          factors, &cost[w * FACTORS]);
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
    struct dig_drive_load load[DIG_JOINTS * INSTANTS];
    costs                 cost;
    dig_drive_loads(s->machine, angles, s->n, s->at, load);
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int d = 0; d < DIG_JOINTS; d++) {
            fill_costs(s, load, j, d, cost[j][d]);
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
