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

// Levers and masses; half of all that is asked differs in pressures or friction alone.
static const struct dig_air_pose *pose_of(const struct dig_machine *const  corrected,
                                          const struct dig_readings *const readings,
                                          const struct dig_rates *const    rates,
                                          struct dig_air_pose *const       pose)
{
    if (pose->known) {
        return pose;
    }
    const struct dig_front front = dig_front_place(corrected, readings->joint_rad);
    dig_dynamics_Nm(corrected, &front, rates, readings->pitch_rad, pose->mass_Nm);
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_lever lever;
        pose->lever_ok[j] =
            dig_lever_solve(corrected, (enum dig_joint)j, readings->joint_rad[j], &lever) == DIG_OK;
        pose->arm_m[j] = pose->lever_ok[j] ? lever.arm_m : 0.0;
    }
    pose->known = true;
    return pose;
}

// True when two corrections' numbers are the same from one on: they are structs of doubles.
static bool alike(const struct dig_correction *const a, const struct dig_correction *const b,
                  const size_t from)
{
    const double *const one   = (const double *)(const void *)a;
    const double *const other = (const double *)(const void *)b;
    const size_t        to    = sizeof *a / sizeof(double);
    size_t              i     = from;
    while (i < to && fabs(one[i] - other[i]) <= 0.0) {
        i++;
    }
    return i == to;
}

// What is left of the joints at one point, N at the rods, and what friction takes of it; held: what
// it may take more.
static void rest_at(const struct dig_machine *const    corrected,
                    const struct dig_correction *const correction,
                    struct dig_air_point *const point, const bool calm, const bool held,
                    struct dig_air_pose *const kept, double rest_N[DIG_JOINTS],
                    double taken_N[DIG_JOINTS])
{
    for (size_t c = 0; calm && c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
        point->sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] = point->calm_Pa[c];
    }
    struct dig_readings readings;
    const bool read = dig_readings_take(corrected, correction, &point->sample, &point->rates,
                                        &readings) == DIG_OK;
    const struct dig_air_pose *const pose =
        read ? pose_of(corrected, &readings, &point->rates, kept) : NULL;
    for (int j = 0; j < DIG_JOINTS; j++) {
        rest_N[j]  = 0.0;
        taken_N[j] = 0.0;
        if (pose != NULL && pose->lever_ok[j]) {
            const struct dig_friction *const friction = &correction->friction[j];

            const double arm_m   = pose->arm_m[j];
            const double push_N  = readings.push[j].push_N;
            const double rod_mps = arm_m * point->rates.velocity_radps[j];
            const double loss_N  = dig_friction_loss_N(friction, push_N, rod_mps);
            rest_N[j]            = (arm_m * push_N + pose->mass_Nm[j]) / arm_m;
            taken_N[j]           = held ? held_N(friction, push_N, rod_mps, loss_N) : loss_N;
        }
    }
}

// Friction turns about at once where a motion does; averaged over the kernel as all else is.
static double smooth_at(const double (*const taken_N)[DIG_JOINTS], const size_t points,
                        const size_t at, const size_t joint)
{
    double sum    = 0.0;
    double weight = 0.0;
    for (int k = -KERNEL; k <= KERNEL; k++) {
        const double u = (double)k * step_s / half_s;
        const double w = (1.0 - u * u) * (1.0 - u * u);
        const size_t i = at + (size_t)KERNEL + (size_t)(k + KERNEL);
        if (i >= 2 * (size_t)KERNEL && i - 2 * (size_t)KERNEL < points) {
            sum += w * taken_N[i - 2 * (size_t)KERNEL][joint];
            weight += w;
        }
    }
    return sum / weight;
}

