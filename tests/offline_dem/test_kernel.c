// The hot loops and the world around them: the same bits from every variant, and what mechanics
// conserves.

#include "core/chance.h"
#include "tests/dem_fixture.h"

#include <math.h>

#define SIDE   5
#define GRAINS ((size_t)SIDE * SIDE * SIDE)

// A cloud that falls in on itself, with spin, in no gravity.
static struct dig_world make_cloud(const uint64_t seed, const double restitution)
{
    uint64_t random = seed;
    double   x[GRAINS][3];
    for (size_t i = 0; i < GRAINS; i++) {
        const size_t at[3] = { i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE };
        for (size_t k = 0; k < 3; k++) {
            x[i][k] = 2.2 * GRAIN_m * ((double)at[k] - 0.5 * (SIDE - 1)) +
                      dig_chance_between(&random, -0.05, 0.05) * GRAIN_m;
        }
    }
    struct dig_law_material material = dem_material(0.5, 0.3);
    material.restitution             = restitution;
    struct dig_world world           = dem_world(GRAINS, (const double(*)[3])x, material);
    for (size_t i = 0; i < GRAINS; i++) {
        struct dig_motion *const m = &world.grains.motion[i];
        for (size_t k = 0; k < 3; k++) {
            m->v_mps[k]   = -20.0 * m->x_m[k] + dig_chance_between(&random, -0.2, 0.2);
            m->w_radps[k] = dig_chance_between(&random, -50.0, 50.0);
        }
    }
    return world;
}

