#include "offline_dem/world/ode_scene.h"

#include "offline_dem/world/ode_scene_private.h"

#include <math.h>
#include <stdlib.h>

static void add_triangle(struct dig_ode_scene *const ode, const size_t a, const size_t b,
                         const size_t c)
{
    dTriIndex *const t = ode->triangle[ode->triangles++];
    t[0]               = (dTriIndex)a;
    t[1]               = (dTriIndex)b;
    t[2]               = (dTriIndex)c;
}

// Vertex k of the right side is 2 k, of the left side 2 k + 1.
static void make_triangles(struct dig_ode_scene *const ode, const struct dig_bucket *const bucket)
{
    for (size_t k = 0; k < bucket->points; k++) {
        for (size_t side = 0; side < 2; side++) {
            double *const v = ode->vertex[2 * k + side];
            v[0]            = bucket->x_m[k];
            v[1]            = side == 0 ? -0.5 * bucket->width_m : 0.5 * bucket->width_m;
            v[2]            = bucket->z_m[k];
        }
    }
    ode->vertices = (unsigned int)(2 * bucket->points);
    for (size_t k = 0; k + 1 < bucket->points; k++) {
        add_triangle(ode, 2 * k, 2 * k + 2, 2 * k + 1);
        add_triangle(ode, 2 * k + 1, 2 * k + 2, 2 * k + 3);
    }
    for (size_t k = 1; k + 1 < bucket->points; k++) {
        add_triangle(ode, 0, 2 * k, 2 * k + 2);
        add_triangle(ode, 1, 2 * k + 3, 2 * k + 1);
    }
}

static void add_wall(struct dig_ode_scene *const ode, const double x, const double y,
                     const double z, const double offset_m)
{
    ode->wall[ode->planes++] = dCreatePlane(ode->walls, x, y, z, offset_m);
}

static void make_walls(struct dig_ode_scene *const ode, const struct dig_scene *const scene)
{
    const struct dig_box *const box = &scene->box;
    ode->walls                      = dSimpleSpaceCreate(NULL);
    add_wall(ode, 1.0, 0.0, 0.0, box->x_min_m);
    add_wall(ode, -1.0, 0.0, 0.0, -box->x_max_m);
    if (!scene->bed.periodic_y) {
        add_wall(ode, 0.0, 1.0, 0.0, box->y_min_m);
        add_wall(ode, 0.0, -1.0, 0.0, -box->y_max_m);
    }
    add_wall(ode, 0.0, 0.0, 1.0, box->z_min_m);
}

struct dig_ode_scene *dig_ode_scene_create(const struct dig_scene *const scene)
{
    struct dig_ode_scene *const ode = calloc(1, sizeof *ode);
    if (ode == NULL || !dInitODE2(0)) {
        free(ode);
        return NULL;
    }
    ode->world = dWorldCreate();
    dWorldSetGravity(ode->world, 0.0, 0.0, -scene->gravity_mps2);
    make_walls(ode, scene);

    make_triangles(ode, &scene->bucket);
    ode->mesh = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(ode->mesh, ode->vertex, sizeof ode->vertex[0], (int)ode->vertices,
                                ode->triangle, (int)(3 * ode->triangles), sizeof ode->triangle[0]);
    ode->shell  = dCreateTriMesh(NULL, ode->mesh, NULL, NULL, NULL);
    ode->bucket = dBodyCreate(ode->world);
    dBodySetKinematic(ode->bucket);
    dGeomSetBody(ode->shell, ode->bucket);
    ode->rocks          = dSimpleSpaceCreate(NULL);
    ode->contact_joints = dJointGroupCreate(0);
    return ode;
}

void dig_ode_scene_destroy(struct dig_ode_scene *const ode)
{
    if (ode == NULL) {
        return;
    }
    dGeomDestroy(ode->shell);
    dGeomTriMeshDataDestroy(ode->mesh);
    dSpaceDestroy(ode->walls);
    dJointGroupDestroy(ode->contact_joints);
    dSpaceDestroy(ode->rocks);
    dWorldDestroy(ode->world);
    dCloseODE();
    free(ode);
}

// The bucket curls about -y: its x turns towards z.
void dig_ode_scene_move(struct dig_ode_scene *const ode, const struct dig_pose pose,
                        const double vx_mps, const double vz_mps, const double w_radps)
{
    dQuaternion q;
    dQFromAxisAndAngle(q, 0.0, -1.0, 0.0, pose.theta_rad);
    dBodySetPosition(ode->bucket, pose.x_m, 0.0, pose.z_m);
    dBodySetQuaternion(ode->bucket, q);
    dBodySetLinearVel(ode->bucket, vx_mps, 0.0, vz_mps);
    dBodySetAngularVel(ode->bucket, 0.0, -w_radps, 0.0);
}

void dig_ode_scene_read(const struct dig_ode_scene *const ode, struct dig_tool *const tool)
{
    const dReal *const    x    = dBodyGetPosition(ode->bucket);
    const dReal *const    r    = dBodyGetRotation(ode->bucket);
    const dReal *const    v    = dBodyGetLinearVel(ode->bucket);
    const dReal *const    w    = dBodyGetAngularVel(ode->bucket);
    const struct dig_pose pose = { .x_m = x[0], .z_m = x[2], .theta_rad = atan2(r[8], r[0]) };
    dig_tool_place(tool, pose, v[0], v[2], -w[1]);
}

size_t dig_ode_scene_walls(const struct dig_ode_scene *const ode, struct dig_wall wall[])
{
    for (size_t k = 0; k < ode->planes; k++) {
        dVector4 plane;
        dGeomPlaneGetParams(ode->wall[k], plane);
        wall[k] = (struct dig_wall){ { plane[0], plane[1], plane[2] }, plane[3] };
    }
    return ode->planes;
}
