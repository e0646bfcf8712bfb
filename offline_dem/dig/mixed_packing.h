// Packing of beds of several sizes, of clumps, or around obstacles: random sequential insertion,
// the largest first.

#ifndef DIG_OFFLINE_DEM_DIG_MIXED_PACKING_H
#define DIG_OFFLINE_DEM_DIG_MIXED_PACKING_H

#include "core/scene.h"
#include "core/status.h"
#include "offline_dem/kernel/bed.h"
#include "offline_dem/shapes/clump.h"

#include <stdint.h>

/// Spheres or randomly oriented clumps at random positions without overlap, clear of obstacles, in
/// a column over the box at the scene's solid fraction: as dig_packing_insert() otherwise.
/// DIG_EUNREACHABLE when they do not fit, DIG_ENOMEM; *bed is written on success only.
DIG_MUST_CHECK enum dig_status dig_mixed_packing_insert(const struct dig_scene       *scene,
                                                        const struct dig_clump_shape *shape,
                                                        uint64_t seed, struct dig_bed *bed);

#endif // DIG_OFFLINE_DEM_DIG_MIXED_PACKING_H
