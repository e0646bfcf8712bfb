// Pouring with a check of the time step for energy drift. It only refuses: a bed that passes is bit
// for bit that of dig_bed_pour(). A bed from a file gets the same check.

#ifndef DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H
#define DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H

#include "offline_dem/dig/dig.h"

/// dig_bed_pour(); then, where the scene's step is longer than dig_contact_step_s() and it does
/// not say may_tremble, 0.1 s of a copy of the bed under dig_energy_drift_detect(): some per cent
/// of the cost of pouring. DIG_EINVAL when the energy drifts; *error names the key, the step and
/// the longest safe one. *bed is written on success only.
DIG_MUST_CHECK enum dig_status dig_bed_pour_checked(struct dig_device       *device,
                                                    const struct dig_scene  *scene,
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
