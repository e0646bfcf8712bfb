// Checks of a recording by itself, before any balance: times, gaps, stuck sensors, ranges.

#include "closed_loop/check/machine_check_private.h"
#include "core/linkage.h"
#include "core/units.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>

// A gap this long hides a motion; a rate below this is no machine recording.
static const double most_gap_s   = 0.1;
static const double least_Hz     = 40.0;
static const double few_missing  = 0.01;
static const double many_missing = 0.2;

// One value for so long, with a sensor whose noise moves it over its steps; or while its joint
// turns from end to end.
static const double stuck_s       = 2.0;
static const double noise_share   = 0.25; // of a step
static const double much_turn_rad = 10.0 * DIG_RAD_PER_DEG;

static const double little_rad = 0.5 * DIG_RAD_PER_DEG; // beyond a limit
static const double much_rad   = 2.0 * DIG_RAD_PER_DEG;

struct dig_check_item *dig_check_add(struct dig_machine_air_check *const check,
                                     const enum dig_check_question question, const int of,
                                     const double value, const double tolerance,
                                     const enum dig_check_verdict verdict)
{
    assert(check->items < DIG_CHECK_ITEMS_MAX);
    struct dig_check_item *const item = &check->item[check->items++];
    *item                             = (struct dig_check_item){
                                    .question  = question,
                                    .of        = of,
                                    .verdict   = verdict,
                                    .value     = value,
                                    .sigma     = (double)NAN,
                                    .tolerance = tolerance,
                                    .excess    = (double)NAN,
                                    .share     = (double)NAN,
                                    .at_rod    = (double)NAN,
                                    .answer    = of,
                                    .or_item   = -1,
    };
    return item;
}

enum dig_check_verdict dig_check_grade(const double value, const double doubtful,
                                       const double wrong)
{
    return value > wrong ? DIG_CHECK_WRONG : value > doubtful ? DIG_CHECK_DOUBTFUL : DIG_CHECK_OK;
}

static void check_times(const struct dig_machine_recording *const recording,
                        struct dig_machine_air_check *const       check)
{
    double gap_s = 0.0;
    for (size_t i = 1; i < recording->rows; i++) {
        gap_s =
            fmax(gap_s, 1e-9 * (double)(recording->row[i].time_ns - recording->row[i - 1].time_ns));
    }
    const double rate_Hz = (double)(recording->rows - 1) / check->duration_s;
    const bool   slow    = !(rate_Hz >= least_Hz);
    (void)dig_check_add(check, DIG_CHECK_TIMES, -1, rate_Hz, gap_s,
                        slow ? DIG_CHECK_WRONG
                             : dig_check_grade(gap_s, most_gap_s, (double)INFINITY));
}

// Of each signal that is there at all.
static void check_missing(const struct dig_machine_recording *const recording,
                          struct dig_machine_air_check *const       check)
{
    double most = 0.0;
    for (size_t s = 0; s < DIG_SIGNALS_NEEDED; s++) {
        double here = 0.0;
        for (size_t i = 0; i < recording->rows; i++) {
            here += recording->row[i].valid[s] ? 1.0 : 0.0;
        }
        const double missing = 1.0 - here / (double)recording->rows;
        most                 = missing < 1.0 ? fmax(most, missing) : most;
    }
    (void)dig_check_add(check, DIG_CHECK_MISSING, -1, most, few_missing,
                        dig_check_grade(most, few_missing, many_missing));
}

// The longest stretch in which a signal keeps one value; false: it never changes at all.
struct stretch {
    size_t first, last;
    double s;
};

static bool longest(const struct dig_machine_recording *const recording, const size_t signal,
                    struct stretch *const most)
{
    bool   changes = false;
    size_t from    = 0;
    *most          = (struct stretch){ .s = 0.0 };
    for (size_t i = 0; i < recording->rows; i++) {
        const struct dig_sample *const at    = &recording->row[i];
        const struct dig_sample *const begin = &recording->row[from];

        const bool same =
            at->valid[signal] && fabs(at->value[signal] - begin->value[signal]) <= 0.0;
        const double s = 1e-9 * (double)(at->time_ns - begin->time_ns);
        if (same && s > most->s) {
            *most = (struct stretch){ from, i, s };
        }
        changes = changes || (at->valid[signal] && !same && i > 0);
        from    = same ? from : i;
    }
    return changes;
}

