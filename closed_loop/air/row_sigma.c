#include "closed_loop/air/row_sigma.h"

#include <assert.h>
#include <math.h>

static const double half_s = DIG_AIR_KERNEL_HALF_s;

// The harmonics left out are of a hundredth of a step.
enum { HARMONICS = 60 };

static double bessel2(const double x)
{
    if (x < 0.1) {
        return x * x / 15.0;
    }
    return (3.0 / (x * x) - 1.0) * sin(x) / x - 3.0 * cos(x) / (x * x);
}

// The sawtooth's part, at one speed.
static double stepped_variance(const double step_rad, const double sigma_rad,
                               const double speed_radps, const double block_s)
{
    double sum = 0.0;
    for (int k = 1; k <= HARMONICS && step_rad > 0.0 && fabs(speed_radps) > 0.0; k++) {
        const double wave_Hz = (double)k * fabs(speed_radps) / step_rad;
        const double y       = DIG_PI * wave_Hz * block_s;
        const double spread  = DIG_PI * (double)k * sigma_rad / step_rad;
        const double wave    = step_rad / (DIG_PI * (double)k) * exp(-2.0 * spread * spread);
        const double seen =
            15.0 * bessel2(2.0 * DIG_PI * wave_Hz * half_s) / (half_s * half_s) * sin(y) / y;
        sum += 0.5 * wave * wave * seen * seen;
    }
    return sum;
}

// How alike what white noise makes of the accelerations of two parabolas is, so far apart: these
// are weighted sums of the angles, weights (3 u^2 - 1) / 2 for u from -1 to 1.
static double likeness(const double apart_s)
{
    enum { STEPS = 200 };
    const double apart = apart_s / half_s;
    double       sum   = 0.0;
    for (int i = 0; i < STEPS && apart < 2.0; i++) {
        const double u = apart - 1.0 + (2.0 - apart) * ((double)i + 0.5) / STEPS;
        const double v = u - apart;
        sum += 0.25 * (3.0 * u * u - 1.0) * (3.0 * v * v - 1.0) * (2.0 - apart) / STEPS;
    }
    return sum / 0.4;
}

void dig_turn_variance(const struct dig_machine *const machine, const struct dig_air_point point[],
                       const size_t points, double variance[DIG_JOINTS])
{
    assert(machine != NULL && point != NULL && points > 0 && variance != NULL);
    const double n                   = (double)points;
    double       white               = 0.0;
    double       stepped[DIG_JOINTS] = { 0.0 };
    for (size_t apart = 0; apart < points; apart++) {
        const double alike = likeness((double)apart * DIG_AIR_STEP_s);
        for (size_t p = 0; p + apart < points; p++) {
            white += (apart == 0 ? 1.0 : 2.0) * alike * point[p].rates.acceleration_sigma *
                     point[p + apart].rates.acceleration_sigma / (n * n);
        }
    }
    for (size_t p = 0; p < points; p++) {
        for (size_t k = 0; k < DIG_JOINTS; k++) {
            stepped[k] += stepped_variance(machine->angle_step_rad, machine->angle_sigma_rad,
                                           point[p].rates.velocity_radps[k], n * DIG_AIR_STEP_s) /
                          n;
        }
    }
    for (size_t k = 0; k < DIG_JOINTS; k++) {
        variance[k] = fmax(white, 0.0) + stepped[k];
    }
}

// So many rows within a step of the first, a second, are a stand.
enum { ROWS_STAND = 5 };

// Where so many readings differ from the one before, noise spreads the rounding evenly.
static const double even_share = 0.4;

// Rows [first, end) of a joint among others.
struct stand {
    size_t first, end;
    double rows;
    double steps; // that the reading goes
};

static double mean_Pa(const struct dig_air *const air, const size_t row, const size_t signal)
{
    const struct dig_air_row *const r   = &air->row[row];
    double                          sum = 0.0;
    for (size_t p = r->first; p < r->first + r->points; p++) {
        sum += air->point[p].sample.value[signal];
    }
    return sum / (double)r->points;
}

