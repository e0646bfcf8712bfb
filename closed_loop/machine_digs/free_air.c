#include "closed_loop/machine_digs/free_air.h"

#include "core/sample.h"

#include <assert.h>
#include <math.h>

// Kept clear of the soil at both ends of the air: blends of the motion, and the rates' half.
static const double clear_s = 0.25;

// And after the dump, as pressures may be late.
static const double dumped_s = 0.6;

// A dump opens the bucket by this much at least, and is over once it closes again by this, rad.
static const double dump_rad   = 0.12;
static const double closed_rad = 0.02;

// Of the depth of a dig: deeper below its ground the bucket digs, higher above it does not.
static const double part_share = 0.3;

static double phi_at(const struct dig_sample *const sample)
{
    return sample->value[DIG_SIGNAL_BOOM_rad] + sample->value[DIG_SIGNAL_ARM_rad] +
           sample->value[DIG_SIGNAL_BUCKET_rad];
}

// The load is gone once the bucket has opened and begins to close again.
static size_t find_dumped(const struct dig_machine_dig *const dig, const size_t from,
                          const size_t to)
{
    double least_rad = INFINITY;
    double most_rad  = -INFINITY;
    size_t most      = dig->samples;
    for (size_t i = from; i < to; i++) {
        const double phi_rad = phi_at(&dig->sample[i]);
        least_rad            = fmin(least_rad, phi_rad);
        if (phi_rad > most_rad) {
            most_rad = phi_rad;
            most     = i;
        }
        if (most_rad < least_rad + dump_rad) {
            most_rad = phi_rad; // still closed: the most is counted from where it is least
        } else if (phi_rad < most_rad - closed_rad) {
            return dig_machine_dig_sample_at(dig, dig->time_s[most] + dumped_s);
        }
    }
    return dig->samples;
}

static double tooth_z_m(const struct dig_path_point *const at, const double tooth_m)
{
    return at->z_m - tooth_m * cos(at->turn_m / tooth_m);
}

// Ends the air where the bucket goes to another dig: below the ground of this one, by a part of
// what it is deep. The ground itself is known to such a part.
static void leave_out_other_digs(const struct dig_vertices *const v, const size_t start,
                                 const size_t end, const double tooth_m,
                                 struct dig_machine_dig *const dig)
{
    const double ground_m  = tooth_z_m(&v->point[start], tooth_m);
    double       deepest_m = ground_m;
    for (size_t i = start; i < end; i++) {
        deepest_m = fmin(deepest_m, tooth_z_m(&v->point[i], tooth_m));
    }
    const double part_m = part_share * (ground_m - deepest_m);
    size_t       above  = 0; // the last sample that is clear of the ground
    for (size_t i = 0; i < v->count; i++) {
        const double off_m = tooth_z_m(&v->point[i], tooth_m) - ground_m;
        if (off_m > part_m) {
            above = v->sample[i];
        } else if (off_m < -part_m && v->sample[i] < dig->before_end) {
            dig->before = find_dumped(dig, v->sample[i], dig->before_end);
        } else if (off_m < -part_m && v->sample[i] >= dig->after) {
            dig->after_end = above;
            return;
        }
    }
}

void dig_free_air_find(const struct dig_vertices *const v, const size_t start, const size_t end,
                       const double tooth_m, struct dig_machine_dig *const dig)
{
    assert(v != NULL && start < v->count && dig != NULL && dig->samples > 0);
    const double contact_s = dig->time_s[dig->contact < dig->samples ? dig->contact : 0];
    dig->before_end        = dig_machine_dig_sample_at(dig, contact_s - clear_s);
    dig->after             = find_dumped(dig, dig->end, dig->samples);
    dig->after_end         = dig->samples;
    leave_out_other_digs(v, start, end, tooth_m, dig);
}
