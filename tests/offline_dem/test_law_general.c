// Hertz, CDT, SJKR and unlike grains against closed forms and against the plain law.

#include "offline_dem/law/law_general.h"
#include "tests/dem_fixture.h"

#include <math.h>

#define FINE_s   2e-6
#define STIFF_Pa 1e8

// Effective modulus of the stiff gravel, and of a pair: Hertz (Johnson, Contact Mechanics, 4.24).
static double effective_Pa(const double young_Pa)
{
    return 1.0 / (2.0 * (1.0 - 0.2 * 0.2) / young_Pa);
}

static struct dig_law_material stiff(const enum dig_normal_law  normal,
                                     const enum dig_rolling_law rolling)
{
    struct dig_law_material m = dem_material(0.5, 0.0);
    m.young_Pa                = STIFF_Pa;
    m.normal_law              = normal;
    m.rolling_law             = rolling;
    return m;
}

// Two grains of which the second has its own radius and density; not yet a law between them.
static struct dig_world two(const double distance_m, const double large_m, const double dense)
{
    const double     x[2][3] = { { 0.0, 0.0, 0.0 }, { distance_m, 0.0, 0.0 } };
    struct dig_world world   = dem_world(2, x, dem_material(0.5, 0.5));
    world.grains.types       = 2;
    world.grains.type[1]     = dem_sphere(large_m, dense);
    world.grains.type_of[1]  = 1;
    world.dt_s               = FINE_s;
    return world;
}

// Runs until the grains have met and parted. Deepest overlap and time of contact.
static void collide(struct dig_world *const world, double *const deepest_m, double *const contact_s)
{
    const double reach_m = world->grains.type[0].radius_m + world->grains.type[1].radius_m;
    size_t       steps   = 0;
    *deepest_m           = 0.0;
    for (size_t s = 0; s < 20000; s++) {
        dem_run(world, 1);
        const double overlap_m =
            reach_m - (dem_grain(world, 1)->x_m[0] - dem_grain(world, 0)->x_m[0]);
        *deepest_m = fmax(*deepest_m, overlap_m);
        steps += overlap_m > 0.0;
    }
    *contact_s = (double)steps * world->dt_s;
}

// Hertz (Timoshenko & Goodier, Theory of Elasticity, art. 141): depth from the energy, and 2.9432
// depths over the speed.
TEST(hertz_spheres_go_as_deep_and_stay_as_long_as_hertz_found)
{
    const double            large_m[] = { GRAIN_m, 2.0 * GRAIN_m };
    const double            speed[]   = { 0.1, 0.8 };
    struct dig_law_material m         = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2);
    m.restitution                     = 1.0;
    for (size_t k = 0; k < 4; k++) {
        const double     rj    = large_m[k / 2];
        const double     v     = speed[k % 2];
        struct dig_world world = two(1.001 * (GRAIN_m + rj), rj, 4000.0);
        dem_set_material(&world, &m);
        world.grains.motion[0].v_mps[0] = v;
        const double mi                 = world.grains.type[0].mass_kg;
        const double mj                 = world.grains.type[1].mass_kg;
        double       deepest_m;
        double       contact_s;
        collide(&world, &deepest_m, &contact_s);
        const double radius_m = 1.0 / (1.0 / GRAIN_m + 1.0 / rj);
        const double mass_kg  = 1.0 / (1.0 / mi + 1.0 / mj);
        const double deep_m =
            pow(15.0 * mass_kg * v * v / (16.0 * effective_Pa(STIFF_Pa) * sqrt(radius_m)), 0.4);
        assert_close(deepest_m, deep_m, 2e-3 * deep_m);
        assert_close(contact_s, 2.9432 * deep_m / v, 0.01 * 2.9432 * deep_m / v + 2.0 * FINE_s);
        // Elastic: the exchange of speeds of unlike masses.
        assert_close(dem_grain(&world, 0)->v_mps[0], v * (mi - mj) / (mi + mj), 2e-3 * v);
        assert_close(dem_grain(&world, 1)->v_mps[0], v * 2.0 * mi / (mi + mj), 2e-3 * v);
        dig_world_finish(&world);
    }
}