static struct stand stand_from(const struct dig_air *const air, const size_t first,
                               const size_t end, const size_t signal)
{
    const enum dig_joint joint    = air->row[first].joint;
    const double         step_Pa  = air->machine.pressure_step_Pa;
    const double         first_Pa = mean_Pa(air, first, signal);
    struct stand         stand    = { first, first + 1, 1.0, 0.0 };
    double               last_Pa  = first_Pa;
    for (; stand.end < end; stand.end++) {
        if (air->row[stand.end].joint != joint) {
            continue;
        }
        const double now_Pa = mean_Pa(air, stand.end, signal);
        if (!(fabs(now_Pa - first_Pa) < step_Pa)) {
            break;
        }
        stand.rows += 1.0;
        stand.steps += fabs(now_Pa - last_Pa) / step_Pa;
        last_Pa = now_Pa;
    }
    return stand;
}

// How many of the stand's readings differ from the one before.
static double changing_share(const struct dig_air *const air, const struct stand *const stand,
                             const size_t signal, const struct dig_machine_dig *const dig)
{
    const struct dig_air_row *const last = &air->row[stand->end - 1];

    const double from_s = 1e-9 * (double)air->point[air->row[stand->first].first].sample.time_ns;
    const double to_s   = 1e-9 * (double)air->point[last->first + last->points - 1].sample.time_ns;
    double       changing = 0.0;
    double       all      = 0.0;
    size_t       i        = dig_machine_dig_sample_at(dig, from_s) + 1;
    for (; i < dig->samples && dig->time_s[i] < to_s; i++) {
        const double off = dig->sample[i].value[signal] - dig->sample[i - 1].value[signal];
        changing += fabs(off) > 0.0 ? 1.0 : 0.0;
        all += 1.0;
    }
    return all > 0.0 ? changing / all : 1.0;
}

// One chamber.
static void widen(struct dig_air *const air, const struct dig_air_segment *const segment,
                  const struct dig_machine_dig *const dig, const enum dig_joint joint,
                  const size_t chamber)
{
    const struct dig_cylinder *const cylinder = &air->machine.cylinder[joint];

    const double m2     = chamber == DIG_CHAMBER_HEAD ? dig_cylinder_head_m2(cylinder)
                                                      : dig_cylinder_rod_m2(cylinder);
    const double one_N  = cylinder->count * m2 * air->machine.pressure_step_Pa / sqrt(12.0);
    const size_t signal = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + DIG_CHAMBERS * (size_t)joint + chamber;
    const size_t end    = segment->first_row + segment->rows;
    for (size_t r = segment->first_row; r < end; r++) {
        if (air->row[r].joint != joint) {
            continue;
        }
        const struct stand stand = stand_from(air, r, end, signal);
        if (stand.rows >= ROWS_STAND) {
            const double even   = fmin(changing_share(air, &stand, signal, dig) / even_share, 1.0);
            const double each_N = one_N * sqrt((1.0 - even) * stand.rows / (1.0 + stand.steps));
            for (; r < stand.end; r++) {
                air->row[r].sigma_N =
                    hypot(air->row[r].sigma_N, air->row[r].joint == joint ? each_N : 0.0);
            }
        }
        r = stand.end - 1;
    }
}

void dig_stand_widen(struct dig_air *const air, const struct dig_air_segment *const segment,
                     const struct dig_machine_dig *const dig)
{
    assert(air != NULL && segment != NULL && dig != NULL);
    for (int j = 0; j < DIG_JOINTS; j++) {
        widen(air, segment, dig, (enum dig_joint)j, DIG_CHAMBER_HEAD);
        widen(air, segment, dig, (enum dig_joint)j, DIG_CHAMBER_ROD);
    }
}
