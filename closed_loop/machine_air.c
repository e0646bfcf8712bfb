#include "closed_loop/machine_air.h"

#include "estimator/balance.h"
#include "estimator/dynamics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// The kernel's half is the rates'.
static const double half_s = 0.12;

// Points are so far apart, and this many make a block.
static const double step_s = 0.025;
enum { POINTS_IN_BLOCK = 8 };

// Kernel means of the readings around one time. Returns the share of one sample's variance that is
// left in them.
static double average(const struct dig_machine_dig *const dig, const double time_s,
                      size_t *const from, struct dig_sample *const out)
{
    while (*from + 1 < dig->samples && dig->time_s[*from] < time_s - half_s) {
        ++*from;
    }
    double sum[DIG_SIGNALS_NEEDED] = { 0.0 };
    double weight                  = 0.0;
    double weight2                 = 0.0;
    for (size_t i = *from; i < dig->samples && dig->time_s[i] < time_s + half_s; i++) {
        const double u = (dig->time_s[i] - time_s) / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        weight += w;
        weight2 += w * w;
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            sum[s] += w * dig->sample[i].value[s];
        }
    }
    for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
        out->value[s] = sum[s] / weight;
    }
    return weight2 / (weight * weight);
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

// Both, by chamber and by drive.
struct scatter {
    double Pa[DIG_JOINTS * DIG_CHAMBERS];
    double N[DIG_JOINTS];
};

static struct scatter scatter_of(const struct dig_machine *const     machine,
                                 const struct dig_machine_dig *const dig)
{
    struct scatter s;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const cylinder = &machine->cylinder[j];
        double *const                    Pa       = &s.Pa[DIG_CHAMBERS * j];

        Pa[DIG_CHAMBER_HEAD] = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_HEAD);
        Pa[DIG_CHAMBER_ROD]  = scatter_Pa(machine, dig, DIG_CHAMBERS * j + DIG_CHAMBER_ROD);
        s.N[j] = cylinder->count * hypot(dig_cylinder_head_m2(cylinder) * Pa[DIG_CHAMBER_HEAD],
                                         dig_cylinder_rod_m2(cylinder) * Pa[DIG_CHAMBER_ROD]);
    }
    return s;
}

// Fills calm_Pa of the points of a segment. left: of a sample's variance, in a point.
static void calm(struct dig_air_point point[], const size_t points, const struct scatter *const s,
                 const double left)
{
    for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
        const size_t signal   = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c;
        double       mean     = 0.0;
        double       variance = 0.0;
        for (size_t p = 0; p < points; p++) {
            mean += point[p].sample.value[signal] / (double)points;
        }
        for (size_t p = 0; p < points; p++) {
            variance += pow(point[p].sample.value[signal] - mean, 2.0) / (double)points;
        }
        const double noise = left * s->Pa[c] * s->Pa[c];
        const double kept  = variance > noise ? 1.0 - noise / variance : 0.0;
        for (size_t p = 0; p < points; p++) {
            point[p].calm_Pa[c] = mean + kept * (point[p].sample.value[signal] - mean);
        }
    }
}

// Sigma of a block of one joint, or not positive where the joint cannot be told.
static double block_sigma_N(const struct dig_machine *const machine,
                            const struct dig_air_point point[], const size_t points,
                            const int joint, const double push_N, const double per_point)
{
    static const struct dig_correction none = { .delay_s = 0.0 };
    double                             slow = 0.0;
    double                             turn = 0.0;
    for (size_t p = 0; p < points; p++) {
        struct dig_readings readings;
        if (dig_readings_take(machine, &none, &point[p].sample, &point[p].rates, &readings) !=
            DIG_OK) {
            return 0.0;
        }
        const struct dig_front   front   = dig_front_place(machine, readings.joint_rad);
        const struct dig_balance balance = dig_balance_solve(machine, &readings, &front);
        const struct dig_lever  *lever   = &balance.lever[joint];
        if (!balance.lever_ok[joint] || !readings.push[joint].valid ||
            !dig_cylinder_is_clear(&machine->cylinder[joint], lever->length_m)) {
            return 0.0;
        }
        double inertia_kgm2[DIG_JOINTS][DIG_JOINTS];
        dig_dynamics_inertia_kgm2(machine, &front, inertia_kgm2);
        slow = readings.push[joint].slow_N;
        for (int k = 0; k < DIG_JOINTS; k++) {
            turn += pow(inertia_kgm2[joint][k] / lever->arm_m, 2.0) / (double)points;
        }
    }
    // A block's mean acceleration is the difference of two speeds.
    const double turn_radps2 =
        fmin(point[0].rates.acceleration_sigma,
             sqrt(2.0) * point[0].rates.velocity_sigma / (step_s * (double)points));
    const double white_N = push_N / sqrt(per_point * (double)points);
    return hypot(hypot(white_N, slow), sqrt(turn) * turn_radps2);
}

static void add_rows(struct dig_air *const air, const size_t first, const size_t points,
                     const size_t segment, const double sigma_N[DIG_JOINTS], const double per_point)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double sigma =
            block_sigma_N(&air->machine, &air->point[first], points, j, sigma_N[j], per_point);
        if (sigma > 0.0) {
            air->row[air->rows++] =
                (struct dig_air_row){ segment, (enum dig_joint)j, first, points, sigma };
        }
    }
}

