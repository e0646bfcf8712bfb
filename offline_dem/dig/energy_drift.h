// Energy drift of a bed at rest. An explicit step too long for the contacts' damping keeps grains
// moving, and the bed is too soft: at 1.6 times the derived step the resistance of a dig is a fifth
// lower.

#ifndef DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H
#define DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H

#include "core/status.h"
#include "offline_dem/world/world.h"

#include <stdbool.h>
#include <stddef.h>

/// Steps a world whose grains should be at rest. *drifts: over the last third of the steps the mean
/// kinetic energy of a grain exceeds a thousandth of m g r; the first two thirds let the bed
/// settle. In a bed of 7.5 mm grains at 5 MPa the energy is 2e-4 m g r at 62.5 us and 8e-3 at 80 us
/// (docs/numerics/dem.md). A world without gravity never drifts. DIG_ENOMEM, DIG_EINVAL as
/// dig_world_step(); *drifts is written on success only.
DIG_MUST_CHECK enum dig_status dig_energy_drift_detect(struct dig_world *world, size_t steps,
                                                       bool *drifts);

#endif // DIG_OFFLINE_DEM_DIG_ENERGY_DRIFT_H
