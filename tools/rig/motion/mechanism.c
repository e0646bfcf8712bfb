#include "tools/rig/motion/mechanism.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

static const double difference_rad = 1e-5;

// A vector that is given in a frame with that x axis.
static struct dig_vec2 along(const struct dig_vec2 v, const struct dig_vec2 x_axis)
{
    return (struct dig_vec2){ x_axis.x * v.x - x_axis.y * v.y, x_axis.y * v.x + x_axis.x * v.y };
}

static struct dig_vec2 turned(const struct dig_vec2 v, const double angle_rad)
{
    return along(v, (struct dig_vec2){ cos(angle_rad), sin(angle_rad) });
}

static struct dig_vec2 sum(const struct dig_vec2 a, const struct dig_vec2 b)
{
    return dig_vec2_add_scaled(a, 1.0, b);
}

// From pin to pin; each link turns by its joint against the link before it.
struct dig_rig_front dig_rig_front_at(const struct dig_machine *const    machine,
                                      const struct dig_rig_joints *const joints)
{
    struct dig_rig_front front;
    struct dig_vec2      pin       = { 0.0, 0.0 };
    double               angle_rad = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_link *const link = &machine->link[j];
        angle_rad += joints->rad[j];
        const struct dig_vec2 x_axis = { cos(angle_rad), sin(angle_rad) };
        front.attitude_rad[j]        = angle_rad;
        front.com_m[j]               = sum(pin, along(link->com_m, x_axis));
        front.bucket = (struct dig_rig_pose){ .X_m = pin.x, .Z_m = pin.y, .phi_rad = angle_rad };
        pin          = sum(pin, along((struct dig_vec2){ link->length_m, 0.0 }, x_axis));
    }
    return front;
}

struct dig_vec2 dig_rig_on_bucket(const struct dig_rig_pose *const pose, const struct dig_vec2 at_m)
{
    return sum((struct dig_vec2){ pose->X_m, pose->Z_m }, turned(at_m, pose->phi_rad));
}

struct dig_rig_front dig_rig_front_carried(const struct dig_machine *const  machine,
                                           const struct dig_rig_pose *const pose)
{
    struct dig_rig_front front           = { .bucket = *pose };
    front.attitude_rad[DIG_JOINT_BUCKET] = pose->phi_rad;
    front.com_m[DIG_JOINT_BUCKET] = dig_rig_on_bucket(pose, machine->link[DIG_JOINT_BUCKET].com_m);
    return front;
}

enum dig_status dig_rig_inverse(const struct dig_machine *const  machine,
                                const struct dig_rig_pose *const pose,
                                struct dig_rig_joints *const     joints)
{
    const double boom_m  = machine->link[DIG_JOINT_BOOM].length_m;
    const double arm_m   = machine->link[DIG_JOINT_ARM].length_m;
    const double reach_m = hypot(pose->X_m, pose->Z_m);

    // Cosine rule in the triangle boom foot, arm pin, bucket pin: the corners at foot and arm pin.
    const double cos_foot =
        (boom_m * boom_m + reach_m * reach_m - arm_m * arm_m) / (2.0 * boom_m * reach_m);
    const double cos_pin =
        (boom_m * boom_m + arm_m * arm_m - reach_m * reach_m) / (2.0 * boom_m * arm_m);
    if (!(fabs(cos_foot) < 1.0 && fabs(cos_pin) < 1.0 && isfinite(pose->phi_rad))) {
        return DIG_EUNREACHABLE;
    }

    const double boom_rad = atan2(pose->Z_m, pose->X_m) + acos(cos_foot);
    const double arm_rad  = acos(cos_pin) - acos(-1.0); // folded down: between -pi and 0
    *joints               = (struct dig_rig_joints){
                      .rad = { boom_rad, arm_rad, pose->phi_rad - boom_rad - arm_rad },
    };
    return DIG_OK;
}

// Where rocker and link of the four-bar meet, in the arm frame.
static enum dig_status rod_eye_m(const struct dig_machine *const machine, const double bucket_rad,
                                 struct dig_vec2 *const eye)
{
    const struct dig_four_bar *const bar = &machine->four_bar;
    const struct dig_vec2            q   = { machine->link[DIG_JOINT_ARM].length_m, 0.0 };
    const struct dig_vec2            k   = sum(q, turned(bar->ear_m, bucket_rad));

    // The corner at N of the triangle N, K, M turns M off the direction of K, towards +y.
    const struct dig_vec2 diagonal = dig_vec2_sub(k, bar->rocker_pin_m);
    const double          span_m   = dig_vec2_norm(diagonal);
    const double          cos_corner =
        (bar->rocker_m * bar->rocker_m + span_m * span_m - bar->link_m * bar->link_m) /
        (2.0 * bar->rocker_m * span_m);
    if (!(fabs(cos_corner) < 1.0)) {
        return DIG_EUNREACHABLE;
    }
    const struct dig_vec2 rocker = { bar->rocker_m, 0.0 };
    const double          at_rad = atan2(diagonal.y, diagonal.x) + acos(cos_corner);
    *eye                         = sum(bar->rocker_pin_m, turned(rocker, at_rad));
    return DIG_OK;
}

enum dig_status dig_rig_cylinder_m(const struct dig_machine *const machine,
                                   const enum dig_joint joint, const double angle_rad,
                                   double *const length_m)
{
    assert(joint < DIG_JOINTS);
    const struct dig_cylinder *const cylinder = &machine->cylinder[joint];

    // The moving end, in the frame the base is given in.
    struct dig_vec2 eye = { 0.0, 0.0 };
    if (joint == DIG_JOINT_BUCKET) {
        const enum dig_status closed = rod_eye_m(machine, angle_rad, &eye);
        if (closed != DIG_OK) {
            return closed;
        }
    } else {
        const struct dig_vec2 hinge = {
            joint == DIG_JOINT_ARM ? machine->link[DIG_JOINT_BOOM].length_m : 0.0, 0.0
        };
        eye = sum(hinge, turned(cylinder->eye_m, angle_rad));
    }
    const double result_m = dig_vec2_norm(dig_vec2_sub(eye, cylinder->base_m));
    if (!(result_m > 0.0 && isfinite(result_m))) {
        return DIG_EUNREACHABLE;
    }
    *length_m = result_m;
    return DIG_OK;
}

enum dig_status dig_rig_lever_m(const struct dig_machine *const machine, const enum dig_joint joint,
                                const double angle_rad, double *const lever_m)
{
    double          longer_m;
    double          shorter_m;
    enum dig_status status =
        dig_rig_cylinder_m(machine, joint, angle_rad + difference_rad, &longer_m);
    if (status == DIG_OK) {
        status = dig_rig_cylinder_m(machine, joint, angle_rad - difference_rad, &shorter_m);
    }
    if (status == DIG_OK) {
        *lever_m = (longer_m - shorter_m) / (2.0 * difference_rad);
    }
    return status;
}
