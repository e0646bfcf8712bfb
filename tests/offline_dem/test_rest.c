// Grains held still: what is held, what lets go, and that nothing else changes.

#include "tests/dem_fixture.h"

#include <math.h>

// Side by side on a floor, a little apart.
static struct dig_world on_floor(const size_t n, const double freeze)
{
    double           x[3][3] = { { 0.0, 0.0, 0.999 * GRAIN_m },
                                 { 3.0 * GRAIN_m, 0.0, 0.999 * GRAIN_m },
                                 { 6.0 * GRAIN_m, 0.0, 0.999 * GRAIN_m } };
    struct dig_world world   = dem_world(n, (const double(*)[3])x, dem_material(0.5, 0.5));
    world.gravity_mps2[2]    = -GRAVITY;
    world.freeze             = freeze;
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    return world;
}

static void a_grain_at_rest_is_held_and_keeps_its_bits(void **state)
{
    (void)state;
    struct dig_world world = on_floor(2, 0.1);
    // A little sideways: the contact with the floor has something to remember.
    world.grains.motion[0].v_mps[0] = 0.002;
    dem_run(&world, 4000);
    assert_int_equal(world.rest.awakes, 0);
    assert_int_equal(world.held_surface[0].n, 2);
    struct dig_motion before[2];
    double            memory[2];
    memcpy(before, world.grains.motion, sizeof before);
    memcpy(memory, world.held_surface[0].memory[0], sizeof memory);
    assert_true(fabs(memory[0]) + fabs(memory[1]) > 0.0);
    dem_run(&world, 1000);
    assert_memory_equal(world.grains.motion, before, sizeof before);
    assert_memory_equal(world.held_surface[0].memory[0], memory, sizeof memory);
    for (size_t i = 0; i < 2; i++) {
        for (size_t k = 0; k < 3; k++) {
            assert_close(before[i].v_mps[k], 0.0, 0.0);
            assert_close(before[i].w_radps[k], 0.0, 0.0);
        }
    }
    dig_world_finish(&world);
}

static void without_leave_none_is_held(void **state)
{
    (void)state;
    struct dig_world world = on_floor(2, 0.0);
    dem_run(&world, 4000);
    assert_null(world.rest.grain);
    assert_int_equal(world.held_surface[0].n, 0);
    dig_world_finish(&world);
}

// Gravity that leans beyond what friction and rolling friction bear: each look finds forces that do
// not cancel.
static void what_is_pushed_is_let_go(void **state)
{
    (void)state;
    struct dig_world world = on_floor(1, 0.1);
    dem_run(&world, 4000);
    assert_int_equal(world.rest.awakes, 0);
    const double from_m   = world.grains.motion[0].x_m[0];
    world.gravity_mps2[0] = GRAVITY;
    dem_run(&world, 800);
    assert_int_equal(world.rest.awakes, 1);
    // Slides: half (g - mu g) t^2, less what passed until the look.
    assert_in_range((long)((world.grains.motion[0].x_m[0] - from_m) * 1e6), 4000, 7000);
    dig_world_finish(&world);
}

// Held grains stay held, and their contacts with them, when another is taken out.
static void a_grain_taken_out_leaves_the_others_held(void **state)
{
    (void)state;
    struct dig_world world = on_floor(3, 0.1);
    dem_run(&world, 4000);
    assert_int_equal(world.rest.awakes, 0);
    unsigned char drop[3] = { 0 };
    for (size_t i = 0; i < 3; i++) {
        drop[i] = world.grains.name[i] == 1;
    }
    assert_int_equal(dig_world_drop(&world, drop), DIG_OK);
    dem_run(&world, 1);
    assert_int_equal(world.rest.awakes, 0);
    assert_int_equal(world.held_surface[0].n, 2);
    dig_world_finish(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grain_at_rest_is_held_and_keeps_its_bits),
        cmocka_unit_test(without_leave_none_is_held),
        cmocka_unit_test(what_is_pushed_is_let_go),
        cmocka_unit_test(a_grain_taken_out_leaves_the_others_held),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