// All of every point of a segment into the scratch: rests, and what friction takes, or may take
// more.
static void rest_of(const struct dig_air *const air, const size_t s,
                    const struct dig_correction *const correction, const bool calm, const bool held)
{
    double(*const rest_N)[DIG_JOINTS]         = (double(*)[DIG_JOINTS])(void *)air->scratch;
    struct dig_air_segment *const     segment = &air->segment[s];
    const struct dig_air_point *const point   = &air->point[segment->first_point];
    double(*const taken_N)[DIG_JOINTS]        = rest_N + segment->points;
    const struct dig_machine   corrected      = dig_correction_machine(&air->machine, correction);
    struct dig_air_pose *const pose           = &air->pose[segment->first_point];
    // Levers, masses and delay follow all of a correction but the pressures'.
    const size_t geometry = offsetof(struct dig_correction, link) / sizeof(double);
    if (!alike(correction, &segment->posed, geometry)) {
        segment->posed = *correction;
        for (size_t p = 0; p < segment->points; p++) {
            pose[p].known = false;
        }
    }
    for (size_t p = 0; p < segment->points; p++) {
        struct dig_air_point at = delayed(point, segment->points, p, correction->delay_s);
        rest_at(&corrected, correction, &at, calm, held, &pose[p], rest_N[p], taken_N[p]);
    }
}

// What is left of a joint at one point, friction taken off; or what friction may take more.
static double of_point_N(const struct dig_air *const air, const size_t s, const size_t point,
                         const size_t joint, const bool held)
{
    const double(*const rest_N)[DIG_JOINTS] = (const double(*)[DIG_JOINTS])(void *)air->scratch;
    const size_t points                     = air->segment[s].points;
    const double taken_N                    = smooth_at(rest_N + points, points, point, joint);
    return held ? taken_N : rest_N[point][joint] - taken_N;
}

// Of one point: pushes and loads.
static void forces_at(const struct dig_machine *const    machine,
                      const struct dig_correction *const correction,
                      const struct dig_air_point *const at, double drive_N[DIG_JOINTS],
                      double load_N[DIG_JOINTS])
{
    struct dig_air_pose pose = { .known = false };
    struct dig_readings readings;
    const bool          read =
        dig_readings_take(machine, correction, &at->sample, &at->rates, &readings) == DIG_OK;
    if (read) {
        (void)pose_of(machine, &readings, &at->rates, &pose);
    }
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const bool known = read && pose.lever_ok[j] && readings.push[j].valid;
        drive_N[j]       = known ? readings.push[j].push_N : (double)NAN;
        load_N[j]        = known ? -pose.mass_Nm[j] / pose.arm_m[j] : (double)NAN;
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
            const size_t to = DIG_JOINTS * (segment->first_point + p);

            struct dig_air_point at = delayed(point, segment->points, p, correction[s].delay_s);
            forces_at(&machine, &correction[s], &at, &drive_N[to], &load_N[to]);
        }
    }
}

void dig_air_calm(struct dig_air *const air, const struct dig_correction correction[])
{
    assert(air != NULL && correction != NULL);
    for (size_t s = 0; s < air->segments; s++) {
        const struct dig_air_segment *const segment = &air->segment[s];
        struct dig_air_point *const         point   = &air->point[segment->first_point];
        for (size_t p = 0; p < segment->points; p++) {
            for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
                const bool returns  = segment->mean_Pa[c] < segment->mean_Pa[c ^ 1U];
                point[p].calm_Pa[c] = returns ? segment->mean_Pa[c]
                                              : point[p].sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + c];
            }
        }
        rest_of(air, s, &correction[s], true, false);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const cylinder = &air->machine.cylinder[j];

            const double *const mean_Pa = &segment->mean_Pa[DIG_CHAMBERS * j];
            const bool          head    = !(mean_Pa[DIG_CHAMBER_HEAD] < mean_Pa[DIG_CHAMBER_ROD]);
            const size_t        c = DIG_CHAMBERS * j + (head ? DIG_CHAMBER_HEAD : DIG_CHAMBER_ROD);
            const double        m2 =
                head ? dig_cylinder_head_m2(cylinder) : -dig_cylinder_rod_m2(cylinder);
            for (size_t p = 0; p < segment->points; p++) {
                point[p].calm_Pa[c] -= of_point_N(air, s, p, j, false) / (cylinder->count * m2);
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
        rest_of(air, s, &correction[s], calm, held);
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const struct dig_air_row *const row   = &air->row[r];
            const size_t                    first = row->first - segment->first_point;
            double                          sum_N = 0.0;
            for (size_t p = first; p < first + row->points; p++) {
                sum_N += of_point_N(air, s, p, row->joint, held);
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
