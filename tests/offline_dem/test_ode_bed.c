// What contacts of the all-ODE reference remember, and what it refuses. That its grains move as the
// kernel's: test_engine_ode.c.

#include "offline_dem/reference/ode_bed.h"
#include "offline_dem/reference/ode_history.h"
#include "offline_dem/world/bodies.h"
#include "tests/dem_fixture.h"

TEST(contacts_remember_until_they_end)
{
    struct dig_ode_history map = { 0 };
    assert_null(dig_ode_history_previous(&map, 1, 2));
    // More than the first table holds.
    for (uint32_t a = 0; a < 5000; a++) {
        struct dig_contact_history *const m = dig_ode_history_of(&map, a, a + 1);
        assert_non_null(m);
        assert_close(m->sx_m, 0.0, 0.0);
        m->sx_m = (double)a + 1.0;
    }
    dig_ode_history_end_step(&map);
    for (uint32_t a = 0; a < 5000; a += 2) {
        assert_close(dig_ode_history_of(&map, a, a + 1)->sx_m, (double)a + 1.0, 0.0);
    }
    assert_null(dig_ode_history_previous(&map, 2, 1)); // who touches whom is told apart
    dig_ode_history_end_step(&map);
    assert_close(dig_ode_history_of(&map, 4, 5)->sx_m, 5.0, 0.0);
    assert_close(dig_ode_history_of(&map, 5, 6)->sx_m, 0.0, 0.0); // not touched in between
    dig_ode_history_finish(&map);
}

TEST(a_world_with_clumps_is_refused)
{
    const double      x[1][3] = { { 0.0, 0.0, 0.0 } };
    struct dig_world  world   = dem_world(1, x, dem_material(0.5, 0.5));
    struct dig_bodies bodies  = { .clumps = 1 };
    world.bodies              = &bodies;
    assert_int_equal(dig_ode_bed_take_over(&world), DIG_EINVAL);
    assert_null(world.stand_in);
    world.bodies = NULL;
    dig_world_finish(&world);
}
