#include "closed_loop/check/machine_check.h"

#include "closed_loop/air/machine_air.h"
#include "closed_loop/check/machine_causes.h"
#include "closed_loop/check/machine_check_private.h"
#include "closed_loop/recordings/reading_noise.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double most_s = 300.0;

// Another answer that is worse by less is not told from the best.
static const double told_sigmas = 3.0;

// What is left of a joint's rows, in their sigmas and as a share of its load: a seal that rubs in
// another way than its formula is many sigmas, and still little.
static const double little_rest  = 1.5;
static const double much_rest    = 3.0;
static const double little_share = 0.02;
static const double much_share   = 0.05;

// A figure known to no better than so many tolerances is not told.
static const double vague = 3.0;

// The samples that are looked at, to be read in another way.
static enum dig_status copy(const struct dig_machine_recording *const recording,
                            struct dig_machine_recording *const       copied)
{
    size_t rows = 0;
    while (rows < recording->rows &&
           1e-9 * (double)(recording->row[rows].time_ns - recording->row[0].time_ns) <= most_s) {
        rows++;
    }
    copied->row = malloc((rows + 1) * sizeof *copied->row);
    if (copied->row == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(copied->row, recording->row, rows * sizeof *copied->row);
    copied->rows = rows;
    return DIG_OK;
}

// One question of every joint, so that the list reads joint by joint within a question.
static void check_reading(const struct dig_reading_finding *const f,
                          struct dig_machine_air_check *const     check)
{
    static const enum dig_check_question question[DIG_READING_QUESTIONS] = {
        [DIG_READING_TURNED]  = DIG_CHECK_DIRECTION,
        [DIG_READING_DRIVE]   = DIG_CHECK_CYLINDER,
        [DIG_READING_SWAPPED] = DIG_CHECK_SIDES,
        [DIG_READING_FACTOR]  = DIG_CHECK_UNIT,
    };
    (void)dig_check_add(check, DIG_CHECK_DEGREES, -1, (double)NAN, (double)NAN,
                        f->best.degrees ? DIG_CHECK_WRONG : DIG_CHECK_OK);
    for (size_t q = 0; q < DIG_READING_QUESTIONS; q++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const bool   told  = f->sigmas[q][j] >= told_sigmas;
            const double value = q == DIG_READING_FACTOR ? f->best.factor[j] : f->sigmas[q][j];
            struct dig_check_item *const item =
                dig_check_add(check, question[q], (int)j, value, (double)NAN,
                              f->plain[q][j] ? (told ? DIG_CHECK_OK : DIG_CHECK_UNTOLD)
                              : told         ? DIG_CHECK_WRONG
                                             : DIG_CHECK_DOUBTFUL);
            item->answer = (int)f->best.drive[j];
            item->excess = f->sigmas[q][j];
        }
    }
}

// The line that asks about causes of a kind.
static const enum dig_check_question question_of[DIG_CAUSE_KINDS] = {
    [DIG_CAUSE_ZERO]   = DIG_CHECK_ZERO,
    [DIG_CAUSE_FACTOR] = DIG_CHECK_FACTOR,
    [DIG_CAUSE_OFFSET] = DIG_CHECK_OFFSET,
    [DIG_CAUSE_WEIGHT] = DIG_CHECK_WEIGHT,
};

static struct dig_check_item *check_cause(const struct dig_cause *const cause, const bool asked,
                                          const double                        coarse,
                                          struct dig_machine_air_check *const check,
                                          const enum dig_check_question question, const int joint)
{
    // Of a zero that the reading took off in whole steps the fit may give all back.
    const bool   stepped = fabs(coarse) > 0.0;
    const double value   = cause->value + coarse;
    const double excess  = fabs(value) / hypot(cause->sigma, cause->tolerance);

    const enum dig_check_verdict verdict =
        !asked         ? DIG_CHECK_UNTOLD
        : stepped      ? dig_check_grade(excess, told_sigmas, told_sigmas)
        : cause->named ? DIG_CHECK_WRONG
        : cause->sigma > vague * cause->tolerance
            ? DIG_CHECK_UNTOLD
            : dig_check_grade(excess, told_sigmas, (double)INFINITY);
    struct dig_check_item *const item =
        dig_check_add(check, question, joint, value, cause->tolerance, verdict);
    item->sigma  = cause->sigma;
    item->excess = excess;
    return item;
}

