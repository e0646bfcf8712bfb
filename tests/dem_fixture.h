// What the tests of the discrete element engine share: the gravel of the reference, and worlds of a
// few grains between a few walls.

#ifndef DIG_TESTS_DEM_FIXTURE_H
#define DIG_TESTS_DEM_FIXTURE_H

#include "core/scene.h"
#include "core/units.h"
#include "offline_dem/world/world.h"
#include "tests/dem_grains.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRAIN_m    0.00375
#define DENSITY    2500.0
#define STEP_s     6.25e-5
#define GRAIN_kg   (DENSITY * 4.0 / 3.0 * DIG_PI * GRAIN_m * GRAIN_m * GRAIN_m)
#define GRAIN_kgm2 (0.4 * GRAIN_kg * GRAIN_m * GRAIN_m)
#define GRAVITY    9.81

/// A box of about 8 x 6 x 4 grains, and a small bucket that is dragged for an instant: what takes a
/// fraction of a second to pour. Tests that dig say how.
static inline struct dig_scene dem_small_scene(void)
{
    return (struct dig_scene){
        .name         = "small",
        .bucket       = { .points  = 5,
                          .x_m     = { 0.0, -0.016, -0.0208, -0.016, -0.0048 },
                          .z_m     = { -0.036, -0.0288, -0.0168, -0.0048, 0.0 },
                          .width_m = 0.028 },
        .box          = { 0.0, 0.06, -0.0225, 0.0225, 0.0, 0.03 },
        .packing      = { 0.3, 0.694, 0.3, 0.45, 0.15 },
        .material     = { 2.0 * GRAIN_m, 5e6, 0.2, 0.2, 2.0 },
        .gravity_mps2 = GRAVITY,
        .time_step_s  = STEP_s,
        .output_s     = 0.005,
        .trajectories = 1,
        .trajectory   = { { .name      = "scratch",
                            .start_x_m = 0.03,
                            .start_z_m = 0.06,
                            .phases    = 1,
                            .phase     = { { "drag", 0.1, 0.05, 0.0, 0.0 } } } },
    };
}

/// The same, longer, dug down and then dragged for drag_s while it curls: what two engines are held
/// against each other on before chaos parts them.
static inline struct dig_scene dem_short_dig_scene(const double drag_s)
{
    struct dig_scene scene = dem_small_scene();
    scene.box.x_max_m      = 0.08;
    scene.packing.settle_s = 0.3;
    scene.packing.relax_s  = 0.1;

    struct dig_trajectory *const t = &scene.trajectory[0];
    t->start_z_m                   = 0.066;
    t->phases                      = 2;
    t->phase[0]                    = (struct dig_phase){ "down", 0.04, 0.0, -0.15, 0.0 };
    t->phase[1]                    = (struct dig_phase){ "drag", drag_s, 0.2, 0.0, 2.0 };
    return scene;
}

/// Grains of two sizes under Hertz's law and CDT that stick to each other and to a bucket smoother
/// than they.
static inline void dem_mix_sticky_grains(struct dig_scene *const scene)
{
    scene->laws        = (struct dig_laws){ .normal            = DIG_NORMAL_HERTZ,
                                            .rolling           = DIG_ROLLING_CDT,
                                            .cohesion_Jpm3     = 2e4,
                                            .adhesion_Jpm3     = 1e4,
                                            .bucket_smoothness = 0.6 };
    scene->bed.sizes   = 2;
    scene->bed.size[0] = (struct dig_size){ 0.006, 0.5 };
    scene->bed.size[1] = (struct dig_size){ 0.0085, 0.5 };
}

/// The reference digs' material with these two frictions.
static inline struct dig_law_material dem_material(const double friction, const double rolling)
{
    return (struct dig_law_material){
        .young_Pa                    = 5e6,
        .poisson                     = 0.2,
        .restitution                 = 0.2,
        .characteristic_velocity_mps = 2.0,
        .friction                    = friction,
        .rolling                     = rolling,
    };
}

/// A world of n like grains at rest, without gravity, walls or tool.
static inline struct dig_world dem_world(const size_t n, const double (*const x_m)[3],
                                         const struct dig_law_material material)
{
    double *const work = calloc(4 * n + 1, sizeof *work);
    assert_non_null(work);
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < 3; k++) {
            work[k * n + i] = x_m[i][k];
        }
        work[3 * n + i] = GRAIN_m;
    }
    struct dig_grains grains;
    assert_int_equal(
        dem_create_grains(n, work, work + n, work + 2 * n, work + 3 * n, DENSITY, &grains), DIG_OK);
    free(work);
    struct dig_world world = { .dt_s = STEP_s, .isa = dig_kernel_best() };
    dig_world_init(&world, &grains);
    dem_set_material(&world, &material);
    return world;
}

static inline void dem_add_wall(struct dig_world *const world, const double nx, const double ny,
                                const double nz, const double offset_m)
{
    world->wall[world->walls++] = (struct dig_wall){ { nx, ny, nz }, offset_m };
}

static inline void dem_run(struct dig_world *const world, const size_t steps)
{
    for (size_t s = 0; s < steps; s++) {
        assert_int_equal(dig_world_step(world), DIG_OK);
    }
}

static inline void dem_run_for(struct dig_world *const world, const double time_s)
{
    dem_run(world, (size_t)llround(time_s / world->dt_s));
}

/// A slope is a floor that stays level under a gravity that leans.
static inline void dem_add_slope(struct dig_world *const world, const double slope_rad)
{
    world->gravity_mps2[0] = GRAVITY * sin(slope_rad);
    world->gravity_mps2[2] = -GRAVITY * cos(slope_rad);
    dem_add_wall(world, 0.0, 0.0, 1.0, 0.0);
}

/// The grain that was number `name` at the beginning: grains change places.
static inline struct dig_motion *dem_grain(const struct dig_world *const world, const uint32_t name)
{
    for (size_t i = 0; i < world->grains.n; i++) {
        if (world->grains.id[i] == name) {
            return &world->grains.motion[i];
        }
    }
    fail_msg("no grain %u", (unsigned)name);
    return NULL;
}

#endif // DIG_TESTS_DEM_FIXTURE_H
