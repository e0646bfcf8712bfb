// The ground before it is dug: level at box.z_max_m, or the bed's own profile along x.

#ifndef DIG_CORE_GROUND_H
#define DIG_CORE_GROUND_H

#include "core/scene.h"

/// Height of the ground at x: straight between the profile's points, level beyond the first and the
/// last, m.
double dig_scene_ground_m(const struct dig_scene *scene, double x_m);

/// Its highest point inside the box.
double dig_scene_ground_max_m(const struct dig_scene *scene);

#endif // DIG_CORE_GROUND_H
