// Parts that pouring and digging share: from a scene and a gravel to a world.

#ifndef DIG_OFFLINE_DEM_DIG_SETUP_H
#define DIG_OFFLINE_DEM_DIG_SETUP_H

#include "core/bed.h"
#include "core/error.h"
#include "core/scene.h"
#include "offline_dem/dig/dig.h"
#include "offline_dem/world/grain_types.h"
#include "offline_dem/world/world.h"

/// Refuses a scene or a gravel that cannot be computed; *error names the key.
DIG_MUST_CHECK enum dig_status dig_setup_check(const struct dig_scene  *scene,
                                               const struct dig_gravel *gravel,
                                               struct dig_error        *error);

/// A world of this bed between the scene's walls, without a tool, falling at fall_mps, its rocks
/// moved by its ODE scene. *types are its grain types, NULL: not wanted. DIG_EINVAL for an
/// impossible bed (*error says which grain), DIG_ENOMEM; then *world is untouched.
DIG_MUST_CHECK enum dig_status dig_setup_world(const struct dig_scene  *scene,
                                               const struct dig_gravel *gravel,
                                               const struct dig_bed *bed, double fall_mps,
                                               struct dig_grain_types *types,
                                               struct dig_world *world, struct dig_error *error);

/// Who steps a world that has not made a step. On failure the kernel does.
DIG_MUST_CHECK enum dig_status dig_setup_stepper(const struct dig_stepper *stepper,
                                                 struct dig_world *world, struct dig_error *error);

/// Frees the world, its bodies, its crew and its ODE scene. A zeroed world is allowed.
void dig_setup_finish(struct dig_world *world);

/// Message for a failure of packing or stepping; returns status.
enum dig_status dig_setup_explain(enum dig_status status, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_SETUP_H
