// Rocks as bodies of the Open Dynamics Engine. It moves those that are not fixed under the loads of
// the grains, and keeps them off the walls, the bucket and each other by contact joints as stiff
// and as damped as the contact law. Their reaction on the bucket is added to the tool's wrench.

#ifndef DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H
#define DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H

#include "offline_dem/world/obstacles.h"
#include "offline_dem/world/ode_scene.h"

#include <ode/ode.h>

/// A rock's geometry in a space, at no pose yet.
dGeomID dig_ode_rocks_shape(dSpaceID space, const struct dig_rock_surface *rock);

/// Replaces the scene's rocks by these, at their poses.
void dig_ode_rocks_set(struct dig_ode_scene *ode, size_t rocks, const struct dig_rock rock[]);

/// One step of every movable rock under the loads rock[].load, touching rigid surfaces by law[];
/// their bodies are read back.
/// tool NULL: no bucket. Velocities stand half a step behind positions, as the grains'.
void dig_ode_rocks_step(struct dig_ode_scene *ode, const struct dig_tool *tool,
                        const struct dig_law law[], double dt_s, struct dig_rock rock[],
                        struct dig_wrench *on_tool);

#endif // DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H
