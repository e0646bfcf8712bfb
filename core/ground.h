// The ground before it is dug: level at box.z_max_m, the bed's own profile along x, or several of
// them across the bed.

#ifndef DIG_CORE_GROUND_H
#define DIG_CORE_GROUND_H

#include "core/scene.h"

/// Height of the ground at a place: straight between a profile's points, level beyond the first and
/// the last, and the same from profile to profile across y, m.
double dig_scene_ground_m(const struct dig_scene *scene, double x_m, double y_m);

/// No place inside the box is higher; a profile that stands beside the box may be.
double dig_scene_ground_max_m(const struct dig_scene *scene);

#endif // DIG_CORE_GROUND_H
