#include "tools/rig/motion/air.h"

#include "tools/rig/motion/mechanism.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const double hold_s      = 0.5;
static const double most_radps  = 0.5;
static const double most_radps2 = 0.8;
// Of the polynomial of degree five from rest to rest: peak rate times T / way, and acceleration.
static const double rate_factor         = 1.875;
static const double acceleration_factor = 5.7735;

enum { MOVES = 14 };

// Where the front rests, in order: boom, arm and bucket as a share of their range.
struct stop {
    double share[DIG_JOINTS];
};

static const struct stop stop[MOVES + 1] = {
    { { 0.5, 0.5, 0.5 } },    { { 0.15, 0.5, 0.5 } },                           // boom alone
    { { 0.85, 0.5, 0.5 } },   { { 0.5, 0.5, 0.5 } },  { { 0.5, 0.15, 0.5 } },   // arm
    { { 0.5, 0.85, 0.5 } },   { { 0.5, 0.5, 0.5 } },  { { 0.5, 0.5, 0.15 } },   // bucket
    { { 0.5, 0.5, 0.85 } },   { { 0.5, 0.5, 0.5 } },  { { 0.85, 0.15, 0.85 } }, // all three
    { { 0.15, 0.85, 0.15 } }, { { 0.7, 0.7, 0.3 } },  { { 0.4, 0.3, 0.7 } },
    { { 0.5, 0.5, 0.5 } },
};

static double angle_rad(const struct dig_machine *const machine, const struct stop *const at,
                        const int joint)
{
    const struct dig_link *const link = &machine->link[joint];
    return link->min_rad + at->share[joint] * (link->max_rad - link->min_rad);
}

// Frames of a move from one stop to another.
static size_t frames_of(const struct dig_machine *const machine, const struct stop *const from,
                        const struct stop *const to)
{
    double seconds = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double way_rad = fabs(angle_rad(machine, to, j) - angle_rad(machine, from, j));

        seconds = fmax(seconds, fmax(rate_factor * way_rad / most_radps,
                                     sqrt(acceleration_factor * way_rad / most_radps2)));
    }
    return (size_t)lround(seconds / DIG_RIG_STEP_s);
}

static void put(const struct dig_machine *const machine, const struct stop *const from,
                const struct stop *const to, const double s, struct dig_rig_path *const path)
{
    const double          done = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    struct dig_rig_joints joints;
    for (int j = 0; j < DIG_JOINTS; j++) {
        joints.rad[j] =
            (1.0 - done) * angle_rad(machine, from, j) + done * angle_rad(machine, to, j);
    }
    path->frame[path->frames++] =
        (struct dig_rig_frame){ .pose = dig_rig_front_at(machine, &joints).bucket };
}

enum dig_status dig_rig_air_build(const struct dig_machine *const machine,
                                  struct dig_rig_path *const path, struct dig_error *const error)
{
    assert(machine != NULL && path != NULL);
    if (machine->sensor.fitted) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: a bucket on a force sensor, expected a machine with joints",
                             machine->name);
    }
    const size_t rest = (size_t)lround(hold_s / DIG_RIG_STEP_s);
    size_t       room = rest;
    for (size_t m = 0; m < MOVES; m++) {
        room += frames_of(machine, &stop[m], &stop[m + 1]) + rest;
    }
    struct dig_rig_path made = { .frame = malloc(room * sizeof made.frame[0]) };
    if (made.frame == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%zu frames", room);
    }
    for (size_t i = 0; i < rest; i++) {
        put(machine, &stop[0], &stop[0], 1.0, &made);
    }
    for (size_t m = 0; m < MOVES; m++) {
        const size_t frames = frames_of(machine, &stop[m], &stop[m + 1]);
        for (size_t i = 1; i <= frames; i++) {
            put(machine, &stop[m], &stop[m + 1], (double)i / (double)frames, &made);
        }
        for (size_t i = 0; i < rest; i++) {
            put(machine, &stop[m + 1], &stop[m + 1], 1.0, &made);
        }
    }
    *path = made;
    return DIG_OK;
}
