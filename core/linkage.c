#include "core/linkage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Where a rocker on n and a link on k meet, on the +y side of the line n-k.
static enum dig_status close_loop(const struct dig_four_bar *const bar, const struct dig_vec2 k,
                                  struct dig_vec2 *const m)
{
    const struct dig_vec2 n      = bar->rocker_pin_m;
    const struct dig_vec2 n_to_k = dig_vec2_sub(k, n);
    const double          span_m = dig_vec2_norm(n_to_k);

    // foot: how far along n-k the point m projects; height: how far off the line it stands.
    const double rocker_m2 = bar->rocker_m * bar->rocker_m;
    const double link_m2   = bar->link_m * bar->link_m;
    const double foot_m    = (span_m * span_m + rocker_m2 - link_m2) / (2.0 * span_m);
    const double height_m2 = rocker_m2 - foot_m * foot_m;

    // Negated so that n and k falling together, which makes the height NaN or -inf, fails too.
    if (!(height_m2 >= DIG_LINKAGE_TOGGLE_MARGIN_m * DIG_LINKAGE_TOGGLE_MARGIN_m)) {
        return DIG_EUNREACHABLE;
    }

    const struct dig_vec2 along  = { n_to_k.x / span_m, n_to_k.y / span_m };
    const struct dig_vec2 across = { -along.y, along.x };

    *m = dig_vec2_add_scaled(dig_vec2_add_scaled(n, foot_m, along), sqrt(height_m2), across);
    return DIG_OK;
}

enum dig_status dig_linkage_solve(const struct dig_machine *const machine, const double bucket_rad,
                                  struct dig_linkage_pose *const pose)
{
    assert(machine != NULL && pose != NULL);
    if (!isfinite(bucket_rad)) {
        return DIG_EINVAL;
    }

    const struct dig_four_bar *const bar = &machine->four_bar;
    const struct dig_vec2            q   = { machine->link[DIG_JOINT_ARM].length_m, 0.0 };
    const struct dig_vec2            ear = dig_vec2_turned(bar->ear_m, bucket_rad);
    const struct dig_vec2            k   = dig_vec2_add_scaled(q, 1.0, ear);
    struct dig_vec2                  m;
    const enum dig_status            closed = close_loop(bar, k, &m);
    if (closed != DIG_OK) {
        return closed;
    }

    const struct dig_vec2 rod      = dig_vec2_sub(m, machine->cylinder[DIG_JOINT_BUCKET].base_m);
    const struct dig_vec2 link     = dig_vec2_sub(k, m);
    const struct dig_vec2 rocker   = dig_vec2_sub(m, bar->rocker_pin_m);
    const double          length_m = dig_vec2_norm(rod);
    if (!(length_m > 0.0)) {
        return DIG_EUNREACHABLE;
    }

    // The rocker balances about N: the rod's push is taken up by thrust along the link. The same
    // thrust then turns the bucket about Q, at K. The link's length cancels; the rod's does not.
    const double thrust_per_push =
        dig_vec2_cross(rocker, rod) / (dig_vec2_cross(rocker, link) * length_m);
    if (!isfinite(thrust_per_push)) {
        return DIG_EUNREACHABLE;
    }

    *pose = (struct dig_linkage_pose){
        .rod_eye_m  = m,
        .link_pin_m = k,
        .lever = { .length_m = length_m, .arm_m = thrust_per_push * dig_vec2_cross(ear, link) },
    };
    return DIG_OK;
}

// Boom and arm: the push acts at the eye, along the line from base to eye.
static enum dig_status solve_pin_cylinder(const struct dig_machine *const machine,
                                          const enum dig_joint joint, const double angle_rad,
                                          struct dig_lever *const lever)
{
    const struct dig_cylinder *const cylinder = &machine->cylinder[joint];

    const double hinge_x_m = joint == DIG_JOINT_ARM ? machine->link[DIG_JOINT_BOOM].length_m : 0.0;
    const struct dig_vec2 hinge      = { hinge_x_m, 0.0 };
    const struct dig_vec2 from_hinge = dig_vec2_turned(cylinder->eye_m, angle_rad);
    const struct dig_vec2 eye        = dig_vec2_add_scaled(hinge, 1.0, from_hinge);
    const struct dig_vec2 rod        = dig_vec2_sub(eye, cylinder->base_m);
    const double          length_m   = dig_vec2_norm(rod);
    if (!(length_m > 0.0)) {
        return DIG_EUNREACHABLE;
    }
    *lever = (struct dig_lever){
        .length_m = length_m,
        .arm_m    = dig_vec2_cross(from_hinge, rod) / length_m,
    };
    return DIG_OK;
}

enum dig_status dig_lever_solve(const struct dig_machine *const machine, const enum dig_joint joint,
                                const double angle_rad, struct dig_lever *const lever)
{
    assert(machine != NULL && lever != NULL && joint < DIG_JOINTS);
    if (!isfinite(angle_rad)) {
        return DIG_EINVAL;
    }
    if (joint != DIG_JOINT_BUCKET) {
        return solve_pin_cylinder(machine, joint, angle_rad, lever);
    }
    struct dig_linkage_pose pose;
    const enum dig_status   status = dig_linkage_solve(machine, angle_rad, &pose);
    if (status == DIG_OK) {
        *lever = pose.lever;
    }
    return status;
}

enum dig_status dig_linkage_check(const struct dig_machine *const machine)
{
    assert(machine != NULL);
    enum { STEPS = 512 };
    if (machine->sensor.fitted) {
        return DIG_OK;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_link *const link = &machine->link[j];
        for (int i = 0; i <= STEPS; i++) {
            const double angle_rad =
                link->min_rad + (link->max_rad - link->min_rad) * (double)i / STEPS;
            struct dig_lever lever;
            if (dig_lever_solve(machine, (enum dig_joint)j, angle_rad, &lever) != DIG_OK) {
                return DIG_EUNREACHABLE;
            }
        }
    }
    return DIG_OK;
}
