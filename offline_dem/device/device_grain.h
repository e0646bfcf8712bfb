// One grain or one clump in one step of a device: the sum of its loads, and its motion.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_GRAIN_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_GRAIN_H

#include "offline_dem/world/device.h"

#include <math.h>

DIG_BOTH static inline void dig_device_add_load(const struct dig_load *const from,
                                                struct dig_load *const       to)
{
    for (int k = 0; k < 3; k++) {
        to->f_N[k] += from->f_N[k];
        to->t_Nm[k] += from->t_Nm[k];
    }
}

/// Share of the margin; the rest is for grains that speed up meanwhile.
#define DIG_DEVICE_SOON 0.8

/// Kick and drift, and the margin flags.
DIG_BOTH static inline void dig_device_advance(const struct dig_device_view *const view,
                                               const struct dig_device_step *const step,
                                               const uint32_t i, const struct dig_load *const load)
{
    const struct dig_grain_type *const type         = &view->type[view->type_of[i]];
    struct dig_motion                  m            = view->motion[i];
    const double                       inverse_kg   = type->driven ? 0.0 : 1.0 / type->mass_kg;
    const double                       inverse_kgm2 = type->driven ? 0.0 : 1.0 / type->inertia_kgm2;
    const double                       falls        = type->driven ? 0.0 : 1.0;
    double                             moved_m2     = 0.0;
    double                             v2           = 0.0;
    for (int k = 0; k < 3; k++) {
        m.v_mps[k] += step->kick_s * (load->f_N[k] * inverse_kg + falls * step->gravity_mps2[k]);
        m.w_radps[k] += step->kick_s * (load->t_Nm[k] * inverse_kgm2);
        m.x_m[k] += step->dt_s * m.v_mps[k];
        const double d = m.x_m[k] - view->reference_m[i][k];
        moved_m2 += d * d;
        v2 += m.v_mps[k] * m.v_mps[k];
    }
    view->motion[i] = m;
    // Negated, so that a coordinate that is not a number counts as having left.
    const double margin_m = view->reference_m[i][3];
    const double soon_m   = DIG_DEVICE_SOON * margin_m - step->horizon_s * sqrt(v2);
    if (!(soon_m > 0.0 && moved_m2 < soon_m * soon_m)) {
        view->margin_flag[DIG_MARGIN_NEARLY_LEFT] = 1;
    }
    if (!(moved_m2 <= margin_m * margin_m)) {
        view->margin_flag[DIG_MARGIN_LEFT] = 1;
    }
}

DIG_BOTH static inline struct dig_load
dig_device_sum_loads(const struct dig_device_view *const view, const uint32_t i)
{
    struct dig_load load = { { 0 }, { 0 } };
    if (view->surface_mask[i] != 0) {
        load = view->surface_load[i];
    }
    for (uint32_t k = view->load_start[i]; k < view->load_start[i + 1]; k++) {
        if (view->touching[k] != 0) {
            dig_device_add_load(&view->pair_load[k], &load);
        }
    }
    return load;
}

/// Before its spheres, which are driven, are moved.
DIG_BOTH static inline void dig_device_step_clump(const struct dig_device_view *const view,
                                                  const struct dig_device_step *const step,
                                                  const uint32_t                      b)
{
    struct dig_load load[DIG_CLUMP_MAX];
    if (view->clump[b].gone) {
        return;
    }
    for (size_t k = 0; k < view->shape->spheres; k++) {
        load[k] = dig_device_sum_loads(view, view->clump[b].member[k]);
    }
    dig_clump_step(view->shape, load, step->gravity_mps2, step->kick_s, step->dt_s, &view->clump[b],
                   view->motion);
}

DIG_BOTH static inline void dig_device_step_grain(const struct dig_device_view *const view,
                                                  const struct dig_device_step *const step,
                                                  const uint32_t                      i)
{
    struct dig_load load = { { 0 }, { 0 } };
    if (!view->type[view->type_of[i]].driven) {
        load = dig_device_sum_loads(view, i);
    }
    dig_device_advance(view, step, i, &load);
}

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_GRAIN_H
