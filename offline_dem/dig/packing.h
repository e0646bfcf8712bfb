// Packing of a bed before it falls: random sequential insertion, the largest first.

#ifndef DIG_OFFLINE_DEM_DIG_PACKING_H
#define DIG_OFFLINE_DEM_DIG_PACKING_H

#include "core/bed.h"
#include "core/error.h"
#include "core/scene.h"
#include "core/status.h"

#include <stdint.h>

/// Spheres or randomly oriented clumps at random positions without overlap, inside the box's walls
/// and clear of obstacles, in a column at the scene's solid fraction. A column that is full
/// earlier, as narrow ones are, grows by a tenth at a time, up to twice its height.
/// DIG_EUNREACHABLE when they still do not fit, DIG_EINVAL for a clump without volume and for a box
/// of more than 2^31 grains or cells as wide as the largest, DIG_ENOMEM; *bed is written on success
/// only. error may be NULL.
DIG_MUST_CHECK enum dig_status dig_packing_insert(const struct dig_scene *scene, uint64_t seed,
                                                  struct dig_bed *bed, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_PACKING_H
