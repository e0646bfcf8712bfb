// What a device's thread does with one pair of grains in one step.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H

#include "offline_dem/law/law_general.h"
#include "offline_dem/law/period.h"
#include "offline_dem/world/device.h"

/// The law of whichever sort; bodies that do not touch are not passed.
DIG_BOTH static inline struct dig_push dig_device_law(const struct dig_law *const   law,
                                                      const double                  dt_s,
                                                      const struct dig_touch *const touch,
                                                      struct dig_memory *const      memory)
{
    return law->general ? dig_law_general(*law, dt_s, *touch, memory)
                        : dig_law_step(*law, dt_s, *touch, memory);
}

DIG_BOTH static inline bool dig_device_touches(const struct dig_law *const   law,
                                               const struct dig_touch *const t)
{
    return dig_law_line(t->dx_m, t->dy_m, t->dz_m).d_m < law->reach_m;
}

DIG_BOTH static inline void dig_device_pair(const struct dig_device_view *const view,
                                            const struct dig_device_step *const step,
                                            const uint32_t                      pair)
{
    const uint32_t                 i = view->row[pair];
    const uint32_t                 j = view->other[pair];
    const struct dig_motion *const a = &view->motion[i];
    const struct dig_motion *const b = &view->motion[j];
    const struct dig_law *const    law =
        &view->pair_law[(size_t)view->of[i] * DIG_GRAIN_TYPES_MAX + view->of[j]];
    struct dig_touch touch = { .dx_m = a->x_m[0] - b->x_m[0],
                               .dy_m = a->x_m[1] - b->x_m[1],
                               .dz_m = a->x_m[2] - b->x_m[2] };
    if (step->period_y_m > 0.0) {
        touch.dy_m = dig_period_fold(touch.dy_m, step->period_y_m, step->per_m);
    }
    const uint32_t on_i = view->push_of[pair][0];
    const uint32_t on_j = view->push_of[pair][1];
    if (!dig_device_touches(law, &touch)) {
        if (view->touching[on_i] != 0) {
            view->touching[on_i]         = 0;
            view->touching[on_j]         = 0;
            const struct dig_memory none = { 0 };
            view->memory[pair]           = none;
        }
        return;
    }
    touch.vx_mps               = a->v_mps[0] - b->v_mps[0];
    touch.vy_mps               = a->v_mps[1] - b->v_mps[1];
    touch.vz_mps               = a->v_mps[2] - b->v_mps[2];
    touch.ix_radps             = a->w_radps[0];
    touch.iy_radps             = a->w_radps[1];
    touch.iz_radps             = a->w_radps[2];
    touch.jx_radps             = b->w_radps[0];
    touch.jy_radps             = b->w_radps[1];
    touch.jz_radps             = b->w_radps[2];
    const struct dig_push push = dig_device_law(law, step->dt_s, &touch, &view->memory[pair]);
    const struct dig_load to_i = { { push.fx_N, push.fy_N, push.fz_N, 0.0 },
                                   { push.ix_Nm, push.iy_Nm, push.iz_Nm, 0.0 } };
    const struct dig_load to_j = { { -push.fx_N, -push.fy_N, -push.fz_N, 0.0 },
                                   { push.jx_Nm, push.jy_Nm, push.jz_Nm, 0.0 } };
    view->touching[on_i]       = 1;
    view->touching[on_j]       = 1;
    view->push[on_i]           = to_i;
    view->push[on_j]           = to_j;
}

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_PAIR_H
