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

// What of a balance has to be worked out anew.
struct stale {
    bool readings, masses;
    bool lever[DIG_JOINTS], joint[DIG_JOINTS]; // a joint's lever; any of what is left of it
};

// True when numbers of two corrections differ: they are structs of doubles.
static bool differ(const void *const a, const void *const b, const size_t bytes)
{
    const double *const one   = a;
    const double *const other = b;
    bool                same  = true;
    for (size_t i = 0; i < bytes / sizeof(double); i++) {
        same = same && fabs(one[i] - other[i]) <= 0.0;
    }
    return !same;
}

static const struct stale all = { true, true, { true, true, true }, { true, true, true } };

#define DIFFER(member) differ(&a->member, &b->member, sizeof a->member)

static struct stale stale_between(const struct dig_correction *const a,
                                  const struct dig_correction *const b, const bool other_way)
{
    struct stale stale  = { .readings = other_way };
    const bool   late   = DIFFER(delay_s);
    const bool   loads  = DIFFER(link) || DIFFER(payload);
    const bool   angles = DIFFER(angle_rad) || DIFFER(level_rad) || late;
    const bool   bars = DIFFER(rocker_m) || DIFFER(link_m) || DIFFER(rocker_pin_m) || DIFFER(ear_m);
    stale.masses      = loads || angles;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const bool pushes = DIFFER(offset_Pa[j]) || DIFFER(gain[j]);
        stale.readings    = stale.readings || pushes || angles;
        stale.lever[j]    = DIFFER(base_m[j]) || DIFFER(eye_m[j]) || DIFFER(angle_rad[j]) || late ||
                         (j == DIG_JOINT_BUCKET && bars);
        stale.joint[j] =
            other_way || pushes || stale.lever[j] || stale.masses || DIFFER(friction[j]);
    }
    return stale;
}

static struct stale stale_of(const struct dig_air_segment *const segment,
                             const struct dig_correction *const correction, const bool calm,
                             const bool held)
{
    return segment->known ? stale_between(&segment->asked, correction,
                                          calm != segment->calm || held != segment->held)
                          : all;
}

static void read_point(const struct dig_machine *const    corrected,
                       const struct dig_correction *const correction,
                       struct dig_air_point *const at, const bool calm,
                       struct dig_air_balance *const kept)
{
    for (size_t c = 0; calm && c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
        at->sample.value[(size_t)DIG_SIGNAL_BOOM_HEAD_Pa + c] = at->calm_Pa[c];
    }
    kept->rates = at->rates;
    kept->read  = dig_readings_take(corrected, correction, &at->sample, &at->rates,
                                    &kept->readings) == DIG_OK;
}

// Levers and masses.
static void pose(const struct dig_machine *const corrected, const struct stale *const stale,
                 struct dig_air_balance *const kept)
{
    const struct dig_readings *const readings = &kept->readings;
    if (stale->masses) {
        const struct dig_front front = dig_front_place(corrected, readings->joint_rad);
        dig_dynamics_Nm(corrected, &front, &kept->rates, readings->pitch_rad, kept->mass_Nm);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_lever lever;
        if (stale->lever[j]) {
            kept->lever_ok[j] = dig_lever_solve(corrected, (enum dig_joint)j,
                                                readings->joint_rad[j], &lever) == DIG_OK;
            kept->arm_m[j]    = kept->lever_ok[j] ? lever.arm_m : 0.0;
        }
    }
}

// What is left of a joint, N at the rod, and what friction takes of it; held: what it may take
// more.
static void balance_joint(const struct dig_friction *const friction, const size_t j,
                          const bool held, struct dig_air_balance *const kept)
{
    kept->rest_N[j]  = 0.0;
    kept->taken_N[j] = 0.0;
    if (kept->read && kept->lever_ok[j]) {
        const double arm_m   = kept->arm_m[j];
        const double push_N  = kept->readings.push[j].push_N;
        const double rod_mps = arm_m * kept->rates.velocity_radps[j];
        const double loss_N  = dig_friction_loss_N(friction, push_N, rod_mps);
        kept->rest_N[j]      = (arm_m * push_N + kept->mass_Nm[j]) / arm_m;
        kept->taken_N[j]     = held ? held_N(friction, push_N, rod_mps, loss_N) : loss_N;
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
static void balance(const struct dig_air *const air, const size_t s,
                    const struct dig_correction *const correction, const bool calm, const bool held)
{
    struct dig_air_segment *const     segment   = &air->segment[s];
    const struct dig_air_point *const point     = &air->point[segment->first_point];
    struct dig_air_balance *const     kept      = &air->balance[segment->first_point];
    const struct dig_machine          corrected = dig_correction_machine(&air->machine, correction);
    const struct stale                stale     = stale_of(segment, correction, calm, held);
    bool turned = false; // whether a point is read that was not, or the other way
    for (size_t p = 0; p < segment->points; p++) {
        const bool was_read = segment->known && kept[p].read;
        if (stale.readings) {
            struct dig_air_point at = delayed(point, segment->points, p, correction->delay_s);
            read_point(&corrected, correction, &at, calm, &kept[p]);
        }
        const struct stale *const now = kept[p].read == was_read ? &stale : &all;

        turned = turned || now == &all;
        if (kept[p].read) {
            pose(&corrected, now, &kept[p]);
        }
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            if (now->joint[j]) {
                balance_joint(&correction->friction[j], j, held, &kept[p]);
            }
        }
    }
    for (size_t p = 0; p < segment->points; p++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            if (stale.joint[j] || turned) {
                const double taken_N = smooth_at(kept, segment->points, p, j);
                kept[p].left_N[j]    = held ? taken_N : kept[p].rest_N[j] - taken_N;
            }
        }
    }
    segment->asked = *correction;
    segment->known = true;
    segment->calm  = calm;
    segment->held  = held;
}

// Of one point: pushes and loads.
static void forces_at(const struct dig_machine *const    machine,
                      const struct dig_correction *const correction, struct dig_air_point *const at,
                      double drive_N[DIG_JOINTS], double load_N[DIG_JOINTS])
{
    struct dig_air_balance made;
    read_point(machine, correction, at, false, &made);
    if (made.read) {
        pose(machine, &all, &made);
    }
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const bool known = made.read && made.lever_ok[j] && made.readings.push[j].valid;
        drive_N[j]       = known ? made.readings.push[j].push_N : (double)NAN;
        load_N[j]        = known ? -made.mass_Nm[j] / made.arm_m[j] : (double)NAN;
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
        struct dig_air_segment *const       segment = &air->segment[s];
        struct dig_air_point *const         point   = &air->point[segment->first_point];
        const struct dig_air_balance *const kept    = &air->balance[segment->first_point];
        for (size_t p = 0; p < segment->points; p++) {
            for (size_t c = 0; c < (size_t)DIG_JOINTS * DIG_CHAMBERS; c++) {
                const bool returns  = segment->mean_Pa[c] < segment->mean_Pa[c ^ 1U];
                point[p].calm_Pa[c] = returns ? segment->mean_Pa[c]
                                              : point[p].sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + c];
            }
        }
        segment->known = false; // by other pressures than these
        balance(air, s, &correction[s], true, false);
        segment->known = false;
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
        balance(air, s, &correction[s], calm, held);
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