static void cross(const double a[], const double b[], double out[3])
{
    for (size_t k = 0; k < 3; k++) {
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
}

static void sum_momenta(const struct dig_world *const world, double p[3], double l[3])
{
    for (size_t k = 0; k < 3; k++) {
        p[k] = 0.0;
        l[k] = 0.0;
    }
    for (size_t i = 0; i < world->grains.n; i++) {
        const struct dig_motion *const m = &world->grains.motion[i];
        double                         orbital[3];
        cross(m->x_m, m->v_mps, orbital);
        for (size_t k = 0; k < 3; k++) {
            p[k] += GRAIN_kg * m->v_mps[k];
            l[k] += GRAIN_kg * orbital[k] + GRAIN_kgm2 * m->w_radps[k];
        }
    }
}

static size_t touching(const struct dig_world *const world)
{
    size_t count = 0;
    for (size_t c = 0; c < world->pair[0].n; c++) {
        count += fabs(world->pair[0].history[0][c]) > 0.0;
    }
    return count;
}

static void same_bits(const bool single)
{
    struct dig_world first = make_cloud(1, 0.3);
    first.isa              = DIG_ISA_BASE;
    first.single           = single;
    dem_run(&first, 600);
    assert_int_equal(dig_world_sync_motion(&first), DIG_OK);
    for (enum dig_isa isa = DIG_ISA_AVX2; isa <= dig_kernel_best(); isa++) {
        struct dig_world other = make_cloud(1, 0.3);
        other.isa              = isa;
        other.single           = single;
        dem_run(&other, 600);
        assert_int_equal(dig_world_sync_motion(&other), DIG_OK);
        assert_memory_equal(first.grains.motion, other.grains.motion,
                            GRAINS * sizeof *first.grains.motion);
        assert_memory_equal(first.grains.id, other.grains.id, GRAINS * sizeof *first.grains.id);
        dig_world_finish(&other);
    }
    dig_world_finish(&first);
}

TEST(every_variant_gives_the_same_bits)
{
    same_bits(false);
    same_bits(true);
}

// Two clouds in either precision: rounding alone parts them, before chaos does.
TEST(single_precision_moves_grains_alike)
{
    struct dig_world exact = make_cloud(7, 0.3);
    struct dig_world rough = make_cloud(7, 0.3);
    size_t           met   = 0;
    rough.single           = true;
    for (int k = 0; k < 10; k++) {
        dem_run(&exact, 20);
        dem_run(&rough, 20);
        met += touching(&exact);
        assert_true(rough.grains.in_single && !exact.grains.in_single);
        assert_int_equal(dig_world_sync_motion(&rough), DIG_OK);
        for (uint32_t i = 0; i < GRAINS; i++) {
            for (size_t a = 0; a < 3; a++) {
                assert_close(dem_grain(&rough, i)->x_m[a], dem_grain(&exact, i)->x_m[a], 1e-8);
                assert_close(dem_grain(&rough, i)->v_mps[a], dem_grain(&exact, i)->v_mps[a], 1e-5);
            }
        }
    }
    assert_true(met > GRAINS);
    dig_world_finish(&exact);
    dig_world_finish(&rough);
}

// What is read between steps, and what is written, must not depend on where the motions are kept.
TEST(motions_in_single_precision_can_be_read_and_written)
{
    const double     x[2][3] = { { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0 } };
    struct dig_world world   = dem_world(2, x, dem_material(0.5, 0.5));
    world.single             = true;
    world.gravity_mps2[2]    = -GRAVITY;
    dem_run(&world, 101);
    assert_int_equal(dig_world_sync_motion(&world), DIG_OK);
    const double fall_mps = dem_grain(&world, 0)->v_mps[2];
    // Every step rounds.
    assert_close(fall_mps, -GRAVITY * 100.5 * STEP_s, 101.0 * 0x1p-24 * fabs(fall_mps));
    assert_int_equal(dig_world_sync(&world), DIG_OK);
    dem_grain(&world, 1)->v_mps[2] = 1.0;
    dig_world_mark_stale(&world);
    dem_run(&world, 1);
    assert_int_equal(dig_world_sync_motion(&world), DIG_OK);
    assert_close(dem_grain(&world, 0)->v_mps[2], fall_mps - GRAVITY * STEP_s, 1e-6);
    assert_close(dem_grain(&world, 1)->v_mps[2], 1.0 - GRAVITY * STEP_s, 1e-6);
    dig_world_finish(&world);
}

TEST(momentum_and_angular_momentum_are_kept)
{
    struct dig_world world = make_cloud(2, 0.5);
    double           p0[3], l0[3], p1[3], l1[3];
    sum_momenta(&world, p0, l0);
    size_t contacts = 0;
    for (int k = 0; k < 20; k++) {
        dem_run(&world, 40);
        contacts += touching(&world);
    }
    assert_true(contacts > GRAINS);
    sum_momenta(&world, p1, l1);
    for (size_t k = 0; k < 3; k++) {
        assert_close(p1[k], p0[k], 1e-13);
        assert_close(l1[k], l0[k], 1e-14);
    }
    dig_world_finish(&world);
}

TEST(collisions_take_energy_away)
{
    struct dig_world world   = make_cloud(3, 0.5);
    const double     first_J = dig_grains_kinetic_J(&world.grains);
    dem_run(&world, 4000);
    const double last_J = dig_grains_kinetic_J(&world.grains);
    assert_true(last_J < 0.5 * first_J);
    assert_true(last_J > 0.0);
    dig_world_finish(&world);
}

// Elastic and smooth, nothing is lost: what the springs hold for a while they give back.
TEST(without_damping_and_friction_energy_comes_back)
{
    struct dig_law_material smooth = dem_material(0.0, 0.0);
    smooth.restitution             = 0.999999;
    struct dig_world world         = make_cloud(4, 0.5);
    dem_set_material(&world, &smooth);
    world.dt_s           = STEP_s / 4.0;
    const double first_J = dig_grains_kinetic_J(&world.grains);
    dem_run(&world, 16000);
    assert_int_equal(touching(&world), 0);
    assert_close(dig_grains_kinetic_J(&world.grains) / first_J, 1.0, 2e-3);
    dig_world_finish(&world);
}

// Remaking the lists at every step, with all grains put in order again, changes what is summed
// first and nothing else: contacts go on remembering.
TEST(lists_can_be_remade_at_any_time)
{
    struct dig_world lazy  = make_cloud(5, 0.3);
    struct dig_world eager = make_cloud(5, 0.3);
    for (int s = 0; s < 120; s++) {
        dig_neighbours_finish(&eager.neighbours);
        dig_world_mark_stale(&eager);
        dem_run(&eager, 1);
    }
    dem_run(&lazy, 120);
    assert_true(lazy.list_rebuilds < 20);
    assert_int_equal(eager.list_rebuilds, 120);
    for (uint32_t i = 0; i < GRAINS; i++) {
        for (size_t k = 0; k < 3; k++) {
            assert_close(dem_grain(&eager, i)->x_m[k], dem_grain(&lazy, i)->x_m[k], 1e-11);
            assert_close(dem_grain(&eager, i)->w_radps[k], dem_grain(&lazy, i)->w_radps[k], 1e-5);
        }
    }
    dig_world_finish(&lazy);
    dig_world_finish(&eager);
}

TEST(a_step_that_is_too_long_is_noticed)
{
    struct dig_world world = make_cloud(6, 0.3);
    world.dt_s             = 1e-2;
    enum dig_status status = DIG_OK;
    for (int s = 0; s < 5000 && status == DIG_OK; s++) {
        status = dig_world_step(&world);
    }
    assert_int_equal(status, DIG_EINVAL);
    dig_world_finish(&world);
}

// Two grains that turn about the same axis like one body do not roll on each other: no torque, and
// the tangential slip is what gears would feel, not what rolling friction is about.
TEST(grains_that_turn_alike_do_not_roll)
{
    const double     x[2][3] = { { 0.0, 0.0, 0.0 }, { 1.99 * GRAIN_m, 0.0, 0.0 } };
    struct dig_world world   = dem_world(2, x, dem_material(0.0, 0.5));
    for (int i = 0; i < 2; i++) {
        world.grains.motion[i].w_radps[2] = 20.0;
    }
    dem_run(&world, 5);
    assert_close(dem_grain(&world, 0)->w_radps[2], 20.0, 1e-12);
    // Against each other they do, and both are slowed alike.
    dem_grain(&world, 1)->w_radps[2] = -20.0;
    dem_run(&world, 1);
    assert_true(dem_grain(&world, 0)->w_radps[2] < 19.99);
    assert_close(dem_grain(&world, 1)->w_radps[2], -dem_grain(&world, 0)->w_radps[2], 1e-12);
    dig_world_finish(&world);
}

TEST(grains_taken_out_leave_the_others_contacts_alone)
{
    // Three in a row under gravity on a wall, and one far away that is taken out.
    const double     x[4][3] = { { 0.0, 0.0, 10.0 * GRAIN_m },
                                 { 0.0, 0.0, 1.0 * GRAIN_m },
                                 { 0.0, 0.0, 3.0 * GRAIN_m },
                                 { 0.0, 0.0, 5.0 * GRAIN_m } };
    struct dig_world world   = dem_world(4, x, dem_material(0.5, 0.5));
    world.gravity_mps2[0]    = 0.5;
    world.gravity_mps2[2]    = -GRAVITY;
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    dem_run(&world, 200);
    unsigned char drop[4] = { 0 };
    double        before  = 0.0;
    for (size_t c = 0; c < world.pair[0].n; c++) {
        before += fabs(world.pair[0].history[0][c]);
    }
    for (size_t i = 0; i < 4; i++) {
        drop[i] = world.grains.id[i] == 0;
    }
    assert_int_equal(dig_world_drop(&world, drop), DIG_OK);
    assert_int_equal(world.grains.n, 3);
    dem_run(&world, 1);
    double after = 0.0;
    for (size_t c = 0; c < world.pair[0].n; c++) {
        after += fabs(world.pair[0].history[0][c]);
    }
    assert_true(before > 0.0);
    assert_close(after / before, 1.0, 0.1);
    dig_world_finish(&world);
}