// The rates of the sample nearest to a time.
static const struct dig_rates *rates_at(const struct dig_machine_dig *const dig,
                                        const double time_s, const size_t from)
{
    size_t i = from;
    while (i + 1 < dig->samples && dig->time_s[i + 1] <= time_s) {
        i++;
    }
    return &dig->rates[i];
}

static void add_segment(struct dig_air *const air, const struct dig_machine_dig *const dig,
                        const size_t which, const bool after)
{
    const size_t from = after ? dig->after : 0;
    const size_t to   = after ? dig->samples : dig->before_end;
    if (to < from + 2) {
        return;
    }
    const struct scatter scatter = scatter_of(&air->machine, dig);
    const double         rate_Hz = (double)(to - from) / (dig->time_s[to - 1] - dig->time_s[from]);

    const size_t segment  = air->segments++;
    air->segment[segment] = (struct dig_air_segment){ which, after, air->rows, 0 };

    size_t       near    = from;
    double       left    = 1.0;
    const size_t first   = air->points;
    const double begin_s = dig->time_s[from] + half_s;
    const double end_s   = dig->time_s[to - 1] - half_s;
    for (size_t k = 0; begin_s + step_s * (double)k <= end_s; k++) {
        const double          time_s = begin_s + step_s * (double)k;
        struct dig_air_point *point  = &air->point[air->points++];
        *point                       = (struct dig_air_point){ .sample = dig->sample[from] };
        left                         = average(dig, time_s, &near, &point->sample);
        point->rates                 = *rates_at(dig, time_s, near);
    }
    calm(&air->point[first], air->points - first, &scatter, left);
    for (size_t p = first; p + POINTS_IN_BLOCK <= air->points; p += POINTS_IN_BLOCK) {
        add_rows(air, p, POINTS_IN_BLOCK, segment, scatter.N, fmax(rate_Hz * step_s, 1e-3));
    }
    air->segment[segment].rows = air->rows - air->segment[segment].first_row;
}

enum dig_status dig_air_make(const struct dig_machine *const machine, const size_t digs,
                             const struct dig_machine_dig dig[], const bool used[],
                             struct dig_air *const air)
{
    assert(machine != NULL && air != NULL);
    size_t points = 1;
    for (size_t d = 0; d < digs; d++) {
        points += 4 + (size_t)(dig[d].time_s[dig[d].samples - 1] / step_s);
    }
    struct dig_air made = {
        .machine = *machine,
        .point   = malloc(points * sizeof *made.point),
        .row     = malloc(DIG_JOINTS * points * sizeof *made.row),
        .segment = malloc((2 * digs + 1) * sizeof *made.segment),
    };
    if (made.point == NULL || made.row == NULL || made.segment == NULL) {
        dig_air_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t d = 0; d < digs; d++) {
        if (used[d]) {
            add_segment(&made, &dig[d], d, false);
            add_segment(&made, &dig[d], d, true);
        }
    }
    *air = made;
    return DIG_OK;
}

void dig_air_finish(struct dig_air *const air)
{
    if (air != NULL) {
        free(air->point);
        free(air->row);
        free(air->segment);
        *air = (struct dig_air){ .points = 0 };
    }
}

// What is left of all three joints at one point, N at the rods.
static void rest_at(const struct dig_machine *const    corrected,
                    const struct dig_correction *const correction,
                    const struct dig_air_point *const point, double rest_N[DIG_JOINTS])
{
    struct dig_readings readings;
    if (dig_readings_take(corrected, correction, &point->sample, &point->rates, &readings) !=
        DIG_OK) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            rest_N[j] = 0.0;
        }
        return;
    }
    const struct dig_front   front   = dig_front_place(corrected, readings.joint_rad);
    const struct dig_balance balance = dig_balance_solve(corrected, &readings, &front);
    for (int j = 0; j < DIG_JOINTS; j++) {
        rest_N[j] =
            balance.lever_ok[j] ? balance.rest_Nm[j] / balance.lever[j].arm_m : balance.rest_Nm[j];
    }
}

void dig_air_rest(const struct dig_air *const air, const struct dig_correction correction[],
                  double rest[])
{
    assert(air != NULL && correction != NULL && rest != NULL);
    size_t at = 0;
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_machine corrected = dig_correction_machine(&air->machine, &correction[s]);
        const size_t             end       = air->segment[s].first_row + air->segment[s].rows;
        while (at < end) {
            // The rows of one block stand together and share its points.
            const size_t first             = air->row[at].first;
            const size_t points            = air->row[at].points;
            double       sum_N[DIG_JOINTS] = { 0.0 };
            for (size_t p = 0; p < points; p++) {
                double rest_N[DIG_JOINTS];
                rest_at(&corrected, &correction[s], &air->point[first + p], rest_N);
                for (int j = 0; j < DIG_JOINTS; j++) {
                    sum_N[j] += rest_N[j] / (double)points;
                }
            }
            for (; at < end && air->row[at].first == first; at++) {
                rest[at] = sum_N[air->row[at].joint] / air->row[at].sigma_N;
            }
        }
    }
}
