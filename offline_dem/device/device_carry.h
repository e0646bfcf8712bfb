// One grain from a device's old lists to new ones: its motion, and its contacts that go on.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_CARRY_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_CARRY_H

#include "offline_dem/law/period.h"
#include "offline_dem/world/device.h"

/// Of a pair that is in no list.
#define DIG_DEVICE_NO_PAIR UINT32_MAX

DIG_BOTH static inline uint32_t dig_device_find_pair(const struct dig_device_view *const view,
                                                     const uint32_t i, const uint32_t j)
{
    for (uint32_t p = view->pair_start[i]; p < view->pair_start[i + 1]; p++) {
        if (view->pair_j[p] == j) {
            return p;
        }
    }
    return DIG_DEVICE_NO_PAIR;
}

/// A pair may have been listed by the other of its grains, which has the opposite history.
DIG_BOTH static inline void dig_device_carry_pair(const struct dig_device_view *const from,
                                                  const struct dig_device_move *const move,
                                                  const struct dig_device_view *const to,
                                                  const uint32_t                      pair)
{
    const uint32_t i    = move->was[to->pair_i[pair]];
    const uint32_t j    = move->was[to->pair_j[pair]];
    uint32_t       was  = dig_device_find_pair(from, i, j);
    double         sign = 1.0;
    if (was == DIG_DEVICE_NO_PAIR) {
        was  = dig_device_find_pair(from, j, i);
        sign = -1.0;
    }
    struct dig_contact_history history  = { 0 };
    uint8_t                    touching = 0;
    if (was != DIG_DEVICE_NO_PAIR && from->touching[from->load_index[was][0]] != 0) {
        history  = dig_contact_history_times(from->pair_history[was], sign);
        touching = 1;
    }
    to->pair_history[pair]                = history;
    to->touching[to->load_index[pair][0]] = touching;
    to->touching[to->load_index[pair][1]] = touching;
}

DIG_BOTH static inline void dig_device_carry_grain(const struct dig_device_view *const from,
                                                   const struct dig_device_move *const move,
                                                   const struct dig_device_view *const to,
                                                   const uint32_t                      i)
{
    const uint32_t                   was  = move->was[i];
    const struct dig_contact_history none = { 0 };
    struct dig_motion                m    = from->motion[was];
    if (move->period_y_m > 0.0) {
        m.x_m[1] = dig_period_fold(m.x_m[1], move->period_y_m, move->inverse_period);
    }
    to->motion[i]       = m;
    to->surface_mask[i] = from->surface_mask[was];
    for (uint32_t s = 0; s < to->surfaces; s++) {
        const bool touches = (to->surface_mask[i] >> s & 1) != 0;
        to->surface_history[(size_t)s * to->n + i] =
            touches ? from->surface_history[(size_t)s * from->n + was] : none;
    }
    for (uint32_t p = to->pair_start[i]; p < to->pair_start[i + 1]; p++) {
        to->pair_i[p] = i;
        dig_device_carry_pair(from, move, to, p);
    }
}

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_CARRY_H
