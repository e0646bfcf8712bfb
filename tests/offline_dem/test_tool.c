// The bucket's plates: closest points against looking everywhere, what counts as one contact.

#include "core/chance.h"
#include "tests/dem_fixture.h"

#include "offline_dem/shapes/bucket_surface.h"
#include "offline_dem/world/surfaces.h"
#include "tests/offline_dem/rig_bucket.h"

#include <math.h>

// Samples a plate as a set of points: corners weighted into its interior.
static double sampled_distance(const size_t plate, const double p[3])
{
    const struct dig_bucket *const b    = &rig_bucket;
    double                         best = INFINITY;
    const int                      n    = 120;
    if (plate + 1 < b->points) {
        for (int u = 0; u <= n; u++) {
            for (int v = 0; v <= n; v++) {
                const double s    = (double)u / n;
                const double q[3] = { (1.0 - s) * b->x_m[plate] + s * b->x_m[plate + 1],
                                      b->width_m * ((double)v / n - 0.5),
                                      (1.0 - s) * b->z_m[plate] + s * b->z_m[plate + 1] };
                best              = fmin(best, distance(p, q));
            }
        }
        return best;
    }
    // A side is a fan of triangles from the tooth.
    const double y = plate + 1 == b->points ? -0.5 * b->width_m : 0.5 * b->width_m;
    for (size_t k = 1; k + 1 < b->points; k++) {
        for (int u = 0; u <= n; u++) {
            for (int v = 0; u + v <= n; v++) {
                const double s = (double)u / n, t = (double)v / n;
                const double q[3] = {
                    b->x_m[0] + s * (b->x_m[k] - b->x_m[0]) + t * (b->x_m[k + 1] - b->x_m[0]), y,
                    b->z_m[0] + s * (b->z_m[k] - b->z_m[0]) + t * (b->z_m[k + 1] - b->z_m[0])
                };
                best = fmin(best, distance(p, q));
            }
        }
    }
    return best;
}

TEST(the_closest_point_is_the_closest_of_all)
{
    const struct dig_tool tool   = dig_tool_make(&rig_bucket);
    uint64_t              random = 1;
    assert_int_equal(tool.plates, 6);
    for (int k = 0; k < (test_is_quick() ? 20 : 120); k++) {
        const double p[3] = { dig_chance_between(&random, -0.07, 0.02),
                              dig_chance_between(&random, -0.05, 0.05),
                              dig_chance_between(&random, -0.11, 0.02) };
        for (size_t plate = 0; plate < tool.plates; plate++) {
            double c[3];
            dig_bucket_closest(&tool.bucket, plate, p, c);
            // Sampled points are at most 0.4 mm from any point of the plate.
            const double sampled = sampled_distance(plate, p);
            assert_true(distance(p, c) <= sampled + 1e-12);
            assert_true(sampled <= hypot(distance(p, c), 4.5e-4) + 1e-12);
            assert_true(sampled_distance(plate, c) < 4.5e-4);
        }
    }
}

TEST(body_and_world_agree_with_the_drawing)
{
    struct dig_tool tool = dig_tool_make(&rig_bucket);
    dig_tool_place(&tool, (struct dig_pose){ 1.0, 2.0, 0.5 }, 0.0, 0.0, 0.0);
    // The tooth is at pin + L (sin theta, -cos theta).
    double world[3], body[3];
    dig_tool_rotate(&tool, (const double[3]){ 0.0, 0.01, -0.09 }, world);
    assert_close(world[0], 0.09 * sin(0.5), 1e-15);
    assert_close(world[2], -0.09 * cos(0.5), 1e-15);
    const double there[3] = { 1.0 + world[0], 0.01, 2.0 + world[2] };
    dig_tool_to_body(&tool, there, body);
    assert_close(body[0], 0.0, 1e-15);
    assert_close(body[1], 0.01, 1e-15);
    assert_close(body[2], -0.09, 1e-15);
}

// Force of a grain at rest at body position p on the unmoved bucket, after one step.
static struct dig_wrench press(const double p[3])
{
    const double     x[1][3] = { { p[0], p[1], p[2] } };
    struct dig_world world   = dem_world(1, x, dem_material(0.5, 0.5));
    struct dig_tool  tool    = dig_tool_make(&rig_bucket);
    world.tool               = &tool;
    dem_run(&world, 1);
    const struct dig_wrench wrench = world.on_tool;
    dig_world_finish(&world);
    return wrench;
}

static double size(const double f[3])
{
    return hypot(hypot(f[0], f[1]), f[2]);
}

#define DEPTH_m (0.01 * GRAIN_m)

