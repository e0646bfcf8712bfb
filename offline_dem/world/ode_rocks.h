// Rocks as bodies of the Open Dynamics Engine: it moves those that are not fixed, under what the
// grains do to them, and keeps them off the walls, the bucket and each other by contact joints as
// stiff and as damped as the contact law. Their reaction on the bucket is added to the tool's
// wrench.

#ifndef DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H
#define DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H

#include "offline_dem/world/obstacles.h"
#include "offline_dem/world/ode_scene.h"

/// How a rock meets what does not give way.
struct dig_rock_contact_law {
    double normal_Npm, damping_Nspm, friction;
};

/// Puts the rocks into the scene where they are, in place of those it had.
void dig_ode_rocks_set(struct dig_ode_scene *ode, size_t rocks, const struct dig_rock rock[]);

/// One step of every rock that is movable, with the loads in rock[].f_N and .t_Nm; their bodies are
/// read back. tool NULL: no bucket. Velocities stand half a step behind positions, as the grains'.
void dig_ode_rocks_step(struct dig_ode_scene *ode, const struct dig_tool *tool,
                        const struct dig_rock_contact_law law[], double dt_s,
                        struct dig_rock rock[], struct dig_wrench *on_tool);

#endif // DIG_OFFLINE_DEM_WORLD_ODE_ROCKS_H
