#include "closed_loop/machine_digs/free_air.h"

#include "core/sample.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

// Kept clear of the soil at both ends of the air: blends of the motion, and the rates' half.
static const double clear_s = 0.25;

// And after the dump, as pressures may be late.
static const double dumped_s = 0.6;

// A dump opens the bucket by this much at least, and is over once it closes again by this, rad.
static const double dump_rad   = 0.12;
static const double closed_rad = 0.02;

// Of the depth of a dig: deeper below its ground the bucket digs, higher above it does not touch
// it.
static const double below_share = 0.3;
static const double above_share = 0.1;

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

enum place { ABOVE, ON_GROUND, BELOW };

// The ground of a dig where its tooth goes in.
struct ground {
    double z_m, depth_m, tooth_m;
};

static struct ground ground_of(const struct dig_vertices *const v, const size_t start,
                               const size_t end, const double tooth_m)
{
    const double z_m       = tooth_z_m(&v->point[start], tooth_m);
    double       deepest_m = z_m;
    for (size_t i = start; i < end; i++) {
        deepest_m = fmin(deepest_m, tooth_z_m(&v->point[i], tooth_m));
    }
    return (struct ground){ z_m, z_m - deepest_m, tooth_m };
}

static enum place place_of(const struct ground *const ground, const struct dig_path_point *const at)
{
    const double off_m = tooth_z_m(at, ground->tooth_m) - ground->z_m;
    return off_m > above_share * ground->depth_m    ? ABOVE
           : off_m < -below_share * ground->depth_m ? BELOW
                                                    : ON_GROUND;
}

// The air before a dig begins where the bucket last came from the ground, or dumped what it had dug
// there, and ends where it goes down to the dig or rests on the ground.
static void clear_before(const struct dig_vertices *const v, const struct ground *const ground,
                         struct dig_machine_dig *const dig)
{
    size_t down  = 0; // the vertex from which on it is not above
    bool   dug   = false;
    bool   above = false;
    size_t i     = 0;
    for (; i < v->count && v->sample[i] < dig->before_end; i++) {
        const enum place place = place_of(ground, &v->point[i]);
        if (place == ABOVE && !above) {
            dig->before = v->sample[i];
            if (dug) {
                dig->before = find_dumped(dig, v->sample[i], dig->before_end);
            }
            dug = false;
        }
        above = place == ABOVE;
        dug   = dug || place == BELOW;
        down  = above ? i + 1 : down;
    }
    if (down < i) {
        dig->before_end = v->sample[down];
    }
}

// The air behind the dump, up to where the bucket goes to the ground.
static void clear_after(const struct dig_vertices *const v, const struct ground *const ground,
                        struct dig_machine_dig *const dig)
{
    bool above = false;
    for (size_t i = 0; i < v->count; i++) {
        const bool is = place_of(ground, &v->point[i]) == ABOVE;
        if (v->sample[i] < dig->after) {
            above = is;
        } else if (is && !above) {
            dig->after = v->sample[i];
            above      = true;
        } else if (!is && above) {
            dig->after_end = v->sample[i - 1];
            return;
        }
    }
    if (!above) {
        dig->after = dig->after_end;
    }
}

void dig_free_air_find(const struct dig_vertices *const v, const size_t start, const size_t end,
                       const double tooth_m, struct dig_machine_dig *const dig)
{
    assert(v != NULL && start < v->count && dig != NULL && dig->samples > 0);
    const double contact_s     = dig->time_s[dig->contact < dig->samples ? dig->contact : 0];
    dig->before_end            = dig_machine_dig_sample_at(dig, contact_s - clear_s);
    dig->after                 = find_dumped(dig, dig->end, dig->samples);
    dig->after_end             = dig->samples;
    const struct ground ground = ground_of(v, start, end, tooth_m);
    clear_before(v, &ground, dig);
    clear_after(v, &ground, dig);
}