// The damping is made so that e does not depend on the speed, nor on who is how large.
TEST(hertz_spheres_part_with_their_restitution_at_any_speed)
{
    const double e[]     = { 0.2, 0.5, 0.9 };
    const double speed[] = { 0.2, 1.5 };
    for (size_t k = 0; k < 6; k++) {
        struct dig_law_material m = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2);
        m.restitution             = e[k / 2];
        struct dig_world world    = two(2.6 * GRAIN_m, 1.5 * GRAIN_m, 1500.0);
        dem_set_material(&world, &m);
        world.grains.motion[0].v_mps[0] = speed[k % 2];
        double deepest_m;
        double contact_s;
        collide(&world, &deepest_m, &contact_s);
        assert_true(contact_s > 20.0 * FINE_s);
        const double apart = dem_grain(&world, 1)->v_mps[0] - dem_grain(&world, 0)->v_mps[0];
        assert_close(apart / speed[k % 2], e[k / 2], 0.01);
        dig_world_finish(&world);
    }
}

// Mindlin: without slip the contact of two spheres is 2 (1 - nu) / (2 - nu) times as stiff
// sideways as it is head-on, at the same overlap.
TEST(mindlin_is_softer_sideways_by_poissons_ratio)
{
    const struct dig_law_material  m       = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2);
    const struct dig_law           law     = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
    const double                   d_m     = 1.99 * GRAIN_m;
    const double                   h_m     = 1e-9;
    struct dig_contact_history     history = { 0 };
    struct dig_kinematics          t       = { .dx_m = d_m };
    const struct dig_contact_force at      = dig_law_general(law, FINE_s, t, &history);
    t.dx_m                                 = d_m - h_m;
    const struct dig_contact_force deeper  = dig_law_general(law, FINE_s, t, &history);
    history                                = (struct dig_contact_history){ .sy_m = h_m };
    t.dx_m                                 = d_m;
    const struct dig_contact_force aside   = dig_law_general(law, FINE_s, t, &history);
    const double                   head_on = (deeper.fx_N - at.fx_N) / h_m;
    const double                   sideways = -aside.fy_N / h_m;
    assert_close(sideways / head_on, 2.0 * (1.0 - 0.2) / (2.0 - 0.2), 1e-4);
}

static struct dig_world on_floor(const struct dig_law_material *const m, const double slope)
{
    const double     x[1][3] = { { 0.0, 0.0, GRAIN_m - 1e-7 } };
    struct dig_world world   = dem_world(1, x, *m);
    world.dt_s               = FINE_s;
    dem_add_slope(&world, slope);
    return world;
}

// Rolling without slip under a torque mu_r r N: v0^2 / (2 x 5/7 mu_r g), and there it stays.
TEST(cdt_stops_a_rolling_grain_where_mechanics_says)
{
    const enum dig_normal_law normal[] = { DIG_NORMAL_HOOKE, DIG_NORMAL_HERTZ };
    for (size_t k = 0; k < 2; k++) {
        struct dig_law_material m         = stiff(normal[k], DIG_ROLLING_CDT);
        m.rolling                         = 0.2;
        struct dig_world world            = on_floor(&m, 0.0);
        const double     v                = 0.2;
        world.grains.motion[0].v_mps[0]   = v;
        world.grains.motion[0].w_radps[1] = v / GRAIN_m;
        dem_run_for(&world, 1.5 * v / (5.0 / 7.0 * 0.2 * GRAVITY));
        const double stop_m = v * v / (2.0 * 5.0 / 7.0 * 0.2 * GRAVITY);
        assert_close(world.grains.motion[0].x_m[0], stop_m, 0.01 * stop_m);
        dem_run_for(&world, 0.05);
        assert_close(world.grains.motion[0].x_m[0], stop_m, 0.01 * stop_m);
        dig_world_finish(&world);
    }
}

