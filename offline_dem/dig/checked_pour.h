// Pouring, and a look at whether the time step lets what was poured lie still. It only refuses:
// what it lets pass is bit for bit what dig_bed_pour() gives. A bed that was poured elsewhere gets
// the same look.

#ifndef DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H
#define DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H

#include "offline_dem/dig/dig.h"

/// dig_bed_pour(), and, where the scene asks for a longer step than dig_time_step_limit_s() derives
/// for its grains and does not say may_tremble, 0.1 s of a copy of the bed under
/// dig_energy_drift_detect(): some per cent of what the pouring costs. DIG_EINVAL when it heats;
/// *error names the key, the step and the longest one that is sure not to. Then *bed is not
/// written.
DIG_MUST_CHECK enum dig_status dig_bed_pour_checked(struct dig_device       *device,
                                                    const struct dig_scene  *scene,
                                                    const struct dig_gravel *gravel, uint64_t seed,
                                                    const struct dig_progress *progress,
                                                    struct dig_bed *bed, struct dig_error *error);

/// Refuses a bed that was not poured here as a dig and as the pouring above would: DIG_EINVAL for
/// grains that overlap or are behind a wall (offline_dem/dig/input_checks.h) and for a step that
/// heats it within 0.3 s, DIG_ENOMEM. Costs a moment, or those 0.3 s where the step is longer than
/// the derived one.
DIG_MUST_CHECK enum dig_status dig_bed_check(const struct dig_scene  *scene,
                                             const struct dig_gravel *gravel,
                                             const struct dig_bed *bed, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_CHECKED_POUR_H
