#include "estimator/track/motion.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Length of the rope, in tooth lengths.
static const double rope_share = 1.0 / 30.0;

// Time constant of the low-pass: without it, rare noise of the angles turns the rope in a long
// pause.
static const double settle_s = 0.03;

// A tooth that moves up or down more steeply than this is not dragged; a bucket curls when its turn
// exceeds the path of the pin (45 degrees). The hysteresis moves each border away from the last
// motion.
static const double steep_rad = 30.0 * DIG_RAD_PER_DEG;
static const double turns_rad = 45.0 * DIG_RAD_PER_DEG;
static const double more_rad  = 5.0 * DIG_RAD_PER_DEG;

// Tows the tail; false: the rope is slack, and has no direction.
static bool tow(struct dig_motion_state *const state, const double rope_m, const double share,
                const struct dig_path_point *const point, struct dig_path_point *const step)
{
    if (!state->towed) {
        *state = (struct dig_motion_state){ .towed = true, .point = *point, .tail = *point };
        return false;
    }
    state->point =
        dig_path_point_add_scaled(state->point, share, dig_path_point_sub(*point, state->point));
    const struct dig_path_point off   = dig_path_point_sub(state->point, state->tail);
    const double                far_m = sqrt(dig_path_point_dot(off, off));
    if (!(far_m > rope_m)) {
        return false;
    }
    state->tail = dig_path_point_add_scaled(state->tail, (far_m - rope_m) / far_m, off);
    *step       = off;
    return true;
}

static enum dig_motion classify(const enum dig_motion now, const double theta_rad,
                                const struct dig_path_point *const step)
{
    const double turned_rad  = atan2(fabs(step->turn_m), hypot(step->x_m, step->z_m));
    const double to_turn_rad = now == DIG_MOTION_NONE   ? 0.0
                               : now == DIG_MOTION_CURL ? -more_rad
                                                        : more_rad;
    if (turned_rad > turns_rad + to_turn_rad) {
        return step->turn_m > 0.0 ? DIG_MOTION_CURL : now;
    }

    // The tooth is at pin + L (sin theta, -cos theta).
    const double forth_m      = step->x_m + step->turn_m * cos(theta_rad);
    const double up_m         = step->z_m + step->turn_m * sin(theta_rad);
    const double up_rad       = atan2(up_m, fabs(forth_m));
    const bool   steep        = now == DIG_MOTION_PENETRATION || now == DIG_MOTION_LIFT;
    const double to_steep_rad = steep ? -more_rad : now == DIG_MOTION_DRAG ? more_rad : 0.0;
    if (fabs(up_rad) > steep_rad + to_steep_rad) {
        return up_rad < 0.0 ? DIG_MOTION_PENETRATION : DIG_MOTION_LIFT;
    }
    return forth_m > 0.0 ? DIG_MOTION_DRAG : now;
}

enum dig_motion dig_motion_step(struct dig_motion_state *const state, const double tooth_m,
                                const double dt_s, const enum dig_dig_phase phase,
                                const struct dig_path_point *const point)
{
    assert(state != NULL && tooth_m > 0.0 && point != NULL);
    struct dig_path_point step  = { 0.0, 0.0, 0.0 };
    const double          share = dt_s / (settle_s + dt_s);
    const bool            moved = tow(state, rope_share * tooth_m, share, point, &step);
    if (phase == DIG_PHASE_AIR) {
        state->motion = DIG_MOTION_NONE;
        return DIG_MOTION_NONE;
    }
    if (moved) {
        state->motion = classify(state->motion, state->point.turn_m / tooth_m, &step);
    }
    return phase == DIG_PHASE_EXIT ? DIG_MOTION_NONE : state->motion;
}
