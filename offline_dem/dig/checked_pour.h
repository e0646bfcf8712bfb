// Pouring with a check of the time step for energy drift. It only refuses: a bed that passes is bit
// for bit that of dig_bed_pour(). A bed from a file gets the same check.
//
// An explicit step too long for the contacts' damping keeps grains moving, and the bed is too soft:
// at 1.6 times the derived step the resistance of a dig is a fifth lower.

#ifndef DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H
#define DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H

#include "offline_dem/dig/dig.h"
#include "offline_dem/world/world.h"

/// Steps a world whose grains should be at rest. *drifts: over the last third of the steps the mean
/// kinetic energy of a grain exceeds a thousandth of m g r; the first two thirds let the bed
/// settle. In a bed of 7.5 mm grains at 5 MPa the energy is 2e-4 m g r at 62.5 us and 8e-3 at 80 us
/// (docs/numerics/dem.md). A world without gravity never drifts. DIG_ENOMEM, DIG_EINVAL as
/// dig_world_step(); *drifts is written on success only.
DIG_MUST_CHECK enum dig_status dig_energy_drift_detect(struct dig_world *world, size_t steps,
                                                       bool *drifts);

/// dig_bed_pour(); then, where the scene's step is longer than dig_contact_step_s() and it does
/// not say may_tremble, 0.1 s of a copy of the bed under dig_energy_drift_detect(): some per cent
/// of the cost of pouring. DIG_EINVAL when the energy drifts; *error names the key, the step and
/// the longest safe one. *bed is written on success only.
DIG_MUST_CHECK enum dig_status dig_bed_pour_checked(const struct dig_stepper *stepper,
                                                    const struct dig_scene   *scene,
                                                    const struct dig_gravel *gravel, uint64_t seed,
                                                    const struct dig_progress *progress,
                                                    struct dig_bed *bed, struct dig_error *error);

/// Refuses a bed from a file as a dig and the pouring above would: DIG_EINVAL for grains that
/// overlap or are behind a wall (offline_dem/dig/input_checks.h) and for a step whose energy drifts
/// within 0.3 s, DIG_ENOMEM. These 0.3 s are simulated only where the step is longer than the
/// derived one.
DIG_MUST_CHECK enum dig_status dig_bed_check(const struct dig_scene  *scene,
                                             const struct dig_gravel *gravel,
                                             const struct dig_bed *bed, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H
