// Does the time step heat the bed? An explicit step longer than the contacts' damping bears makes
// grains that should lie still tremble for ever, without any sign but a bed that is too soft: at
// 1.6 times the derived step the resistance of a dig fell by a fifth.

#ifndef DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H
#define DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H

#include "core/status.h"
#include "offline_dem/world/world.h"

#include <stdbool.h>
#include <stddef.h>

/// Steps a world whose grains should lie still, and tells whether they are kept moving: over the
/// last third of the steps the mean kinetic energy of a grain is more than a thousandth of m g r.
/// The first two thirds are for what still comes to rest. In a bed of 7.5 mm grains at 5 MPa 62.5
/// us leave a hundredth of that, 80 us three times as much (docs/numerics/dem.md). A world without
/// gravity never heats. DIG_ENOMEM, DIG_EINVAL as dig_world_step(); *heats is written on success
/// only.
DIG_MUST_CHECK enum dig_status dig_energy_drift_detect(struct dig_world *world, size_t steps,
                                                       bool *drifts);

#endif // DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H
