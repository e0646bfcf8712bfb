// Packing of equal grains: random positions without overlap in a column over the box, at a given
// solid fraction.

#ifndef DIG_OFFLINE_DEM_DIG_PACKING_H
#define DIG_OFFLINE_DEM_DIG_PACKING_H

#include "core/scene.h"
#include "core/status.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_PACKING_ATTEMPTS 100000 // for one grain, before the column counts as full
#define DIG_PACKING_GROWTH   1.1    // factor by which a full column grows
#define DIG_PACKING_TALLEST  2.0    // times the height of the solid fraction

/// Number of grains of the scene's packing.
size_t dig_packing_grains(const struct dig_scene *scene);

/// Random sequential insertion of n grains inside the box's walls and the column of the scene's
/// solid fraction. A column that is full earlier, as narrow ones are, grows by a tenth at a time,
/// up to twice its height. x, y, z [n] are written on success only; DIG_EUNREACHABLE when the
/// grains still do not fit, DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_packing_insert(const struct dig_scene *scene, uint64_t seed,
                                                  size_t n, double x_m[], double y_m[],
                                                  double z_m[]);

#endif // DIG_OFFLINE_DEM_DIG_PACKING_H
