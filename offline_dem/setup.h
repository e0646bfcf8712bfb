// From a scene and a gravel to a world that can be stepped: what pouring and digging share.

#ifndef DIG_OFFLINE_DEM_SETUP_H
#define DIG_OFFLINE_DEM_SETUP_H

#include "core/error.h"
#include "core/scene.h"
#include "offline_dem/grains.h"
#include "offline_dem/ode_scene.h"
#include "offline_dem/world.h"

/// Refuses a scene or a gravel that cannot be computed; *error names the key.
DIG_MUST_CHECK enum dig_status dig_setup_check(const struct dig_scene  *scene,
                                               const struct dig_gravel *gravel,
                                               struct dig_error        *error);

/// A world with the walls of the ODE scene, without a tool. Takes over *grains.
struct dig_world dig_setup_world(const struct dig_scene *scene, const struct dig_gravel *gravel,
                                 const struct dig_ode_scene *ode, struct dig_grains *grains);

/// Words for a failure of packing or stepping; returns status.
enum dig_status dig_setup_explain(enum dig_status status, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_SETUP_H