static void check_causes(const struct dig_machine *const machine,
                         const struct dig_causes *const causes, const bool moves[DIG_JOINTS],
                         struct dig_machine_air_check *const check)
{
    const size_t first = check->items; // a line for each cause, in their order
    for (size_t kind = 0; kind < DIG_CAUSE_KINDS; kind++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const cylinder = &machine->cylinder[j];

            const bool   told   = moves[j] && isfinite(causes->rest[j]);
            const double coarse = kind == DIG_CAUSE_ZERO ? check->reading.best.zero_rad[j] : 0.0;
            struct dig_check_item *const item =
                check_cause(&causes->cause[DIG_JOINTS * kind + j], told, coarse, check,
                            question_of[kind], (int)j);
            item->at_rod =
                -item->value * dig_cylinder_head_m2(cylinder) / dig_cylinder_rod_m2(cylinder);
        }
    }
    (void)check_cause(&causes->cause[DIG_CAUSE_DELAY], true, 0.0, check, DIG_CHECK_DELAY, -1);
    for (size_t k = 0; k < DIG_CAUSES; k++) {
        const int or_cause = causes->cause[k].or_cause;
        if (causes->cause[k].named && or_cause >= 0) {
            const size_t other             = first + (size_t)or_cause;
            check->item[first + k].or_item = (int)other;
            check->item[other].or_item     = (int)(first + k);
            check->item[other].verdict     = DIG_CHECK_DOUBTFUL;
        }
    }
}

// What the drives push and would have to, and when, in one piece at *drive_N.
static enum dig_status draw(const struct dig_air *const        air,
                            const struct dig_correction *const correction, double **const drive_N,
                            double **const load_N, double **const time_s)
{
    const size_t n = DIG_JOINTS * air->points;
    *drive_N       = malloc((2 * n + air->points + 1) * sizeof **drive_N);
    if (*drive_N == NULL) {
        return DIG_ENOMEM;
    }
    *load_N = *drive_N + n;
    *time_s = *load_N + n;
    dig_air_forces(air, correction, *drive_N, *load_N);
    for (size_t p = 0; p < air->points; p++) {
        (*time_s)[p] = 1e-9 * (double)(air->point[p].sample.time_ns);
    }
    return DIG_OK;
}

// The rms of what a drive has to push.
static double load_N(const struct dig_check_curves *const curves, const size_t joint)
{
    double n   = 0.0;
    double sum = 0.0;
    for (size_t p = 0; p < curves->points; p++) {
        const double N = curves->mended_load_N[DIG_JOINTS * p + joint];
        n += isfinite(N) ? 1.0 : 0.0;
        sum += isfinite(N) ? N * N : 0.0;
    }
    return n > 0.0 ? sqrt(sum / n) : (double)NAN;
}

static void check_rest(const struct dig_causes *const      causes,
                       struct dig_machine_air_check *const check)
{
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const double rest   = causes->rest[j];
        const double share  = causes->rest_N[j] / load_N(&check->curves, j);
        const bool   much   = rest > much_rest && share > much_share;
        const bool   little = rest > little_rest && share > little_share;
        dig_check_add(check, DIG_CHECK_REST, (int)j, rest, little_rest,
                      isnan(rest) ? DIG_CHECK_UNTOLD
                      : much      ? DIG_CHECK_WRONG
                      : little    ? DIG_CHECK_DOUBTFUL
                                  : DIG_CHECK_OK)
            ->share        = share;
        check->unexplained = check->unexplained || much;
    }
    for (size_t i = 0; i < check->items && check->unexplained; i++) {
        struct dig_check_item *const item = &check->item[i];

        const bool fitted =
            item->question >= DIG_CHECK_DIRECTION && item->question < DIG_CHECK_REST;
        item->verdict =
            fitted && item->verdict == DIG_CHECK_WRONG ? DIG_CHECK_DOUBTFUL : item->verdict;
    }
}

// The dig of a recording, and its air.
static enum dig_status take_air(const struct dig_machine *const           machine,
                                const struct dig_machine_recording *const recording,
                                struct dig_machine_dig *const dig, struct dig_air *const air,
                                struct dig_error *const error)
{
    enum dig_status status = dig_machine_dig_make_air(machine, recording, dig, error);
    return status == DIG_OK ? dig_air_make(machine, 1, dig, NULL, air) : status;
}

// How far the joints turn, sign and zero aside.
static void find_motion(const struct dig_machine_dig *const dig, const bool degrees,
                        bool moves[DIG_JOINTS])
{
    const double unit = degrees ? DIG_RAD_PER_DEG : 1.0;
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        double range[2];
        dig_check_range(dig->samples, dig->sample, DIG_SIGNAL_BOOM_rad + j, range);
        moves[j] = unit * range[1] - unit * range[0] >= DIG_CHECK_LEAST_TURN_rad;
    }
}

