// The scene in the Open Dynamics Engine: the bucket as a kinematic body with the triangles of its
// profile, the walls as planes in a space of their own. Grains do not touch ODE's geometry: why
// stands in docs/adr/0002-tool-narrow-phase.md.

#ifndef DIG_OFFLINE_DEM_WORLD_ODE_SCENE_H
#define DIG_OFFLINE_DEM_WORLD_ODE_SCENE_H

#include "core/scene.h"
#include "core/status.h"
#include "offline_dem/law/wall.h"
#include "offline_dem/shapes/tool.h"

#include <stddef.h>

struct dig_ode_scene; // one ODE world; not to be shared between threads

/// NULL when memory is short. The bucket stands at pin (0, 0, 0), theta 0, at rest.
struct dig_ode_scene *dig_ode_scene_create(const struct dig_scene *scene);

/// NULL is allowed.
void dig_ode_scene_destroy(struct dig_ode_scene *ode);

/// Sets pose and velocity of the bucket's body.
void dig_ode_scene_move(struct dig_ode_scene *ode, struct dig_pose pose, double vx_mps,
                        double vz_mps, double w_radps);

/// Reads the bucket's body: pose and velocity of the tool.
void dig_ode_scene_read(const struct dig_ode_scene *ode, struct dig_tool *tool);

/// Reads the planes into wall[DIG_WALLS_MAX]; returns how many.
size_t dig_ode_scene_walls(const struct dig_ode_scene *ode, struct dig_wall wall[]);

#endif // DIG_OFFLINE_DEM_WORLD_ODE_SCENE_H
