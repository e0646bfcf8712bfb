// The scene of a table, read from the canonical text whose hash the table holds.

#ifndef DIG_TABLES_SCENE_H
#define DIG_TABLES_SCENE_H

#include "core/error.h"
#include "core/scene.h"

/// What core/similar.h compares: name, bucket, box, grains, normal law, gravity, sides and ground
/// of the bed, trajectories; and the sizes, pairs of materials and the time step. The rest of
/// *scene is zero. Opens and checks the file as dig_table_load() does, and refuses what that does;
/// DIG_EINVAL also for a scene that could not have been computed.
DIG_MUST_CHECK enum dig_status dig_table_scene(const char *path, struct dig_scene *scene,
                                               struct dig_error *error);

#endif // DIG_TABLES_SCENE_H