void dig_check_range(const size_t samples, const struct dig_sample sample[], const size_t signal,
                     double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (size_t i = 0; i < samples; i++) {
        if (sample[i].valid[signal]) {
            range[0] = fmin(range[0], sample[i].value[signal]);
            range[1] = fmax(range[1], sample[i].value[signal]);
        }
    }
}

static void check_stuck(const struct dig_machine *const     machine,
                        struct dig_machine_recording *const recording,
                        struct dig_machine_air_check *const check)
{
    for (size_t s = 0; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
        const bool   angle = s <= DIG_SIGNAL_BUCKET_rad;
        const size_t joint = angle ? s : (s - DIG_SIGNAL_BOOM_HEAD_Pa) / DIG_CHAMBERS;
        const double step  = angle ? machine->angle_step_rad : machine->pressure_step_Pa;
        const double sigma =
            angle ? machine->angle_sigma_rad : machine->cylinder[joint].pressure_sigma_Pa;
        struct stretch most;
        const bool     changes = longest(recording, s, &most);
        const bool     noisy   = sigma > 0.0 && sigma >= noise_share * step;
        double         range[2];
        dig_check_range(recording->rows, recording->row, DIG_SIGNAL_BOOM_rad + joint, range);
        const bool turns = !angle && range[1] - range[0] > much_turn_rad;
        if (!(most.s > stuck_s) || !(noisy || (!changes && turns))) {
            continue;
        }
        (void)dig_check_add(check, DIG_CHECK_STUCK, (int)s, most.s, stuck_s, DIG_CHECK_WRONG);
        for (size_t i = most.first; i <= most.last; i++) {
            recording->row[i].valid[s] = false;
            recording->row[i].value[s] = 0.0;
        }
    }
}

// How far an angle lies beyond its joint's limits or its cylinder's stops.
static double beyond_rad(const struct dig_machine *const machine, const size_t joint,
                         const double rad)
{
    const struct dig_link *const     link     = &machine->link[joint];
    const struct dig_cylinder *const cylinder = &machine->cylinder[joint];
    struct dig_lever                 lever;

    const double limit = fmax(link->min_rad - rad, rad - link->max_rad);
    if (dig_lever_solve(machine, (enum dig_joint)joint, rad, &lever) != DIG_OK) {
        return fmax(limit, much_rad + little_rad);
    }
    const double stop_m =
        fmax(cylinder->min_length_m - lever.length_m, lever.length_m - cylinder->max_length_m);
    return fmax(limit, stop_m / fmax(fabs(lever.arm_m), 1e-3));
}

static void check_moves(const struct dig_machine_dig *const dig, const size_t j,
                        struct dig_machine_air_check *const check)
{
    double *const range_rad = check->angles_rad[j];
    dig_check_range(dig->samples, dig->sample, DIG_SIGNAL_BOOM_rad + j, range_rad);
    const double turn_rad = range_rad[1] - range_rad[0];
    (void)dig_check_add(check, DIG_CHECK_MOVES, (int)j, turn_rad, DIG_CHECK_LEAST_TURN_rad,
                        turn_rad >= DIG_CHECK_LEAST_TURN_rad ? DIG_CHECK_OK : DIG_CHECK_UNTOLD);
}

static void check_limits(const struct dig_machine *const machine, const size_t j,
                         struct dig_machine_air_check *const check)
{
    const double most_rad = fmax(beyond_rad(machine, j, check->angles_rad[j][0]),
                                 beyond_rad(machine, j, check->angles_rad[j][1]));
    (void)dig_check_add(check, DIG_CHECK_RANGE, (int)j, fmax(most_rad, 0.0), little_rad,
                        dig_check_grade(most_rad, little_rad, much_rad));
}

void dig_check_recording(const struct dig_machine *const     machine,
                         struct dig_machine_recording *const recording,
                         struct dig_machine_air_check *const check)
{
    assert(machine != NULL && recording != NULL && check != NULL);
    check_times(recording, check);
    check_missing(recording, check);
    check_stuck(machine, recording, check);
}

void dig_check_motion(const struct dig_machine *const     machine,
                      const struct dig_machine_dig *const dig,
                      struct dig_machine_air_check *const check)
{
    assert(machine != NULL && dig != NULL && check != NULL);
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        check_moves(dig, j, check);
    }
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        check_limits(machine, j, check);
    }
}
