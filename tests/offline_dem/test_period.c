// Sides that are one: the same mechanics across the border as in the middle.

#include "core/chance.h"
#include "tests/dem_fixture.h"

#include "offline_dem/law/period.h"

#include <math.h>

#define PERIOD_m (20.0 * GRAIN_m)
#define SIDE     4
#define GRAINS   ((size_t)SIDE * SIDE * SIDE)

static double fold(const double y_m)
{
    return dig_period_fold(y_m, PERIOD_m, dig_period_inverse(PERIOD_m));
}

TEST(a_distance_folds_to_the_nearest_image)
{
    for (int k = -40; k <= 40; k++) {
        const double y_m     = (0.07 * k + 0.001) * PERIOD_m;
        const double nearest = remainder(y_m, PERIOD_m);
        assert_close(fold(y_m), nearest, 1e-15);
        assert_close(dig_period_fold(y_m, 0.0, dig_period_inverse(0.0)), y_m, 0.0);
    }
}

TEST(a_grain_that_leaves_on_one_side_comes_in_on_the_other)
{
    const double     x[1][3]        = { { 0.0, 0.45 * PERIOD_m, 0.0 } };
    struct dig_world world          = dem_world(1, x, dem_material(0.5, 0.5));
    world.period_y_m                = PERIOD_m;
    world.grains.motion[0].v_mps[1] = 1.0;
    bool crossed                    = false;
    for (int s = 0; s < 4000; s++) {
        dem_run(&world, 1);
        const double went_m = 0.45 * PERIOD_m + (s + 1) * STEP_s;
        assert_close(fold(world.grains.motion[0].x_m[1] - went_m), 0.0, 1e-12);
        crossed |= world.grains.motion[0].x_m[1] < 0.0;
        // What it may be ahead of its list, and no farther.
        assert_true(fabs(world.grains.motion[0].x_m[1]) < 0.7 * PERIOD_m);
    }
    assert_true(crossed);
    dig_world_finish(&world);
}

// A glancing collision with spin, where the period begins and in its middle.
static struct dig_world make_collision(const double y_m)
{
    const double     x[2][3]          = { { 0.0, fold(y_m - 1.2 * GRAIN_m), 0.0 },
                                          { 0.4 * GRAIN_m, fold(y_m + 1.2 * GRAIN_m), 0.1 * GRAIN_m } };
    struct dig_world world            = dem_world(2, x, dem_material(0.5, 0.5));
    world.period_y_m                  = PERIOD_m;
    world.grains.motion[0].v_mps[1]   = 0.3;
    world.grains.motion[1].v_mps[1]   = -0.2;
    world.grains.motion[0].w_radps[0] = 30.0;
    return world;
}

TEST(a_pair_across_the_border_moves_as_in_the_middle)
{
    const double     shift_m = 0.5 * PERIOD_m;
    struct dig_world middle  = make_collision(0.0);
    struct dig_world border  = make_collision(shift_m);
    bool             met     = false;
    for (int s = 0; s < 600; s++) {
        // Lists are remade in the middle of the contact too: it goes on remembering.
        if (s % 37 == 0) {
            dig_neighbours_finish(&border.neighbours);
            dig_world_mark_stale(&border);
        }
        dem_run(&middle, 1);
        dem_run(&border, 1);
        met |= middle.pair[0].n == 1 && fabs(middle.pair[0].history[0][0]) > 0.0;
        for (uint32_t i = 0; i < 2; i++) {
            const struct dig_motion *const a = dem_grain(&middle, i);
            const struct dig_motion *const b = dem_grain(&border, i);
            assert_close(b->x_m[0], a->x_m[0], 1e-13);
            assert_close(fold(b->x_m[1] - a->x_m[1] - shift_m), 0.0, 1e-13);
            assert_close(b->w_radps[0], a->w_radps[0], 1e-8);
        }
    }
    assert_true(met);
    dig_world_finish(&middle);
    dig_world_finish(&border);
}

// A cloud that falls in on itself and reaches around the period.
TEST(momentum_is_kept_across_the_border)
{
    uint64_t random = 3;
    double   x[GRAINS][3];
    for (size_t i = 0; i < GRAINS; i++) {
        const size_t at[3] = { i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE };
        for (size_t k = 0; k < 3; k++) {
            x[i][k] = (2.2 * (double)at[k] + dig_chance_between(&random, -0.05, 0.05)) * GRAIN_m;
        }
    }
    struct dig_world world = dem_world(GRAINS, (const double(*)[3])x, dem_material(0.5, 0.3));
    world.period_y_m       = 9.0 * GRAIN_m;
    double p[2][3]         = { { 0.0 } };
    for (size_t i = 0; i < GRAINS; i++) {
        for (size_t k = 0; k < 3; k++) {
            const double inward             = k == 1 ? 0.0 : -20.0 * (x[i][k] - 3.3 * GRAIN_m);
            world.grains.motion[i].v_mps[k] = inward + dig_chance_between(&random, -0.3, 0.3);
            p[0][k] += world.grains.motion[i].v_mps[k];
        }
    }
    size_t across = 0;
    for (int k = 0; k < 40; k++) {
        dem_run(&world, 10);
        for (size_t c = 0; c < world.pair[0].n; c++) {
            const double dy_m = world.grains.motion[world.pair[0].i[c]].x_m[1] -
                                world.grains.motion[world.pair[0].j[c]].x_m[1];
            across += fabs(dy_m) > 4.5 * GRAIN_m && fabs(world.pair[0].history[0][c]) > 0.0;
        }
    }
    assert_true(across > 20);
    for (size_t i = 0; i < GRAINS; i++) {
        for (size_t k = 0; k < 3; k++) {
            p[1][k] += world.grains.motion[i].v_mps[k];
        }
    }
    for (size_t k = 0; k < 3; k++) {
        assert_close(p[1][k], p[0][k], 1e-11);
    }
    dig_world_finish(&world);
}