static double acceleration(const struct dig_law_material *const m, const double slope)
{
    struct dig_world world = on_floor(m, slope);
    dem_run_for(&world, 0.03);
    const double before_mps = world.grains.motion[0].v_mps[0];
    dem_run_for(&world, 0.02);
    const double a = (world.grains.motion[0].v_mps[0] - before_mps) / 0.02;
    dig_world_finish(&world);
    return a;
}

TEST(under_hertz_and_cdt_a_grain_starts_to_roll_and_to_slip_where_it_should)
{
    struct dig_law_material m = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_CDT);
    m.rolling                 = 0.2;
    assert_close(acceleration(&m, atan(0.2) - 0.03), 0.0, 0.03);
    const double rolls = atan(0.2) + 0.1;
    const double roll  = 5.0 / 7.0 * GRAVITY * (sin(rolls) - 0.2 * cos(rolls));
    assert_close(acceleration(&m, rolls), roll, 0.02 * roll);
    // Too much rolling friction to roll: it slides, above the angle of friction.
    m.rolling = 5.0;
    assert_close(acceleration(&m, atan(0.5) - 0.03), 0.0, 0.03);
    const double slides = atan(0.5) + 0.1;
    const double slide  = GRAVITY * (sin(slides) - 0.5 * cos(slides));
    assert_close(acceleration(&m, slides), slide, 0.02 * slide);
}

TEST(without_rolling_friction_a_grain_spins_on)
{
    struct dig_law_material m         = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_NONE);
    m.friction                        = 0.0;
    m.rolling                         = 0.9;
    struct dig_world world            = on_floor(&m, 0.0);
    world.grains.motion[0].w_radps[1] = 40.0;
    dem_run_for(&world, 0.02);
    assert_close(world.grains.motion[0].w_radps[1], 40.0, 1e-9);
    dig_world_finish(&world);
}

// The radius of the circle two spheres share, from the triangle of centres and rim: its height over
// the line of centres, by Heron.
static double shared_circle_m(const double a, const double b, const double d)
{
    const double s = 0.5 * (a + b + d);
    return 2.0 * sqrt(s * (s - a) * (s - b) * (s - d)) / d;
}

#define PULL_Jpm3 5e5

// Two grains that touch draw together until Hertz' push balances the pull.
TEST(glued_grains_rest_where_push_and_pull_balance)
{
    struct dig_law_material m = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2);
    m.cohesion_Jpm3           = PULL_Jpm3;
    const double     rj       = 1.5 * GRAIN_m;
    struct dig_world world    = two((GRAIN_m + rj) * (1.0 - 1e-6), rj, DENSITY);
    dem_set_material(&world, &m);
    dem_run_for(&world, 0.05);
    const double apart_m   = dem_grain(&world, 1)->x_m[0] - dem_grain(&world, 0)->x_m[0];
    const double overlap_m = GRAIN_m + rj - apart_m;
    const double circle_m  = shared_circle_m(GRAIN_m, rj, apart_m);
    const double radius_m  = 1.0 / (1.0 / GRAIN_m + 1.0 / rj);
    const double push_N = 4.0 / 3.0 * effective_Pa(STIFF_Pa) * sqrt(radius_m) * pow(overlap_m, 1.5);
    assert_true(overlap_m > 1e-4 * GRAIN_m);
    assert_close(PULL_Jpm3 * DIG_PI * circle_m * circle_m, push_N, 1e-3 * push_N);
    dig_world_finish(&world);
}

