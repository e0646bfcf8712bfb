// Residuals of free air's equations, of the machine as in its file and corrected.

#include "closed_loop/air/machine_air.h"
#include "estimator/wrench/balance.h"
#include "estimator/wrench/dynamics.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

static const double half_s = DIG_AIR_KERNEL_HALF_s;
static const double step_s = DIG_AIR_STEP_s;

// The kernel reaches over so many points.
enum { KERNEL = 4 };

// A rod this fast moves: friction is all there, against it.
static const double moves_mps = 5.0 * DIG_FRICTION_STILL_mps;

// A point with the angles and rates that the machine had delay_s before.
static struct dig_air_point delayed(const struct dig_air_point point[], const size_t points,
                                    const size_t at, const double delay_s)
{
    if (!(fabs(delay_s) > 0.0)) {
        return point[at];
    }
    const double back = fmin(fmax((double)at - delay_s / step_s, 0.0), (double)(points - 1));
    const size_t low  = (size_t)back;
    const size_t high = low + 1 < points ? low + 1 : low;
    const double f    = back - (double)low;
    struct dig_air_point        out = point[at];
    const struct dig_air_point *a   = &point[low];
    const struct dig_air_point *b   = &point[high];
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const size_t q = (size_t)DIG_SIGNAL_BOOM_rad + j;

        out.sample.value[q] = (1.0 - f) * a->sample.value[q] + f * b->sample.value[q];
    }
    out.rates = dig_rates_between(&a->rates, &b->rates, f);
    return out;
}

// What friction may take more than the loss at a speed, either way: a rod that stands may still be
// held by all that it rubbed with when it last moved, or by less.
static double held_N(const struct dig_friction *const friction, const double push_N,
                     const double rod_mps, const double loss_N)
{
    if (!(fabs(rod_mps) < moves_mps)) {
        return 0.0;
    }
    return fabs(dig_friction_loss_N(friction, push_N, copysign(moves_mps, rod_mps)) - loss_N);
}

// A point as a machine has it: what it reads, its levers, and what weight and inertia ask for about
// the pins.
struct seen {
    bool                read;
    struct dig_readings readings;
    bool                lever_ok[DIG_JOINTS];
    double              arm_m[DIG_JOINTS];
    double              mass_Nm[DIG_JOINTS];
};

static void look(const struct dig_machine *const    corrected,
                 const struct dig_correction *const correction,
                 const struct dig_air_point *const at, struct seen *const seen)
{
    *seen      = (struct seen){ .read = false };
    seen->read = dig_readings_take(corrected, correction, &at->sample, &at->rates,
                                   &seen->readings) == DIG_OK;
    if (!seen->read) {
        return;
    }
    const double *const    joint_rad = seen->readings.joint_rad;
    const struct dig_front front     = dig_front_place(corrected, joint_rad);
    dig_dynamics_Nm(corrected, &front, &at->rates, seen->readings.pitch_rad, seen->mass_Nm);
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_lever lever;
        seen->lever_ok[j] =
            dig_lever_solve(corrected, (enum dig_joint)j, joint_rad[j], &lever) == DIG_OK;
        seen->arm_m[j] = seen->lever_ok[j] ? lever.arm_m : 0.0;
    }
}

// What is left of a joint, N at the rod, and what friction takes of it; held: what it may take
// more.
static void balance_joint(const struct dig_friction *const friction, const size_t j,
                          const struct seen *const seen, const double velocity_radps,
                          const bool held, struct dig_air_balance *const balance)
{
    balance->rest_N[j]  = 0.0;
    balance->taken_N[j] = 0.0;
    if (seen->read && seen->lever_ok[j]) {
        const double arm_m   = seen->arm_m[j];
        const double push_N  = seen->readings.push[j].push_N;
        const double rod_mps = arm_m * velocity_radps;
        const double loss_N  = dig_friction_loss_N(friction, push_N, rod_mps);
        balance->rest_N[j]   = (arm_m * push_N + seen->mass_Nm[j]) / arm_m;
        balance->taken_N[j]  = held ? held_N(friction, push_N, rod_mps, loss_N) : loss_N;
    }
}

// Friction turns about at once where a motion does; averaged over the kernel as all else is.
static double smooth_at(const struct dig_air_balance balance[], const size_t points,
                        const size_t at, const size_t joint)
{
    double sum    = 0.0;
    double weight = 0.0;
    for (int k = -KERNEL; k <= KERNEL; k++) {
        const double u = (double)k * step_s / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        const size_t i = at + (size_t)KERNEL + (size_t)(k + KERNEL);
        if (i >= 2 * (size_t)KERNEL && i - 2 * (size_t)KERNEL < points) {
            sum += w * balance[i - 2 * (size_t)KERNEL].taken_N[joint];
            weight += w;
        }
    }
    return sum / weight;
}

