#include "closed_loop/air/machine_air.h"

#include "closed_loop/air/row_sigma.h"
#include "core/linkage.h"
#include "estimator/wrench/balance.h"
#include "estimator/wrench/dynamics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const double half_s = DIG_AIR_KERNEL_HALF_s;
static const double step_s = DIG_AIR_STEP_s;

// This many points make a block; so many more stand beside the air, where a delay may look for
// angles.
enum { POINTS_IN_BLOCK = 8, POINTS_BESIDE = 20 };

// Readings that are averaged: what a balance needs, and pitch and temperature.
enum { AVERAGED = DIG_SIGNAL_TEMPERATURE_degC + 1 };

// Kernel means of the readings around one time; the time that these are of, which is another where
// readings are missing. What a balance needs is told where every reading of it is.
static double average(const struct dig_machine_dig *const dig, const double time_s,
                      size_t *const from, struct dig_sample *const out)
{
    while (*from + 1 < dig->samples && dig->time_s[*from] < time_s - half_s) {
        ++*from;
    }
    double sum[AVERAGED]    = { 0.0 };
    double weight[AVERAGED] = { 0.0 };
    double all              = 0.0;
    double later_s          = 0.0;
    for (size_t i = *from; i < dig->samples && dig->time_s[i] < time_s + half_s; i++) {
        const struct dig_sample *const sample = &dig->sample[i];

        const double u = (dig->time_s[i] - time_s) / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        all += w;
        later_s += w * (dig->time_s[i] - time_s);
        for (int s = 0; s < AVERAGED; s++) {
            sum[s] += sample->valid[s] ? w * sample->value[s] : 0.0;
            weight[s] += sample->valid[s] ? w : 0.0;
        }
    }
    for (int s = 0; s < AVERAGED; s++) {
        const double least = s < DIG_SIGNALS_NEEDED ? (1.0 - 1e-9) * all : 0.0;

        out->valid[s] = weight[s] > 0.0 && weight[s] >= least;
        out->value[s] = out->valid[s] ? sum[s] / weight[s] : 0.0;
    }
    return all > 0.0 ? time_s + later_s / all : time_s;
}

// What one reading of a chamber scatters by, from how samples differ from the mean of both beside
// them; never less than the file says.
static double scatter_Pa(const struct dig_machine *const     machine,
                         const struct dig_machine_dig *const dig, const int chamber)
{
    double sum = 0.0;
    for (size_t i = 1; i + 1 < dig->samples; i++) {
        const size_t s   = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + (size_t)chamber;
        const double off = dig->sample[i].value[s] -
                           0.5 * (dig->sample[i - 1].value[s] + dig->sample[i + 1].value[s]);
        sum += fmin(off * off, 1e14);
    }
    const double seen  = sqrt(sum / 1.5 / (double)(dig->samples - 2));
    const double filed = dig_reading_sigma(machine->pressure_step_Pa,
                                           machine->cylinder[chamber / 2].pressure_sigma_Pa);
    return fmax(seen, filed);
}

// The same of every drive's push.
static void scatter_of(const struct dig_machine *const     machine,
                       const struct dig_machine_dig *const dig, double scatter_N[DIG_JOINTS])
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const cylinder = &machine->cylinder[j];

        const double head_Pa = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_HEAD);
        const double rod_Pa  = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_ROD);
        scatter_N[j]         = cylinder->count * hypot(dig_cylinder_head_m2(cylinder) * head_Pa,
                                                       dig_cylinder_rod_m2(cylinder) * rod_Pa);
    }
}

static void fill_means(struct dig_air_segment *const segment, const struct dig_air_point point[],
                       const size_t points)
{
    for (size_t p = 0; p < points; p++) {
        for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
            segment->mean_Pa[c] +=
                point[p].sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] / (double)points;
        }
    }
}

// Sigma of a block of one joint, or not positive where the joint cannot be told.
static double block_sigma_N(const struct dig_machine *const machine,
                            const struct dig_air_point point[], const size_t points,
                            const int joint, const double push_N, const double per_point,
                            const double turn[DIG_JOINTS])
{
    static const struct dig_correction none    = { .delay_s = 0.0 };
    double                             slow    = 0.0;
    double                             turn_N2 = 0.0;
    for (size_t p = 0; p < points; p++) {
        struct dig_readings readings;
        if (dig_readings_take(machine, &none, &point[p].sample, &point[p].rates, &readings) !=
            DIG_OK) {
            return 0.0;
        }
        const struct dig_front front = dig_front_place(machine, readings.joint_rad);
        struct dig_lever       lever = { .length_m = 0.0 };
        if (!readings.push[joint].valid ||
            dig_lever_solve(machine, (enum dig_joint)joint, readings.joint_rad[joint], &lever) !=
                DIG_OK ||
            !dig_cylinder_is_clear(&machine->cylinder[joint], lever.length_m)) {
            return 0.0;
        }
        double inertia_kgm2[DIG_JOINTS][DIG_JOINTS];
        dig_dynamics_inertia_kgm2(machine, &front, inertia_kgm2);
        slow = readings.push[joint].slow_N;
        for (int k = 0; k < DIG_JOINTS; k++) {
            turn_N2 += pow(inertia_kgm2[joint][k] / lever.arm_m, 2.0) * turn[k] / (double)points;
        }
    }
    const double white_N = push_N / sqrt(per_point * (double)points);
    return hypot(hypot(white_N, slow), sqrt(turn_N2));
}

