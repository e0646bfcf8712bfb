// One pair of grains in one step of a device.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H

#include "offline_dem/law/law_general.h"
#include "offline_dem/law/period.h"
#include "offline_dem/world/device.h"

DIG_BOTH static inline bool dig_device_touches(const struct dig_law *const        law,
                                               const struct dig_kinematics *const t)
{
    return dig_law_normal(law->reach_m, t->dx_m, t->dy_m, t->dz_m).delta_m > 0.0;
}

DIG_BOTH static inline void dig_device_step_pair(const struct dig_device_view *const view,
                                                 const struct dig_device_step *const step,
                                                 const uint32_t                      pair)
{
    const uint32_t                 i = view->pair_i[pair];
    const uint32_t                 j = view->pair_j[pair];
    const struct dig_motion *const a = &view->motion[i];
    const struct dig_motion *const b = &view->motion[j];
    const struct dig_law *const    law =
        &view->pair_law[(size_t)view->type_of[i] * DIG_GRAIN_TYPES_MAX + view->type_of[j]];
    struct dig_kinematics kinematics = { .dx_m = a->x_m[0] - b->x_m[0],
                                         .dy_m = a->x_m[1] - b->x_m[1],
                                         .dz_m = a->x_m[2] - b->x_m[2] };
    if (step->period_y_m > 0.0) {
        kinematics.dy_m = dig_period_fold(kinematics.dy_m, step->period_y_m, step->inverse_period);
    }
    const uint32_t on_i = view->load_index[pair][0];
    const uint32_t on_j = view->load_index[pair][1];
    if (!dig_device_touches(law, &kinematics)) {
        if (view->touching[on_i] != 0) {
            view->touching[on_i]                  = 0;
            view->touching[on_j]                  = 0;
            const struct dig_contact_history none = { 0 };
            view->pair_history[pair]              = none;
        }
        return;
    }
    const double near_m = kinematics.dy_m;
    kinematics          = dig_motion_between(a, b);
    kinematics.dy_m     = near_m;
    const struct dig_contact_force force =
        dig_law_apply(law, step->dt_s, &kinematics, &view->pair_history[pair]);
    const struct dig_load to_i = { { force.fx_N, force.fy_N, force.fz_N, 0.0 },
                                   { force.ix_Nm, force.iy_Nm, force.iz_Nm, 0.0 } };
    const struct dig_load to_j = { { -force.fx_N, -force.fy_N, -force.fz_N, 0.0 },
                                   { force.jx_Nm, force.jy_Nm, force.jz_Nm, 0.0 } };
    view->touching[on_i]       = 1;
    view->touching[on_j]       = 1;
    view->pair_load[on_i]      = to_i;
    view->pair_load[on_j]      = to_j;
}

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H
