// One or two grains against closed forms of rigid-body mechanics. The engine knows none of them: it
// only knows springs.

#include "tests/dem_fixture.h"

#include <math.h>

// Stiffer than the reference and in finer steps, so that a contact is short and shallow against
// everything the closed forms are about.
#define STIFF_Pa 1e8
#define FINE_s   2e-6
#define HEIGHT_m (GRAIN_m - 1e-7)

// The reference's gravel, stiff, with this restitution.
static void set_stiff(struct dig_world *const world, const double friction, const double rolling,
                      const double restitution)
{
    struct dig_law_material material = dem_material(friction, rolling);
    material.young_Pa                = STIFF_Pa;
    material.restitution             = restitution;
    dem_set_material(world, &material);
}

static struct dig_world on_floor(const double friction, const double rolling, const double slope)
{
    const double     x[1][3] = { { 0.0, 0.0, HEIGHT_m } };
    struct dig_world world   = dem_world(1, x, dem_material(friction, rolling));
    set_stiff(&world, friction, rolling, 0.2);
    world.dt_s = FINE_s;
    dem_add_slope(&world, slope);
    return world;
}

TEST(two_grains_part_with_the_restitution_they_were_given)
{
    const double restitution[] = { 0.2, 0.5, 0.9 };
    for (size_t k = 0; k < 3; k++) {
        const double            x[2][3]  = { { 0.0, 0.0, 0.0 }, { 2.001 * GRAIN_m, 0.0, 0.0 } };
        struct dig_world        world    = dem_world(2, x, dem_material(0.5, 0.5));
        struct dig_law_material material = dem_material(0.5, 0.5);
        material.restitution             = restitution[k];
        dem_set_material(&world, &material);
        world.dt_s                      = FINE_s;
        world.grains.motion[0].v_mps[0] = 0.7;
        world.grains.motion[1].v_mps[0] = -0.5;
        dem_run_for(&world, 5e-3);
        const double apart = dem_grain(&world, 1)->v_mps[0] - dem_grain(&world, 0)->v_mps[0];
        assert_close(apart / 1.2, restitution[k], 0.005);
        // Equal masses: the mean velocity is kept.
        assert_close(dem_grain(&world, 1)->v_mps[0] + dem_grain(&world, 0)->v_mps[0], 0.2, 1e-12);
        dig_world_finish(&world);
    }
}

TEST(a_grain_leaves_a_wall_with_its_restitution)
{
    struct dig_world world = on_floor(0.5, 0.5, 0.0);
    world.gravity_mps2[2]  = 0.0;
    set_stiff(&world, 0.5, 0.5, 0.6);
    world.grains.motion[0].x_m[2]   = 1.01 * GRAIN_m;
    world.grains.motion[0].v_mps[2] = -0.5;
    dem_run_for(&world, 5e-3);
    assert_close(world.grains.motion[0].v_mps[2], 0.3, 0.3 * 0.005);
    dig_world_finish(&world);
}

// Sliding all through the impact: the wall takes mu (1 + e) v_n off the tangential velocity and
// gives the grain 5/2 of that, over its radius, in spin.
TEST(a_grazing_impact_slides)
{
    const double     mu    = 0.1;
    struct dig_world world = on_floor(mu, 0.0, 0.0);
    world.gravity_mps2[2]  = 0.0;
    set_stiff(&world, mu, 0.0, 0.95);
    world.grains.motion[0].x_m[2]   = 1.01 * GRAIN_m;
    world.grains.motion[0].v_mps[0] = 2.0;
    world.grains.motion[0].v_mps[2] = -0.5;
    dem_run_for(&world, 2e-3);
    const struct dig_motion *const m    = &world.grains.motion[0];
    const double                   lost = mu * 1.95 * 0.5;
    assert_close(m->v_mps[0], 2.0 - lost, 0.01 * lost);
    assert_close(m->w_radps[1], 2.5 * lost / GRAIN_m, 0.01 * 2.5 * lost / GRAIN_m);
    dig_world_finish(&world);
}

// The other limit: no grain leaves a steep impact with more tangential speed of its contact point
// than it came with, and friction has not taken more than Coulomb allows.
TEST(a_steep_impact_sticks_within_coulomb)
{
    struct dig_world world = on_floor(0.9, 0.0, 0.0);
    world.gravity_mps2[2]  = 0.0;
    set_stiff(&world, 0.9, 0.0, 0.5);
    world.grains.motion[0].x_m[2]   = 1.01 * GRAIN_m;
    world.grains.motion[0].v_mps[0] = 0.05;
    world.grains.motion[0].v_mps[2] = -1.0;
    dem_run_for(&world, 3e-3);
    const struct dig_motion *const m    = &world.grains.motion[0];
    const double                   slip = m->v_mps[0] - GRAIN_m * m->w_radps[1];
    const double                   lost = 0.05 - m->v_mps[0];
    assert_true(fabs(slip) < 0.05);
    assert_true(fabs(lost) < 0.9 * 1.5 * 1.0);
    // Only friction turned it, at the same lever that slowed it.
    assert_close(m->w_radps[1], 2.5 * lost / GRAIN_m, 0.02 * fabs(2.5 * lost / GRAIN_m));
    dig_world_finish(&world);
}

