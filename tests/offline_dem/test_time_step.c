// The bounds on the time step, against collisions and spins that are stepped through.

#include "core/contact.h"
#include "tests/dem_fixture.h"

#include <math.h>

static const struct dig_law_material *law_of(const int k)
{
    static struct dig_law_material m;
    m             = dem_material(0.5, 0.3);
    m.normal_law  = k % 2 == 0 ? DIG_NORMAL_HOOKE : DIG_NORMAL_HERTZ;
    m.rolling_law = (enum dig_rolling_law)(k / 2 % 3);
    m.young_Pa    = k / 6 == 0 ? 5e6 : 1.5e8;
    m.restitution = k / 6 == 0 ? 0.9 : 0.2;
    return &m;
}

static double step_of_s(const struct dig_law_material *const m, const double radius_m,
                        const double density_kgpm3)
{
    const struct dig_material material = {
        2.0 * radius_m, m->young_Pa, m->poisson, m->restitution, m->characteristic_velocity_mps, 0.0
    };
    return dig_contact_step_s(&material, m->normal_law, density_kgpm3);
}

// Time two grains touch that meet at the characteristic velocity, found in steps far too short.
static double contact_s(const struct dig_law_material *const m)
{
    const double     x[2][3] = { { 0.0, 0.0, 0.0 }, { 2.0001 * GRAIN_m, 0.0, 0.0 } };
    struct dig_world world   = dem_world(2, x, *m);
    world.dt_s               = 1e-8;

    world.grains.motion[0].v_mps[0] = m->characteristic_velocity_mps;
    size_t steps                    = 0;
    for (bool met = false, parted = false; !parted;) {
        dem_run(&world, 1);
        const bool touch =
            dem_grain(&world, 1)->x_m[0] - dem_grain(&world, 0)->x_m[0] < 2.0 * GRAIN_m;
        parted = met && !touch;
        met    = met || touch;
        steps += touch;
    }
    dig_world_finish(&world);
    return (double)steps * 1e-8;
}

TEST(a_contact_takes_at_least_twenty_steps)
{
    for (int k = 0; k < 12; k += 5) {
        const struct dig_law_material *const m      = law_of(k);
        const double                         step_s = step_of_s(m, GRAIN_m, DENSITY);
        assert_true(step_s > 0.0);
        assert_true(contact_s(m) >= 19.5 * step_s); // damping shortens it a little
    }
}

// With e = 0.2 damping decides. A grain between eight others that are held: its spin must die out,
// and not by flipping at every step.
static double spin_after(const double step_s, const size_t steps)
{
    double x[9][3] = { { 0.0, 0.0, 0.0 } };
    for (size_t k = 0; k < 8; k++) {
        const double corner = 1.9999 * GRAIN_m / sqrt(3.0);
        x[k + 1][0]         = k & 1U ? corner : -corner;
        x[k + 1][1]         = k & 2U ? corner : -corner;
        x[k + 1][2]         = k & 4U ? corner : -corner;
    }
    struct dig_law_material m = dem_material(0.0, 0.0);
    m.friction                = 1e9; // nothing slides
    struct dig_world world    = dem_world(9, (const double(*)[3])x, m);
    world.dt_s                = step_s;
    world.grains.types        = 2;
    world.grains.type[1]      = world.grains.type[0];
    // Held by being too heavy to move.
    world.grains.type[1].mass_kg *= 1e12;
    world.grains.type[1].inertia_kgm2 *= 1e12;
    for (size_t i = 1; i < 9; i++) {
        world.grains.type_of[i] = 1;
    }
    dem_set_material(&world, &m);
    // The law is that of equal grains: heavy ones only stand for fixed ones.
    world.pair_law[1] = world.pair_law[0];
    world.started     = true; // whole kicks only

    world.grains.motion[0].w_radps[2] = 1.0;
    dem_run(&world, steps);
    const double w = dem_grain(&world, 0)->w_radps[2];
    dig_world_finish(&world);
    return w;
}

TEST(spin_dies_out_at_the_limit_and_grows_well_above)
{
    const struct dig_law_material m      = dem_material(0.5, 0.3);
    const double                  step_s = step_of_s(&m, GRAIN_m, DENSITY);
    assert_true(fabs(spin_after(step_s, 1)) < 0.2);
    assert_true(fabs(spin_after(step_s, 200)) < 0.05);
    // Among grains that are held the limit has a factor of two in hand: beyond that it is over.
    assert_true(fabs(spin_after(2.25 * step_s, 20)) > 1.0);
}

TEST(stiffer_smaller_and_lighter_grains_ask_for_shorter_steps)
{
    for (int k = 0; k < 2; k++) {
        struct dig_law_material m    = *law_of(k);
        const double            base = step_of_s(&m, GRAIN_m, DENSITY);
        assert_true(step_of_s(&m, 0.8 * GRAIN_m, DENSITY) < base);
        assert_true(step_of_s(&m, GRAIN_m, 0.6 * DENSITY) < base);
        m.young_Pa *= 30.0;
        assert_true(step_of_s(&m, GRAIN_m, DENSITY) < base);
    }
}
