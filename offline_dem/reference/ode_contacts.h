// Callbacks of ODE's collision detection: the contact law, as forces on bodies. Shared by
// ode_bed.c, which makes the bodies and calls ODE, and ode_contacts.c.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_CONTACTS_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_CONTACTS_H

#include "offline_dem/reference/ode_history.h"
#include "offline_dem/world/ode_rocks.h"
#include "offline_dem/world/world.h"

#include <ode/ode.h>

struct dig_ode_bed {
    dWorldID world;
    dSpaceID grains_space, walls_space, rocks_space;
    dGeomID  tool_box;
    size_t   n;
    dBodyID *body;       // [n]
    dGeomID *grain_geom; // [n]
    uint8_t *type_of;    // [n]

    // Copied from the world this was made from.
    double                dt_s, gravity_mps2[3];
    struct dig_grain_type type[DIG_GRAIN_TYPES_MAX];
    struct dig_law        pair_law[DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX],
        wall_law[DIG_GRAIN_TYPES_MAX], tool_law[DIG_GRAIN_TYPES_MAX];

    // Copies of the rocks, which this bed moves.
    size_t                      rocks;
    struct dig_rock             rock[DIG_OBSTACLES_MAX];
    dGeomID                     rock_geom[DIG_OBSTACLES_MAX];
    struct dig_rock_contact_law rock_law[DIG_OBSTACLES_MAX];
    struct dig_ode_scene       *scene; // moves them; NULL: all are fixed

    struct dig_ode_history history;
    bool                   started;

    // Of the step under way.
    const struct dig_tool *tool;
    struct dig_wrench      on_tool;
    double                 kick_fraction; // of a kick
    bool                   out_of_memory;
};

/// Callbacks of dSpaceCollide(); data is the bed. Two grains, a grain and a wall, a grain and a
/// rock, a grain and the box about the tool. They add loads to the bodies and keep contact
/// histories.
void dig_ode_contacts_grain(void *data, dGeomID a, dGeomID b);
void dig_ode_contacts_wall(void *data, dGeomID a, dGeomID b);
void dig_ode_contacts_rock(void *data, dGeomID a, dGeomID b);
void dig_ode_contacts_tool(void *data, dGeomID a, dGeomID b);

/// Motion of a body as a grain has it.
struct dig_motion dig_ode_contacts_motion(dBodyID body);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_CONTACTS_H
