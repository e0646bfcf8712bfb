// A clump of the bed and its step. Inlined into bodies.c and into the device's step
// (offline_dem/world/device.h).

#ifndef DIG_OFFLINE_DEM_KERNEL_CLUMP_BODY_H
#define DIG_OFFLINE_DEM_KERNEL_CLUMP_BODY_H

#include "offline_dem/kernel/grains.h"
#include "offline_dem/law/both.h"
#include "offline_dem/law/rigid.h"
#include "offline_dem/shapes/clump.h"

/// A clump of the bed and the indices of its spheres.
struct dig_clump_body {
    struct dig_rigid body;
    double           unit_m; // diameter of the sphere of equal volume
    uint32_t         member[DIG_CLUMP_MAX];
    bool             gone; // dropped with all its spheres
};

/// Lever arms from the centre of mass to the spheres.
DIG_BOTH static inline void dig_clump_arms(const struct dig_clump_shape *const shape,
                                           const struct dig_clump_body *const  clump,
                                           double                              arm_m[][3])
{
    for (size_t k = 0; k < shape->spheres; k++) {
        dig_rigid_rotate(clump->body.q, shape->at[k], arm_m[k]);
        for (int a = 0; a < 3; a++) {
            arm_m[k][a] *= clump->unit_m;
        }
    }
}

/// One step under the loads of its spheres, in their order. Sets their velocities so that a step of
/// dt_s moves them with the clump.
DIG_BOTH static inline void dig_clump_step(const struct dig_clump_shape *const shape,
                                           const struct dig_load               load[],
                                           const double gravity_mps2[3], const double kick_s,
                                           const double dt_s, struct dig_clump_body *const clump,
                                           struct dig_motion motion[])
{
    double before_m[DIG_CLUMP_MAX][3];
    double after_m[DIG_CLUMP_MAX][3];
    double force_N[3]   = { 0.0, 0.0, 0.0 };
    double torque_Nm[3] = { 0.0, 0.0, 0.0 };
    dig_clump_arms(shape, clump, before_m);
    for (size_t k = 0; k < shape->spheres; k++) {
        const double *const f   = load[k].f_N;
        const double *const arm = before_m[k];
        for (int a = 0; a < 3; a++) {
            force_N[a] += f[a];
            torque_Nm[a] += load[k].t_Nm[a] + arm[(a + 1) % 3] * f[(a + 2) % 3] -
                            arm[(a + 2) % 3] * f[(a + 1) % 3];
        }
    }
    dig_rigid_step(&clump->body, force_N, torque_Nm, gravity_mps2, kick_s, dt_s);
    dig_clump_arms(shape, clump, after_m);
    for (size_t k = 0; k < shape->spheres; k++) {
        struct dig_motion *const m = &motion[clump->member[k]];
        for (int a = 0; a < 3; a++) {
            m->v_mps[a]   = clump->body.v_mps[a] + (after_m[k][a] - before_m[k][a]) / dt_s;
            m->w_radps[a] = clump->body.w_radps[a];
        }
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_CLUMP_BODY_H