// Reads it as it says, finds how it is to be read, and keeps what the picture shows of the first.
static enum dig_status read_plain(const struct dig_machine *const           machine,
                                  const struct dig_machine_recording *const recording,
                                  bool moves[DIG_JOINTS], struct dig_machine_air_check *const check,
                                  struct dig_error *const error)
{
    static const struct dig_correction none   = { .delay_s = 0.0 };
    struct dig_machine_dig             dig    = { .samples = 0 };
    struct dig_air                     air    = { .points = 0 };
    enum dig_status                    status = take_air(machine, recording, &dig, &air, error);
    if (status == DIG_OK) {
        const bool degrees = dig_reading_in_degrees(&dig);
        find_motion(&dig, degrees, moves);
        status = dig_reading_find(machine, &air, degrees, moves, &check->reading);
    }
    if (status == DIG_OK) {
        check->curves.points = air.points;
        status =
            draw(&air, &none, &check->curves.drive_N, &check->curves.load_N, &check->curves.time_s);
    }
    dig_air_finish(&air);
    dig_machine_dig_finish(&dig);
    return status;
}

// Reads it as is best, and asks everything.
static enum dig_status read_best(const struct dig_machine *const           machine,
                                 const struct dig_machine_recording *const recording,
                                 const bool                                moves[DIG_JOINTS],
                                 struct dig_machine_air_check *const       check,
                                 struct dig_error *const                   error)
{
    struct dig_correction  correction[2] = { { .delay_s = 0.0 } };
    struct dig_machine     noisy         = *machine;
    struct dig_machine_dig dig           = { .samples = 0 };
    struct dig_air         air           = { .points = 0 };
    struct dig_causes      causes;
    dig_reading_noise_raise(&noisy, 1, recording);
    enum dig_status status = take_air(&noisy, recording, &dig, &air, error);
    if (status == DIG_OK) {
        dig_check_motion(machine, &dig, check);
        check_reading(&check->reading, check);
        status = dig_causes_find(&air, moves, &causes, correction);
    }
    if (status == DIG_OK) {
        check_causes(machine, &causes, moves, check);
        memcpy(check->rest_plain, causes.rest_plain, sizeof check->rest_plain);
        // Read otherwise, other samples may lack a pressure.
        check->curves.points =
            air.points < check->curves.points ? air.points : check->curves.points;
        double *time_s = NULL; // as before
        status = draw(&air, correction, &check->curves.mended_drive_N, &check->curves.mended_load_N,
                      &time_s);
    }
    if (status == DIG_OK) {
        check_rest(&causes, check);
    }
    dig_air_finish(&air);
    dig_machine_dig_finish(&dig);
    return status;
}

enum dig_status dig_machine_air_check_run(const struct dig_machine *const           machine,
                                          const struct dig_machine_recording *const recording,
                                          struct dig_machine_air_check *const       check,
                                          struct dig_error *const                   error)
{
    assert(machine != NULL && recording != NULL && check != NULL);
    if (machine->sensor.fitted) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: a bucket on a force sensor, expected a machine with cylinders",
                             machine->name);
    }
    struct dig_machine_air_check made = { .items = 0 };
    struct dig_machine_recording read = { .rows = 0 };
    bool                         moves[DIG_JOINTS];
    enum dig_status              status = recording->rows > 0 ? copy(recording, &read)
                                                              : dig_error_set(error, DIG_EINVAL, "no samples");
    if (status == DIG_OK) {
        made.duration_s =
            1e-9 * (double)(recording->row[read.rows - 1].time_ns - recording->row[0].time_ns);
        dig_check_recording(machine, &read, &made);
        status = read_plain(machine, &read, moves, &made, error);
    }
    if (status == DIG_OK) {
        dig_reading_apply(&made.reading.best, &read);
        status = read_best(machine, &read, moves, &made, error);
    }
    dig_machine_recording_finish(&read);
    if (status != DIG_OK) {
        dig_machine_air_check_finish(&made);
        return status;
    }
    for (size_t i = 0; i < made.items; i++) {
        const enum dig_check_verdict one = made.item[i].verdict;
        made.verdict = one != DIG_CHECK_UNTOLD && one > made.verdict ? one : made.verdict;
    }
    *check = made;
    return DIG_OK;
}

void dig_machine_air_check_finish(struct dig_machine_air_check *const check)
{
    if (check != NULL) {
        free(check->curves.drive_N);
        free(check->curves.mended_drive_N);
        *check = (struct dig_machine_air_check){ .items = 0 };
    }
}
