#include "tools/rig/motion/gauge.h"

#include <math.h>

static const double step_m = 1e-5; // and radians

// A point given in the bucket's frame, where the bucket is.
static struct dig_vec2 drawn(const struct dig_rig_pose *const pose, const struct dig_vec2 at_m)
{
    const double far_m = hypot(at_m.x, at_m.y);
    const double rad   = pose->phi_rad + atan2(at_m.y, at_m.x);
    return (struct dig_vec2){ pose->X_m + far_m * cos(rad), pose->Z_m + far_m * sin(rad) };
}

// The bucket after its sensor's origin went by (X, Z) and it turned about that.
static struct dig_rig_pose yielded(const struct dig_machine *const  machine,
                                   const struct dig_rig_pose *const pose, const double X_m,
                                   const double Z_m, const double turn_rad)
{
    const struct dig_vec2     place  = machine->sensor.place_m;
    const struct dig_vec2     before = drawn(pose, place);
    const struct dig_rig_pose turned = { pose->X_m, pose->Z_m, pose->phi_rad + turn_rad };
    const struct dig_vec2     after  = drawn(&turned, place);
    return (struct dig_rig_pose){ pose->X_m + before.x - after.x + X_m,
                                  pose->Z_m + before.y - after.y + Z_m, turned.phi_rad };
}

static double work_J(const struct dig_machine *const    machine,
                     const struct dig_rig_motion *const motion,
                     const struct dig_rig_wrench *const soil, const struct dig_rig_pose *const from,
                     const struct dig_rig_pose *const to)
{
    const struct dig_link *const bucket = &machine->link[DIG_JOINT_BUCKET];
    const struct dig_vec2 com  = dig_vec2_sub(drawn(to, bucket->com_m), drawn(from, bucket->com_m));
    const struct dig_vec2 a    = motion->com_mps2[DIG_JOINT_BUCKET];
    const double          turn = to->phi_rad - from->phi_rad;
    const double          by_soil =
        soil->FX_N * (to->X_m - from->X_m) + soil->FZ_N * (to->Z_m - from->Z_m) + soil->M_Nm * turn;
    const double by_mass = bucket->mass_kg * (-a.x * com.x - (DIG_RIG_GRAVITY_mps2 + a.y) * com.y) -
                           bucket->inertia_kgm2 * motion->turn_radps2[DIG_JOINT_BUCKET] * turn;
    return by_soil + by_mass;
}

struct dig_rig_load dig_rig_gauge_read(const struct dig_machine *const    machine,
                                       const struct dig_rig_pose *const   pose,
                                       const struct dig_rig_motion *const motion,
                                       const struct dig_rig_wrench *const soil)
{
    const double x_rad           = pose->phi_rad + machine->sensor.turn_rad;
    const double direction[3][3] = { { cos(x_rad), sin(x_rad), 0.0 },
                                     { -sin(x_rad), cos(x_rad), 0.0 },
                                     { 0.0, 0.0, 1.0 } };
    double       load[3]         = { 0.0 };
    for (int i = 0; i < 3; i++) {
        const double              X    = step_m * direction[i][0];
        const double              Z    = step_m * direction[i][1];
        const double              turn = step_m * direction[i][2];
        const struct dig_rig_pose to   = yielded(machine, pose, X, Z, turn);
        const struct dig_rig_pose from = yielded(machine, pose, -X, -Z, -turn);
        load[i]                        = work_J(machine, motion, soil, &from, &to) / (2.0 * step_m);
    }
    return (struct dig_rig_load){ load[0], load[1], load[2] };
}

struct dig_rig_motion dig_rig_gauge_motion(const struct dig_machine *const machine,
                                           const struct dig_rig_pose       pose[const 3],
                                           const double                    span_s)
{
    static const double   share[3] = { 1.0, -2.0, 1.0 };
    struct dig_rig_motion motion   = { .turn_radps2 = { 0.0 } };
    for (int k = 0; k < 3; k++) {
        const double          per_s2 = share[k] / (span_s * span_s);
        const struct dig_vec2 com    = drawn(&pose[k], machine->link[DIG_JOINT_BUCKET].com_m);
        motion.com_mps2[DIG_JOINT_BUCKET] =
            dig_vec2_add_scaled(motion.com_mps2[DIG_JOINT_BUCKET], per_s2, com);
        motion.turn_radps2[DIG_JOINT_BUCKET] += per_s2 * pose[k].phi_rad;
    }
    return motion;
}