// Balances every point of a segment: what is left of its joints, friction taken off; or what
// friction may take more.
static void balance_all(const struct dig_air *const air, const size_t s,
                        const struct dig_correction *const correction, const bool calm,
                        const bool held)
{
    const struct dig_air_segment *const segment = &air->segment[s];
    const struct dig_air_point *const   point   = &air->point[segment->first_point];
    struct dig_air_balance *const       balance = &air->balance[segment->first_point];
    const struct dig_machine corrected          = dig_correction_machine(&air->machine, correction);
    for (size_t p = 0; p < segment->points; p++) {
        struct dig_air_point at = delayed(point, segment->points, p, correction->delay_s);
        struct seen          seen;
        for (size_t c = 0; calm && c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
            at.sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] = at.calm_Pa[c];
        }
        look(&corrected, correction, &at, &seen);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            balance_joint(&correction->friction[j], j, &seen, at.rates.velocity_radps[j], held,
                          &balance[p]);
        }
    }
    for (size_t p = 0; p < segment->points; p++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const double taken_N = smooth_at(balance, segment->points, p, j);
            balance[p].left_N[j] = held ? taken_N : balance[p].rest_N[j] - taken_N;
        }
    }
}

void dig_air_forces(const struct dig_air *const air, const struct dig_correction correction[],
                    double drive_N[], double load_N[])
{
    assert(air != NULL && correction != NULL && drive_N != NULL && load_N != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        const struct dig_air_point *const   point   = &air->point[segment->first_point];
        const struct dig_machine machine = dig_correction_machine(&air->machine, &correction[s]);
        for (size_t p = 0; p < segment->points; p++) {
            const struct dig_air_point at =
                delayed(point, segment->points, p, correction[s].delay_s);
            struct seen seen;
            look(&machine, &correction[s], &at, &seen);
            for (size_t j = 0; j < DIG_JOINTS; j++) {
                const size_t to    = DIG_JOINTS * (segment->first_point + p) + j;
                const bool   known = seen.read && seen.lever_ok[j] && seen.readings.push[j].valid;
                drive_N[to]        = known ? seen.readings.push[j].push_N : (double)NAN;
                load_N[to]         = known ? -seen.mass_Nm[j] / seen.arm_m[j] : (double)NAN;
            }
        }
    }
}

void dig_air_calm(struct dig_air *const air, const struct dig_correction correction[])
{
    assert(air != NULL && correction != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        struct dig_air_point *const         point   = &air->point[segment->first_point];
        const struct dig_air_balance *const kept    = &air->balance[segment->first_point];
        for (size_t p = 0; p < segment->points; p++) {
            for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
                const bool returns  = segment->mean_Pa[c] < segment->mean_Pa[c ^ 1U];
                point[p].calm_Pa[c] = returns ? segment->mean_Pa[c]
                                              : point[p].sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + c];
            }
        }
        balance_all(air, s, &correction[s], true, false);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const cylinder = &air->machine.cylinder[j];

            const double *const mean_Pa = &segment->mean_Pa[DIG_CHAMBERS * j];
            const bool          head    = !(mean_Pa[DIG_CHAMBER_HEAD] < mean_Pa[DIG_CHAMBER_ROD]);
            const size_t        c = DIG_CHAMBERS * j + (head ? DIG_CHAMBER_HEAD : DIG_CHAMBER_ROD);
            const double        m2 =
                head ? dig_cylinder_head_m2(cylinder) : -dig_cylinder_rod_m2(cylinder);
            for (size_t p = 0; p < segment->points; p++) {
                point[p].calm_Pa[c] -= kept[p].left_N[j] / (cylinder->count * m2);
            }
        }
    }
}

// Means of either over the points of every row, in its sigmas.
static void of_rows(const struct dig_air *const air, const struct dig_correction correction[],
                    const bool calm, const bool held, double out[])
{
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        balance_all(air, s, &correction[s], calm, held);
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const struct dig_air_row *const row   = &air->row[r];
            double                          sum_N = 0.0;
            for (size_t p = row->first; p < row->first + row->points; p++) {
                sum_N += air->balance[p].left_N[row->joint];
            }
            out[r] = sum_N / (double)row->points / row->sigma_N;
        }
    }
}

void dig_air_rest(const struct dig_air *const air, const struct dig_correction correction[],
                  const bool calm, double rest[])
{
    assert(air != NULL && correction != NULL && rest != NULL);
    of_rows(air, correction, calm, false, rest);
}

void dig_air_held(const struct dig_air *const air, const struct dig_correction correction[],
                  double held[])
{
    assert(air != NULL && correction != NULL && held != NULL);
    of_rows(air, correction, false, true, held);
}