static void add_rows(struct dig_air *const air, const size_t first, const size_t points,
                     const size_t segment, const double sigma_N[DIG_JOINTS], const double per_point)
{
    double turn[DIG_JOINTS];
    dig_turn_variance(&air->machine, &air->point[first], points, turn);
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double sigma = block_sigma_N(&air->machine, &air->point[first], points, j, sigma_N[j],
                                           per_point, turn);
        if (sigma > 0.0) {
            air->row[air->rows++] =
                (struct dig_air_row){ segment, (enum dig_joint)j, first, points, sigma, 1.0 };
        }
    }
}

static void add_point(struct dig_air *const air, const struct dig_machine_dig *const dig,
                      const double time_s, size_t *const near)
{
    struct dig_air_point *const point = &air->point[air->points++];
    *point                            = (struct dig_air_point){ .sample = { .time_ns = 0 } };
    const double mean_s               = average(dig, time_s, near, &point->sample);
    point->sample.time_ns             = llround(1e9 * mean_s);
    // Those of the sample before would be half a sample old on average, which at 50 Hz looks like a
    // delay of 10 ms.
    point->rates = dig_machine_dig_rates(dig, dig_machine_dig_between(dig, mean_s, *near));
}

static void add_segment(struct dig_air *const air, const struct dig_machine_dig *const dig,
                        const size_t which, const bool after)
{
    const size_t from = after ? dig->after : dig->before;
    const size_t to   = after ? dig->after_end : dig->before_end;
    if (to < from + 2) {
        return;
    }
    double scatter_N[DIG_JOINTS];
    scatter_of(&air->machine, dig, scatter_N);
    const double begin_s = dig->time_s[from] + half_s;
    const double end_s   = dig->time_s[to - 1] - half_s;
    const double last_s  = dig->time_s[dig->samples - 1];
    const double rate_Hz = (double)(to - from) / (dig->time_s[to - 1] - dig->time_s[from]);

    // Points from beside the air to beside it, as far as there is a recording.
    const long   before = lround(floor(fmin(POINTS_BESIDE, begin_s / step_s)));
    const size_t first  = air->points;
    size_t       core   = 0;
    size_t       near   = 0;
    for (long k = -before;; k++) {
        const double time_s = begin_s + step_s * (double)k;
        if (time_s > fmin(end_s + POINTS_BESIDE * step_s, last_s)) {
            break;
        }
        core += k >= 0 && time_s <= end_s ? 1 : 0;
        add_point(air, dig, time_s, &near);
    }
    const size_t begin    = first + (size_t)before;
    const size_t segment  = air->segments++;
    air->segment[segment] = (struct dig_air_segment){ .dig         = which,
                                                      .after       = after,
                                                      .first_point = first,
                                                      .points      = air->points - first,
                                                      .first_row   = air->rows };
    fill_means(&air->segment[segment], &air->point[begin], core);
    for (size_t p = 0; p + POINTS_IN_BLOCK <= core; p += POINTS_IN_BLOCK) {
        add_rows(air, begin + p, POINTS_IN_BLOCK, segment, scatter_N, fmax(rate_Hz * step_s, 1e-3));
    }
    air->segment[segment].rows = air->rows - air->segment[segment].first_row;
    dig_stand_widen(air, &air->segment[segment], dig);
}

enum dig_status dig_air_make(const struct dig_machine *const machine, const size_t digs,
                             const struct dig_machine_dig dig[], const bool used[],
                             struct dig_air *const air)
{
    assert(machine != NULL && air != NULL);
    size_t points = 1;
    for (size_t d = 0; d < digs; d++) {
        points += 4 * (size_t)POINTS_BESIDE + (size_t)(dig[d].time_s[dig[d].samples - 1] / step_s);
    }
    struct dig_air made = {
        .machine = *machine,
        .point   = malloc(points * sizeof *made.point),
        .row     = malloc(DIG_JOINTS * points * sizeof *made.row),
        .segment = malloc((2 * digs + 1) * sizeof *made.segment),
        .balance = malloc(points * sizeof *made.balance),
    };
    if (made.point == NULL || made.row == NULL || made.segment == NULL || made.balance == NULL) {
        dig_air_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t d = 0; d < digs; d++) {
        if (used == NULL || used[d]) {
            add_segment(&made, &dig[d], d, false);
            add_segment(&made, &dig[d], d, true);
        }
    }
    *air = made;
    return DIG_OK;
}

const char *dig_file_error_text(const enum dig_file_error error)
{
    static const char *const text[DIG_FILE_ERRORS] = {
        [DIG_FILE_LEVEL_rad] = "the machine's pitch",
        [DIG_FILE_LINKS]     = "the boom's mass",
        "where the boom's mass lies",
        "where the boom's mass lies",
        "the arm's mass",
        "where the arm's mass lies",
        "where the arm's mass lies",
        "the bucket's mass",
        "where the bucket's mass lies",
        "where the bucket's mass lies",
    };
    assert(error < DIG_FILE_ERRORS);
    return text[error];
}

void dig_file_correct(const double file[DIG_FILE_ERRORS], struct dig_correction *const correction)
{
    assert(file != NULL && correction != NULL);
    correction->level_rad += file[DIG_FILE_LEVEL_rad];
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const double *const          error = &file[(size_t)DIG_FILE_LINKS + 3 * j];
        struct dig_added_mass *const link  = &correction->link[j];
        link->mass_kg += error[0];
        link->moment_kgm.x += error[1];
        link->moment_kgm.y += error[2];
    }
}

void dig_air_finish(struct dig_air *const air)
{
    if (air != NULL) {
        free(air->point);
        free(air->row);
        free(air->segment);
        free(air->balance);
        *air = (struct dig_air){ .points = 0 };
    }
}