TEST(a_sliding_grain_ends_rolling_at_five_sevenths)
{
    struct dig_world world          = on_floor(0.5, 0.0, 0.0);
    world.grains.motion[0].v_mps[0] = 0.3;
    // Sliding ends after 2/7 v0 / (mu g).
    dem_run_for(&world, 0.01);
    assert_close(world.grains.motion[0].v_mps[0], 0.3 - 0.5 * GRAVITY * 0.01, 2e-3);
    dem_run_for(&world, 0.04);
    assert_close(world.grains.motion[0].v_mps[0], 0.3 * 5.0 / 7.0, 1e-3);
    assert_close(world.grains.motion[0].w_radps[1] * GRAIN_m, 0.3 * 5.0 / 7.0, 1e-3);
    dig_world_finish(&world);
}

// Acceleration down a slope, from two speeds 0.02 s apart.
static double acceleration(const double friction, const double rolling, const double slope)
{
    struct dig_world world = on_floor(friction, rolling, slope);
    dem_run_for(&world, 0.03);
    const double before_mps = world.grains.motion[0].v_mps[0];
    dem_run_for(&world, 0.02);
    const double a = (world.grains.motion[0].v_mps[0] - before_mps) / 0.02;
    dig_world_finish(&world);
    return a;
}

TEST(a_grain_that_may_roll_does_so_at_five_sevenths_of_the_slope)
{
    const double slope = 0.2;
    const double rolls = 5.0 / 7.0 * GRAVITY * sin(slope);
    assert_close(acceleration(0.5, 0.0, slope), rolls, 0.01 * rolls);
}

TEST(a_grain_slips_where_the_slope_asks_for_more_friction_than_there_is)
{
    // Rolling without slip needs tan(slope) <= 7/2 mu.
    const double slope = 0.5;
    const double slips = GRAVITY * (sin(slope) - 0.1 * cos(slope));
    assert_close(acceleration(0.1, 0.0, slope), slips, 0.01 * slips);
    // Just below the limit it still rolls.
    const double below = atan(3.5 * 0.1) - 0.03;
    assert_close(acceleration(0.1, 0.0, below), 5.0 / 7.0 * GRAVITY * sin(below), 0.03);
}

TEST(a_grain_stays_below_the_rolling_friction_angle_and_rolls_above)
{
    const double rolling = 0.3;
    const double below   = atan(rolling) - 0.03;
    const double above   = atan(rolling) + 0.1;
    assert_close(acceleration(0.9, rolling, below), 0.0, 0.02);
    struct dig_world world = on_floor(0.9, rolling, below);
    dem_run_for(&world, 0.1);
    assert_true(fabs(world.grains.motion[0].x_m[0]) < 1e-5);
    dig_world_finish(&world);

    const double rolls = 5.0 / 7.0 * GRAVITY * (sin(above) - rolling * cos(above));
    assert_close(acceleration(0.9, rolling, above), rolls, 0.02 * rolls);
}

TEST(a_grain_that_cannot_roll_slides_only_above_the_friction_angle)
{
    const double mu = 0.3;
    assert_close(acceleration(mu, 5.0, atan(mu) - 0.03), 0.0, 0.02);
    const double above  = atan(mu) + 0.1;
    const double slides = GRAVITY * (sin(above) - mu * cos(above));
    assert_close(acceleration(mu, 5.0, above), slides, 0.02 * slides);
}

// Without sliding friction only the rolling torque mu_r r m g acts: spin falls linearly.
TEST(rolling_friction_takes_spin_off_linearly)
{
    const double     rolling          = 0.3;
    struct dig_world world            = on_floor(0.0, rolling, 0.0);
    world.grains.motion[0].w_radps[0] = 50.0;
    const double rate                 = rolling * GRAIN_m * GRAIN_kg * GRAVITY / GRAIN_kgm2;
    dem_run_for(&world, 0.01);
    assert_close(world.grains.motion[0].w_radps[0], 50.0 - rate * 0.01, 0.02 * rate * 0.01);
    dig_world_finish(&world);
}

TEST(spin_about_the_normal_is_free)
{
    struct dig_world world            = on_floor(0.9, 0.9, 0.0);
    world.grains.motion[0].w_radps[2] = 50.0;
    dem_run_for(&world, 0.02);
    assert_close(world.grains.motion[0].w_radps[2], 50.0, 1e-9);
    dig_world_finish(&world);
}

TEST(a_grain_at_rest_presses_with_its_weight)
{
    struct dig_world world = on_floor(0.5, 0.5, 0.0);
    dem_run_for(&world, 0.1);
    assert_close(world.on_walls.f_N[2], -GRAIN_kg * GRAVITY, 1e-6 * GRAIN_kg * GRAVITY);
    assert_close(dig_grains_kinetic_J(&world.grains), 0.0, 1e-16);
    dig_world_finish(&world);
}
