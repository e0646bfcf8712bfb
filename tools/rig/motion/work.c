#include "tools/rig/motion/work.h"

#include <assert.h>
#include <math.h>

static const double step_rad   = 1e-5;
static const double no_lever_m = 1e-3;

double dig_rig_work_J(const struct dig_machine *const    machine,
                      const struct dig_rig_motion *const motion,
                      const struct dig_rig_wrench *const soil,
                      const struct dig_rig_front *const from, const struct dig_rig_front *const to)
{
    double work_J = 0.0;
    for (int k = 0; k < DIG_JOINTS; k++) {
        const struct dig_vec2 moved      = dig_vec2_sub(to->com_m[k], from->com_m[k]);
        const double          turned_rad = to->attitude_rad[k] - from->attitude_rad[k];
        const double          mass_kg    = machine->link[k].mass_kg;
        work_J += -mass_kg * motion->com_mps2[k].x * moved.x;
        work_J += -mass_kg * (DIG_RIG_GRAVITY_mps2 + motion->com_mps2[k].y) * moved.y;
        work_J += -machine->link[k].inertia_kgm2 * motion->turn_radps2[k] * turned_rad;
    }
    return work_J + soil->FX_N * (to->bucket.X_m - from->bucket.X_m) +
           soil->FZ_N * (to->bucket.Z_m - from->bucket.Z_m) +
           soil->M_Nm * (to->bucket.phi_rad - from->bucket.phi_rad);
}

// Work of everything but the cylinders when joint j turns from -step to +step, per radian.
static double turning_work_Nm(const struct dig_machine *const    machine,
                              const struct dig_rig_joints *const joints,
                              const struct dig_rig_motion *const motion,
                              const struct dig_rig_wrench *const soil, const int j)
{
    struct dig_rig_joints ahead  = *joints;
    struct dig_rig_joints behind = *joints;
    ahead.rad[j] += step_rad;
    behind.rad[j] -= step_rad;
    const struct dig_rig_front to   = dig_rig_front_at(machine, &ahead);
    const struct dig_rig_front from = dig_rig_front_at(machine, &behind);
    return dig_rig_work_J(machine, motion, soil, &from, &to) / (2.0 * step_rad);
}

enum dig_status dig_rig_work_solve(const struct dig_machine *const    machine,
                                   const struct dig_rig_joints *const joints,
                                   const struct dig_rig_motion *const motion,
                                   const struct dig_rig_wrench *const soil,
                                   struct dig_rig_pushes *const       pushes)
{
    struct dig_rig_pushes result;
    for (int j = 0; j < DIG_JOINTS; j++) {
        double                lever_m;
        const enum dig_status status =
            dig_rig_lever_m(machine, (enum dig_joint)j, joints->rad[j], &lever_m);
        if (status != DIG_OK) {
            return status;
        }
        if (!(fabs(lever_m) > no_lever_m)) {
            return DIG_EUNREACHABLE;
        }
        result.N[j] = -turning_work_Nm(machine, joints, motion, soil, j) / lever_m;
    }
    *pushes = result;
    return DIG_OK;
}

void dig_rig_work_pressures(const struct dig_machine *const    machine,
                            const struct dig_rig_pushes *const pushes,
                            struct dig_rig_pressures *const    pressures)
{
    struct dig_rig_pressures result;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const cylinder = &machine->cylinder[j];
        const double                     head_m2  = dig_cylinder_head_m2(cylinder);
        const double                     rod_m2   = dig_cylinder_rod_m2(cylinder);
        const double                     each_N   = pushes->N[j] / cylinder->count;
        const double                     back_Pa  = cylinder->back_Pa;
        result.head_Pa[j]                         = back_Pa;
        result.rod_Pa[j]                          = back_Pa;
        if (each_N >= back_Pa * (head_m2 - rod_m2)) {
            result.head_Pa[j] = (each_N + back_Pa * rod_m2) / head_m2;
        } else {
            result.rod_Pa[j] = (back_Pa * head_m2 - each_N) / rod_m2;
        }
    }
    *pressures = result;
}