// A grain under a ceiling: the load grows to its full size in 0.03 s and stays for 0.07.
static bool hangs(const struct dig_law_material *const m, const double load_N)
{
    const double     x[1][3] = { { 0.0, 0.0, -GRAIN_m * (1.0 - 1e-4) } };
    struct dig_world world   = dem_world(1, x, *m);
    world.dt_s               = FINE_s;
    dem_add_wall(&world, 0.0, 0.0, -1.0, 0.0);
    dem_run_for(&world, 0.02); // to its balance
    for (size_t s = 0; s < 50000; s++) {
        world.gravity_mps2[2] = -fmin(1.0, (double)s / 15000.0) * load_N / GRAIN_kg;
        dem_run(&world, 1);
    }
    const bool does = world.grains.motion[0].x_m[2] > -GRAIN_m;
    dig_world_finish(&world);
    return does;
}

TEST(a_glued_grain_is_torn_off_by_the_largest_pull)
{
    struct dig_law_material m = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2);
    m.cohesion_Jpm3           = PULL_Jpm3;
    double most_N             = 0.0;
    for (double overlap_m = 0.0; overlap_m < 0.05 * GRAIN_m; overlap_m += 1e-5 * GRAIN_m) {
        const double height_m = GRAIN_m - overlap_m;
        const double pull_N =
            PULL_Jpm3 * DIG_PI * (GRAIN_m * GRAIN_m - height_m * height_m) -
            4.0 / 3.0 * effective_Pa(STIFF_Pa) * sqrt(GRAIN_m) * pow(overlap_m, 1.5);
        most_N = fmax(most_N, pull_N);
    }
    assert_true(most_N > 2.0 * GRAIN_kg * GRAVITY);
    assert_true(hangs(&m, 0.98 * most_N));
    assert_false(hangs(&m, 1.02 * most_N));
}

// Unlike grains under all laws at once, off-centre and spinning.
TEST(momentum_and_angular_momentum_are_kept_by_unlike_grains)
{
    struct dig_law_material m = stiff(DIG_NORMAL_HERTZ, DIG_ROLLING_CDT);
    m.rolling                 = 0.4;
    m.cohesion_Jpm3           = PULL_Jpm3;
    struct dig_world world    = two(2.7 * GRAIN_m, 1.6 * GRAIN_m, 4000.0);
    dem_set_material(&world, &m);
    struct dig_motion *const motion = world.grains.motion;
    motion[0].x_m[1]                = 0.8 * GRAIN_m;
    motion[0].v_mps[0]              = 0.7;
    motion[0].v_mps[2]              = 0.1;
    motion[0].w_radps[1]            = 60.0;
    motion[1].w_radps[0]            = -90.0;
    double sum[2][6];
    for (size_t k = 0; k < 2; k++) {
        memset(sum[k], 0, sizeof sum[k]);
        for (uint32_t i = 0; i < 2; i++) {
            const struct dig_motion *const b    = dem_grain(&world, i);
            const struct dig_grain_type    type = world.grains.type[i];
            for (size_t a = 0; a < 3; a++) {
                const size_t n = (a + 1) % 3;
                const size_t o = (a + 2) % 3;
                sum[k][a] += type.mass_kg * b->v_mps[a];
                sum[k][3 + a] +=
                    type.mass_kg * (b->x_m[n] * b->v_mps[o] - b->x_m[o] * b->v_mps[n]) +
                    type.inertia_kgm2 * b->w_radps[a];
            }
        }
        dem_run_for(&world, 4e-3);
    }
    const double p = GRAIN_kg * 0.7;
    for (size_t a = 0; a < 3; a++) {
        assert_close(sum[1][a], sum[0][a], 1e-12 * p);
        // Torques act where positions stood, momenta count where they stand: a step's difference.
        assert_close(sum[1][3 + a], sum[0][3 + a], 1e-3 * p * GRAIN_m);
    }
    assert_true(fabs(dem_grain(&world, 0)->v_mps[0] - 0.7) > 0.1); // they did meet
    dig_world_finish(&world);
}

