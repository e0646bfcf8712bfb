#include "tools/rig/motion/gauge.h"

#include <math.h>

static const double step_m = 1e-5; // and radians

// The bucket after its sensor's origin went by (X, Z) and it turned about that.
static struct dig_rig_front yielded(const struct dig_machine *const  machine,
                                    const struct dig_rig_pose *const pose, const double X_m,
                                    const double Z_m, const double turn_rad)
{
    const struct dig_vec2 place  = machine->sensor.place_m;
    struct dig_rig_pose   to     = { pose->X_m, pose->Z_m, pose->phi_rad + turn_rad };
    const struct dig_vec2 before = dig_rig_on_bucket(pose, place);
    const struct dig_vec2 after  = dig_rig_on_bucket(&to, place);
    to.X_m += before.x - after.x + X_m;
    to.Z_m += before.y - after.y + Z_m;
    return dig_rig_front_carried(machine, &to);
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
        const double               X    = step_m * direction[i][0];
        const double               Z    = step_m * direction[i][1];
        const double               turn = step_m * direction[i][2];
        const struct dig_rig_front to   = yielded(machine, pose, X, Z, turn);
        const struct dig_rig_front from = yielded(machine, pose, -X, -Z, -turn);
        load[i] = dig_rig_work_J(machine, motion, soil, &from, &to) / (2.0 * step_m);
    }
    return (struct dig_rig_load){ load[0], load[1], load[2] };
}
