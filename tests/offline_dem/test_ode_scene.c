// Tests for offline_dem/world/ode_scene.c: ODE's walls and bucket, and its collision with the
// plates held against ours.

#include "core/chance.h"
#include "tests/dem_fixture.h"

#include "offline_dem/shapes/bucket_surface.h"
#include "offline_dem/world/ode_scene.h"
#include "offline_dem/world/ode_scene_private.h"
#include "tests/offline_dem/rig_bucket.h"

#include <math.h>

static const struct dig_scene ode_scene = {
    .bucket       = { .points  = 5,
                      .x_m     = { 0.0, -0.04, -0.052, -0.04, -0.012 },
                      .z_m     = { -0.09, -0.072, -0.042, -0.012, 0.0 },
                      .width_m = 0.07 },
    .box          = { 0.0, 0.31, -0.06, 0.06, 0.0, 0.085 },
    .gravity_mps2 = 9.81,
};

TEST(ode_holds_the_walls_and_the_bucket)
{
    struct dig_ode_scene *const ode = dig_ode_scene_create(&ode_scene);
    assert_non_null(ode);
    struct dig_wall wall[DIG_WALLS_MAX];
    assert_int_equal(dig_ode_scene_walls(ode, wall), 5);
    assert_close(wall[1].normal[0], -1.0, 0.0);
    assert_close(wall[1].offset_m, -0.31, 0.0);
    assert_close(wall[4].normal[2], 1.0, 0.0);

    struct dig_tool       tool = dig_tool_make(&rig_bucket);
    const struct dig_pose pose = { 0.1, 0.2, -0.4 };
    dig_ode_scene_move(ode, pose, 0.01, -0.02, 0.3);
    dig_ode_scene_read(ode, &tool);
    assert_close(tool.pose.x_m, 0.1, 0.0);
    assert_close(tool.pose.theta_rad, -0.4, 1e-15);
    assert_close(tool.vz_mps, -0.02, 0.0);
    assert_close(tool.w_radps, 0.3, 0.0);
    dig_ode_scene_destroy(ode);
    dig_ode_scene_destroy(NULL);
}

// ODE's narrow phase between a sphere and the bucket's triangles: how many contacts.
static size_t collide(const struct dig_ode_scene *const ode, const double centre_m[3],
                      dContactGeom contact[8])
{
    dGeomID ball = dCreateSphere(NULL, GRAIN_m);
    dGeomSetPosition(ball, centre_m[0], centre_m[1], centre_m[2]);
    const int count = dCollide(ball, ode->shell, 8, contact, sizeof contact[0]);
    dGeomDestroy(ball);
    return (size_t)count;
}

// Spheres that touch one plate only, on its face, from the side ODE's triangles show: here both
// narrow phases must agree. On the other side, at edges and in corners ODE's does not find what the
// law needs, which is why ours is used: docs/adr/0002-tool-narrow-phase.md.
TEST(odes_collision_agrees_where_it_sees_the_plates)
{
    struct dig_ode_scene *const ode    = dig_ode_scene_create(&ode_scene);
    struct dig_tool             tool   = dig_tool_make(&rig_bucket);
    uint64_t                    random = 5;
    assert_non_null(ode);
    dig_ode_scene_move(ode, (struct dig_pose){ 0.3, 0.4, 0.7 }, 0.0, 0.0, 0.0);
    dig_ode_scene_read(ode, &tool);
    int seen = 0, missed = 0;
    for (int k = 0; k < 200000 && seen < 400; k++) {
        const double body[3] = { dig_chance_between(&random, -0.058, 0.006),
                                 dig_chance_between(&random, -0.039, 0.039),
                                 dig_chance_between(&random, -0.095, 0.004) };
        double       best = INFINITY, closest[3] = { 0.0 };
        int          near = 0;
        for (size_t plate = 0; plate < tool.plates; plate++) {
            double c[3];
            dig_bucket_closest(&tool.bucket, plate, body, c);
            const double d = distance(body, c);
            near += d < GRAIN_m;
            if (d < best) {
                best = d;
                memcpy(closest, c, sizeof c);
            }
        }
        // On the face, if moving along the normal does not move the closest point.
        if (near != 1 || best < 0.9 * GRAIN_m) {
            continue;
        }
        const double rim_m = fabs((closest[0] + 0.012) * 0.09 - closest[2] * 0.012 * -1.0);
        if (rim_m < 1e-6) {
            continue; // the rim of the mouth
        }
        double world[3], normal[3];
        dig_tool_rotate(&tool, body, world);
        world[0] += tool.pose.x_m;
        world[2] += tool.pose.z_m;
        const double away[3] = { (body[0] - closest[0]) / best, (body[1] - closest[1]) / best,
                                 (body[2] - closest[2]) / best };
        dig_tool_rotate(&tool, away, normal);
        dContactGeom contact[8];
        const size_t count = collide(ode, world, contact);
        if (count == 0) {
            missed++;
            continue;
        }
        // A sphere over the seam of two triangles gets more contacts than one: the deepest counts.
        size_t deepest = 0;
        for (size_t c = 1; c < count; c++) {
            deepest = contact[c].depth > contact[deepest].depth ? c : deepest;
        }
        // ODE's normal points into the first geometry, the sphere.
        const double *const n   = contact[deepest].normal;
        const double        dot = n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2];
        assert_close(dot, 1.0, 1e-9);
        assert_close(contact[deepest].depth, GRAIN_m - best, 1e-8);
        seen++;
    }
    assert_true(seen >= 400);
    assert_true(missed > 200);
    dig_ode_scene_destroy(ode);
}