// Outside of the profile's corner A, a distance d from it along the bisector of the normals.
static void outside_of_corner(const size_t corner, const double d_m, double p[3])
{
    const struct dig_bucket *const b    = &rig_bucket;
    double                         n[2] = { 0.0, 0.0 };
    for (size_t k = corner - 1; k <= corner; k++) {
        const double ux = b->x_m[k + 1] - b->x_m[k];
        const double uz = b->z_m[k + 1] - b->z_m[k];
        const double l  = hypot(ux, uz);
        // The profile runs clockwise seen from -y: its outside lies to the right of the way.
        n[0] += -uz / l;
        n[1] += ux / l;
    }
    const double centre_x = b->x_m[corner] + 0.02, centre_z = b->z_m[corner];
    double       l = hypot(n[0], n[1]);
    // Away from the inside of the bucket, which is towards +x of its back.
    if (n[0] * (centre_x - b->x_m[corner]) + n[1] * (centre_z - b->z_m[corner]) > 0.0) {
        l = -l;
    }
    p[0] = b->x_m[corner] + d_m * n[0] / l;
    p[1] = 0.0;
    p[2] = b->z_m[corner] + d_m * n[1] / l;
}

TEST(an_edge_is_one_contact_and_a_corner_two)
{
    // On the face of plate B-C, far from all edges.
    const double ux = 0.012, uz = 0.03, l = hypot(ux, uz);
    const double mid[2]  = { -0.046, -0.027 };
    const double d       = GRAIN_m - DEPTH_m;
    const double face[3] = { mid[0] - d * uz / l, 0.0, mid[1] + d * ux / l };
    const double face_N  = size(press(face).f_N);
    assert_true(face_N > 0.0);

    // On the ridge outside of B, the same depth: one contact, the same force, along the bisector.
    double edge[3];
    outside_of_corner(2, d, edge);
    const struct dig_wrench on_edge = press(edge);
    assert_close(size(on_edge.f_N), face_N, 1e-9 * face_N);

    // The rim where plate and side meet, from outside: the same.
    const double            s      = d / sqrt(2.0);
    const double            rim[3] = { mid[0] - s * uz / l, 0.035 + s, mid[1] + s * ux / l };
    const struct dig_wrench on_rim = press(rim);
    assert_close(size(on_rim.f_N), face_N, 1e-9 * face_N);

    // Inside, in the corner between plate and side, a grain lies on both.
    const double            in[3]     = { mid[0] + d * uz / l, 0.035 - d, mid[1] - d * ux / l };
    const struct dig_wrench on_corner = press(in);
    assert_close(size(on_corner.f_N), sqrt(2.0) * face_N, 1e-9 * face_N);
    assert_close(on_corner.f_N[1], face_N, 1e-9 * face_N);
}

// A face's neighbour across an edge must not be felt twice near the edge.
TEST(near_an_edge_the_face_alone_counts)
{
    const double ux = 0.012, uz = 0.03, l = hypot(ux, uz);
    const double d    = GRAIN_m - DEPTH_m;
    const double s    = 1e-4; // along the plate from B, far less than the grain's print
    const double p[3] = { -0.052 + s * ux / l - d * uz / l, 0.0, -0.042 + s * uz / l + d * ux / l };
    const double mid[3] = { -0.046 - d * uz / l, 0.0, -0.027 + d * ux / l };
    assert_close(size(press(p).f_N), size(press(mid).f_N), 1e-9);
}

// Where a grain is that is led along plate B-C to B, around the ridge, and away along B-A: way_m is
// counted from B's beginning of the arc. Gives the outward normal and the way it goes.
static void lead(const double way_m, const double d_m, double x[3], double normal[2],
                 double tangent[2])
{
    const double first   = DIG_PI - atan2(0.012, 0.03); // of the outward normal of B-C
    const double arc_m   = 2.0 * atan2(0.012, 0.03) * d_m;
    const double angle   = first + fmin(fmax(way_m, 0.0), arc_m) / d_m;
    const double along_m = way_m < 0.0 ? way_m : fmax(way_m - arc_m, 0.0);
    normal[0]            = cos(angle);
    normal[1]            = sin(angle);
    tangent[0]           = -sin(angle);
    tangent[1]           = cos(angle);
    x[0]                 = -0.052 + d_m * normal[0] + along_m * tangent[0];
    x[1]                 = 0.0;
    x[2]                 = -0.042 + d_m * normal[1] + along_m * tangent[1];
}

