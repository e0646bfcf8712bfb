// Checks before a dig begins, beyond those of the scene: an impossible bed, a bucket that starts in
// it, a trajectory that leaves the box.

#ifndef DIG_OFFLINE_DEM_DIG_INPUT_CHECKS_H
#define DIG_OFFLINE_DEM_DIG_INPUT_CHECKS_H

#include "core/error.h"
#include "core/scene.h"
#include "offline_dem/world/world.h"

/// DIG_EINVAL when a part of the bucket passes through the floor or a wall; *error names the
/// trajectory, the time and the axis. Above the box the bucket is free.
DIG_MUST_CHECK enum dig_status dig_input_checks_path(const struct dig_scene      *scene,
                                                     const struct dig_trajectory *trajectory,
                                                     struct dig_error            *error);

/// DIG_EINVAL when two grains of different bodies overlap by more than 0.3 of the smaller radius,
/// DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_input_checks_overlap(const struct dig_world *world,
                                                        struct dig_error       *error);

/// DIG_EINVAL when a grain is more than 0.3 of its radius behind a wall or the floor.
DIG_MUST_CHECK enum dig_status dig_input_checks_outside(const struct dig_world *world,
                                                        struct dig_error       *error);

/// DIG_EINVAL when a plate of the tool at its pose cuts a grain within half its radius, or a grain
/// lies in the bucket.
DIG_MUST_CHECK enum dig_status dig_input_checks_start(const struct dig_world *world,
                                                      const struct dig_tool  *tool,
                                                      struct dig_error       *error);

#endif // DIG_OFFLINE_DEM_DIG_INPUT_CHECKS_H
