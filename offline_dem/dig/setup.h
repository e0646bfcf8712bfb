// From a scene and a gravel to a world that can be stepped: what pouring and digging share.

#ifndef DIG_OFFLINE_DEM_DIG_SETUP_H
#define DIG_OFFLINE_DEM_DIG_SETUP_H

#include "core/error.h"
#include "core/scene.h"
#include "offline_dem/kernel/bed.h"
#include "offline_dem/world/grain_types.h"
#include "offline_dem/world/ode_scene.h"
#include "offline_dem/world/world.h"

/// Refuses a scene or a gravel that cannot be computed; *error names the key.
DIG_MUST_CHECK enum dig_status dig_setup_check(const struct dig_scene  *scene,
                                               const struct dig_gravel *gravel,
                                               struct dig_error        *error);

/// A world of this bed with the walls of the ODE scene, without a tool, all of it falling at
/// fall_mps. *kinds says what its grains are made of. DIG_EINVAL for a bed that cannot be (*error
/// says which grain), DIG_ENOMEM; then *world is untouched. The ODE scene moves the rocks and must
/// outlive the world.
DIG_MUST_CHECK enum dig_status dig_setup_world(const struct dig_scene  *scene,
                                               const struct dig_gravel *gravel,
                                               struct dig_ode_scene *ode, const struct dig_bed *bed,
                                               double fall_mps, struct dig_grain_types *types,
                                               struct dig_world *world, struct dig_error *error);

/// The world and its bodies.
void dig_setup_finish(struct dig_world *world);

/// Words for a failure of packing or stepping; returns status.
enum dig_status dig_setup_explain(enum dig_status status, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_SETUP_H
