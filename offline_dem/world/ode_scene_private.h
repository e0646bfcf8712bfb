// The engine's world and its geometries, shared by ode_scene.c and ode_rocks.c.

#ifndef DIG_OFFLINE_DEM_WORLD_ODE_SCENE_PRIVATE_H
#define DIG_OFFLINE_DEM_WORLD_ODE_SCENE_PRIVATE_H

#include "core/scene.h"

#include <ode/ode.h>

#define DIG_ODE_WALLS 5

// Triangles of the profile's plates (two each) and of both sides (a fan each).
#define DIG_ODE_VERTICES_MAX  (2 * DIG_PROFILE_MAX)
#define DIG_ODE_TRIANGLES_MAX (2 * DIG_PROFILE_MAX + 2 * DIG_PROFILE_MAX)

struct dig_ode_scene {
    dWorldID       world;
    dSpaceID       walls; // planes have no bounds: apart, so that nothing else pays for them
    dGeomID        wall[DIG_ODE_WALLS];
    size_t         planes; // of them
    dBodyID        bucket;
    dGeomID        shell;
    dTriMeshDataID mesh;
    // ODE keeps pointers to these.
    double       vertex[DIG_ODE_VERTICES_MAX][3];
    dTriIndex    triangle[DIG_ODE_TRIANGLES_MAX][3];
    unsigned int vertices, triangles;
    // Rocks: those that are fixed have a geometry and no body.
    dSpaceID      rocks;
    dJointGroupID contact_joints; // contacts of the step under way
    size_t        count;
    dGeomID       rock[DIG_OBSTACLES_MAX];
    dBodyID       body[DIG_OBSTACLES_MAX];
};

#endif // DIG_OFFLINE_DEM_WORLD_ODE_SCENE_PRIVATE_H