// Pressed and unable to turn, it drags all the way: what the contact knows goes with it from plate
// to edge to plate. Forgetting would show as a step of the friction.
TEST(a_contact_goes_on_across_an_edge)
{
    const double     x[1][3] = { { -0.06, 0.0, -0.042 } };
    struct dig_world world   = dem_world(1, x, dem_material(0.5, 0.0));
    struct dig_tool  tool    = dig_tool_make(&rig_bucket);
    world.tool               = &tool;
    const double d_m = GRAIN_m - DEPTH_m, step_m = 1e-6;
    for (double way_m = -0.3 * GRAIN_m; way_m < 1.1 * GRAIN_m; way_m += step_m) {
        struct dig_motion at = { 0 };
        double            n[2], t[2];
        lead(way_m, d_m, at.x_m, n, t);
        at.v_mps[0]            = step_m / STEP_s * t[0];
        at.v_mps[2]            = step_m / STEP_s * t[1];
        world.grains.motion[0] = at;
        dig_world_mark_stale(&world);
        dem_run(&world, 1);
        const double *const f        = world.on_tool.f_N;
        const double        normal_N = -(f[0] * n[0] + f[2] * n[1]);
        const double        along_N  = f[0] * t[0] + f[2] * t[1];
        assert_true(normal_N > 0.0);
        if (way_m > -0.25 * GRAIN_m) {
            // The plane of contact turns under the displacement, which shortens it a little.
            assert_close(along_N / normal_N, 0.5, 5e-3);
        }
    }
    dig_world_finish(&world);
}

// At the contact, a tool that turns and one that is shifted with the velocity the rotation has
// there are the same.
TEST(a_turning_plate_moves_as_its_contact_point_does)
{
    const double mid[2] = { -0.046, -0.027 }, l = hypot(0.012, 0.03), w = 2.0;
    const double d       = GRAIN_m - DEPTH_m;
    const double x[1][3] = { { mid[0] - d * 0.03 / l, 0.0, mid[1] + d * 0.012 / l } };
    double       f[2][3];
    for (int k = 0; k < 2; k++) {
        struct dig_world world = dem_world(1, x, dem_material(0.5, 0.0));
        struct dig_tool  tool  = dig_tool_make(&rig_bucket);
        world.tool             = &tool;
        // World x turns towards z: a point (x, z) moves with w (-z, x).
        dig_tool_place(&tool, (struct dig_pose){ 0.0, 0.0, 0.0 }, k == 0 ? 0.0 : -w * mid[1],
                       k == 0 ? 0.0 : w * mid[0], k == 0 ? w : 0.0);
        dem_run(&world, 1);
        memcpy(f[k], world.on_tool.f_N, sizeof f[k]);
        dig_world_finish(&world);
    }
    assert_true(size(f[0]) > 0.0);
    for (int k = 0; k < 3; k++) {
        assert_close(f[0][k], f[1][k], 1e-12);
    }
}

TEST(a_grain_on_a_plate_gives_its_weight_and_its_moment)
{
    struct dig_bucket flat = { .points = 3, .x_m = { 0.1, 0.0, 0.05 }, .z_m = { 0.0, 0.0, -0.05 } };
    flat.width_m           = 0.05;
    const double     x[1][3] = { { 0.03, 0.01, GRAIN_m } };
    struct dig_world world   = dem_world(1, x, dem_material(0.5, 0.5));
    world.gravity_mps2[2]    = -GRAVITY;
    struct dig_tool tool     = dig_tool_make(&flat);
    world.tool               = &tool;
    dem_run(&world, 6000);
    const double weight_N = GRAIN_kg * GRAVITY;
    assert_close(world.on_tool.f_N[2], -weight_N, 1e-5 * weight_N);
    assert_close(world.on_tool.t_Nm[1], 0.03 * weight_N, 1e-5 * weight_N * 0.03);
    assert_close(world.on_tool.t_Nm[0], -0.01 * weight_N, 1e-5 * weight_N * 0.03);
    dig_world_finish(&world);
}

// The plate of a tool that moves takes a grain along: at the contact the tool has the velocity of
// its pin and of its rotation.
TEST(a_moving_plate_carries_a_grain)
{
    struct dig_bucket flat = { .points = 3, .x_m = { 0.1, -0.1, 0.0 }, .z_m = { 0.0, 0.0, -0.05 } };
    flat.width_m           = 0.05;
    const double     x[1][3] = { { 0.0, 0.0, GRAIN_m } };
    struct dig_world world   = dem_world(1, x, dem_material(0.5, 5.0));
    world.gravity_mps2[2]    = -GRAVITY;
    struct dig_tool tool     = dig_tool_make(&flat);
    world.tool               = &tool;
    for (int s = 0; s < 3000; s++) {
        dig_tool_place(&tool, (struct dig_pose){ 0.1 * s * STEP_s, 0.0, 0.0 }, 0.1, 0.0, 0.0);
        dem_run(&world, 1);
    }
    assert_close(world.grains.motion[0].v_mps[0], 0.1, 1e-3);
    dig_world_finish(&world);
}
