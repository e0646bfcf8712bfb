// Levelling of a settled bed: pressed, cut, raked.

#ifndef DIG_OFFLINE_DEM_DIG_LEVEL_H
#define DIG_OFFLINE_DEM_DIG_LEVEL_H

#include "core/scene.h"
#include "offline_dem/world/world.h"

/// Removes every grain, and every whole clump, above the ground.
DIG_MUST_CHECK enum dig_status dig_level_cut(const struct dig_scene *scene,
                                             struct dig_world       *world);

/// Deposits every grain and clump above the ground, at rest, where the bed lies lowest under it.
/// They still fall a little.
DIG_MUST_CHECK enum dig_status dig_level_rake(const struct dig_scene *scene,
                                              struct dig_world       *world);

/// Lowers a level plate onto the bed until the grains bear the scene's preload_Pa on the box's
/// area, and removes it. DIG_EINVAL, with the key in *error, when that flattens the grains; else as
/// dig_world_step().
DIG_MUST_CHECK enum dig_status dig_level_press(const struct dig_scene *scene,
                                               struct dig_world *world, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_LEVEL_H
