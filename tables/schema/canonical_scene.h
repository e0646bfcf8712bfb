// A scene out of its canonical text (core/scene.h). Internal to tables/.

#ifndef DIG_TABLES_SCHEMA_CANONICAL_SCENE_H
#define DIG_TABLES_SCHEMA_CANONICAL_SCENE_H

#include "core/scene.h"

/// What tables/scene.h promises, but for name and trajectories, which are left alone. A number that
/// is not there becomes NaN.
void dig_scene_from_canonical(const char *canonical, struct dig_scene *scene);

#endif // DIG_TABLES_SCHEMA_CANONICAL_SCENE_H