TEST(the_plain_choice_stays_with_the_plain_law)
{
    const struct dig_law_material m   = dem_material(0.5, 0.4);
    struct dig_law                law = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
    assert_false(law.general);
    struct dig_contact_history a = { 1e-6, -2e-6, 5e-7, 1e-6, 2e-6, -3e-6 };
    struct dig_contact_history b = a;
    for (int k = 0; k < 200; k++) {
        const double                   d = (1.98 + 1e-4 * k) * GRAIN_m / sqrt(14.0);
        const struct dig_kinematics    t = { d, 2 * d, 3 * d, 0.1, -0.2, 0.05, 3, 5, -7, -2, 8, 1 };
        const struct dig_contact_force p = dig_law_step(law, STEP_s, t, &a);
        const struct dig_contact_force q = dig_law_general(law, STEP_s, t, &b);
        assert_close(q.fx_N, p.fx_N, 1e-14);
        assert_close(q.fz_N, p.fz_N, 1e-14);
        assert_close(q.iy_Nm, p.iy_Nm, 1e-16);
        assert_close(q.jz_Nm, p.jz_Nm, 1e-16);
    }
}

// Whatever is chosen, bodies that do not touch feel and remember nothing; nor under the plain law.
TEST(no_touch_is_no_force_and_no_memory_under_any_law)
{
    for (int k = -1; k < 12; k++) {
        struct dig_law_material m          = dem_material(0.5, 0.5);
        m.normal_law                       = k % 2 == 0 ? DIG_NORMAL_HOOKE : DIG_NORMAL_HERTZ;
        m.rolling_law                      = (enum dig_rolling_law)(k / 2 % 3);
        m.cohesion_Jpm3                    = k < 6 ? 0.0 : 1e6;
        const struct dig_law           law = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
        struct dig_contact_history     kept    = { 1e-6, 2e-6, 3e-6, 1e-5, 2e-5, 3e-5 };
        const struct dig_kinematics    apart   = { .dx_m     = 2.0001 * GRAIN_m,
                                                   .vx_mps   = -1.0,
                                                   .iy_radps = 5 };
        const struct dig_contact_force push    = k < 0 ? dig_law_step(law, STEP_s, apart, &kept)
                                                       : dig_law_general(law, STEP_s, apart, &kept);
        const struct dig_contact_force none    = { 0 };
        const struct dig_contact_history blank = { 0 };
        assert_memory_equal(&push, &none, sizeof push);
        assert_memory_equal(&kept, &blank, sizeof kept);
    }
}

#define HEAP 60

// A heap of cohesive grains falls on a floor under every processor's variant of the loops.
TEST(every_variant_gives_the_same_bits_under_general_laws)
{
    double x[HEAP][3];
    for (size_t i = 0; i < HEAP; i++) {
        x[i][0] = 2.02 * GRAIN_m * (double)(i % 4) + 1e-4 * (double)(i % 7);
        x[i][1] = 2.02 * GRAIN_m * (double)(i / 4 % 4) + 1e-4 * (double)(i % 5);
        x[i][2] = 2.05 * GRAIN_m * (double)(i / 16) + 1.1 * GRAIN_m;
    }
    struct dig_law_material m = dem_material(0.5, 0.3);
    m.normal_law              = DIG_NORMAL_HERTZ;
    m.rolling_law             = DIG_ROLLING_CDT;
    m.cohesion_Jpm3           = 1e5;
    double then[HEAP][3]      = { { 0.0 } };
    for (int isa = 0; isa <= (int)dig_kernel_best(); isa++) {
        struct dig_world world = dem_world(HEAP, (const double(*)[3])x, m);
        world.isa              = (enum dig_isa)isa;
        world.gravity_mps2[2]  = -GRAVITY;
        dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
        dem_run(&world, 1500);
        for (uint32_t i = 0; i < HEAP; i++) {
            const double *const at_m = dem_grain(&world, i)->x_m;
            if (isa == 0) {
                memcpy(then[i], at_m, sizeof then[i]);
            }
            assert_memory_equal(at_m, then[i], sizeof then[i]);
        }
        dig_world_finish(&world);
    }
}
