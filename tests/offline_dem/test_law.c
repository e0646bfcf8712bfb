// Constants of the law, against the collisions they stand for.

#include "core/chance.h"
#include "core/contact.h"
#include "tests/dem_fixture.h"

#include <math.h>

// Hertz's sphere on a wall at the characteristic velocity, stepped through time: the linear spring
// has to hold the same energy at the overlap where it comes to rest.
TEST(the_spring_stores_what_hertz_stores)
{
    const struct dig_law_material m     = dem_material(0.5, 0.5);
    const double                  young = 5e6 / (2.0 * (1.0 - 0.04));
    double                        x = 0.0, v = 2.0;
    const double                  dt = 1e-9;
    while (v > 0.0) {
        v -= dt * 4.0 / 3.0 * young * sqrt(GRAIN_m) * pow(x, 1.5) / GRAIN_kg;
        x += dt * v;
        if (x > 1e-2) {
            break;
        }
    }
    const struct dig_law law = dig_law_wall(&m, GRAIN_m, GRAIN_kg);
    assert_close(0.5 * law.normal_Npm * x * x, 0.5 * GRAIN_kg * 4.0, 1e-3 * 0.5 * GRAIN_kg * 4.0);
}

// Of twice the density, resting under twice the load; by Hertz's spring where that bears it.
TEST(contacts_of_heavier_gravel_are_stiffer_by_the_power_that_is_said)
{
    for (int k = 0; k < 4; k++) {
        const enum dig_normal_law normal   = k % 2 == 0 ? DIG_NORMAL_HOOKE : DIG_NORMAL_HERTZ;
        struct dig_material       material = { GRAIN_m, 5e6, 0.2, 0.2, 2.0, k < 2 ? 0.0 : 2500.0 };
        double                    stiff_Npm[2];
        for (int heavy = 0; heavy < 2; heavy++) {
            const double times = heavy ? 2.0 : 1.0;
            material.young_Pa  = k < 2 ? 5e6 : times * 5e6;
            const double spring_Npm =
                dig_contact_springs(&material, normal, GRAIN_m, times * GRAIN_kg).normal_Npm;
            const double overlap_m = pow(times * GRAIN_kg * 9.81 / spring_Npm, 2.0 / 3.0);
            stiff_Npm[heavy] =
                normal == DIG_NORMAL_HOOKE ? spring_Npm : spring_Npm * sqrt(overlap_m);
        }
        assert_close(log2(stiff_Npm[1] / stiff_Npm[0]),
                     dig_contact_stiffness_power(&material, normal), 1e-9);
    }
}

TEST(two_like_grains_are_half_as_large_and_heavy_as_one_on_a_wall)
{
    const struct dig_law_material m    = dem_material(0.5, 0.4);
    const struct dig_law          pair = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
    const struct dig_law          wall = dig_law_wall(&m, 0.5 * GRAIN_m, 0.5 * GRAIN_kg);
    assert_close(pair.normal_Npm, wall.normal_Npm, 1e-9);
    assert_close(pair.damping_Nspm, wall.damping_Nspm, 1e-12);
    assert_close(pair.rolling_lever_m, 0.4 * 0.5 * GRAIN_m, 1e-15);
    assert_close(pair.reach_m, 2.0 * GRAIN_m, 1e-15);
}

// However far it slips, friction is mu |F_n|; however far it rolls, the torque is mu_r R* |F_n|.
TEST(friction_and_rolling_torque_are_capped)
{
    const struct dig_law_material m       = dem_material(0.3, 0.2);
    const struct dig_law          law     = dig_law_wall(&m, GRAIN_m, GRAIN_kg);
    struct dig_contact_history    history = { 0 };
    const struct dig_kinematics   t       = { .dz_m     = 0.99 * GRAIN_m,
                                              .vx_mps   = 0.4,
                                              .vy_mps   = -0.3,
                                              .ix_radps = 30.0,
                                              .iy_radps = 40.0,
                                              .iz_radps = 99.0 };
    struct dig_contact_force      push    = { 0 };
    for (int k = 0; k < 500; k++) {
        push = dig_law_step(law, STEP_s, t, &history);
    }
    assert_true(push.fz_N > 0.0);
    assert_close(hypot(push.fx_N, push.fy_N), 0.3 * push.fz_N, 1e-12);
    assert_close(hypot(history.mx_Nm, history.my_Nm), 0.2 * GRAIN_m * push.fz_N, 1e-15);
    assert_close(history.mz_Nm, 0.0, 0.0); // spin about the normal is free
    assert_close(history.sz_m, 0.0, 1e-20);
}

// Turning the whole picture turns the answer.
TEST(the_law_knows_no_direction)
{
    const struct dig_law_material m   = dem_material(0.4, 0.4);
    const struct dig_law          law = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
    struct dig_contact_history    a   = { 1e-6, -2e-6, 5e-7, 1e-6, 2e-6, -3e-6 };
    // x -> y -> z -> x
    struct dig_contact_history     b = { a.sz_m, a.sx_m, a.sy_m, a.mz_Nm, a.mx_Nm, a.my_Nm };
    const double                   d = 1.98 * GRAIN_m / sqrt(14.0);
    const struct dig_kinematics    s = { d, 2 * d, 3 * d, 0.1, -0.2, 0.05, 3, 5, -7, -2, 8, 1 };
    const struct dig_kinematics    t = { 3 * d, d, 2 * d, 0.05, 0.1, -0.2, -7, 3, 5, 1, -2, 8 };
    const struct dig_contact_force p = dig_law_step(law, STEP_s, s, &a);
    const struct dig_contact_force q = dig_law_step(law, STEP_s, t, &b);
    assert_close(q.fy_N, p.fx_N, 1e-14);
    assert_close(q.fz_N, p.fy_N, 1e-14);
    assert_close(q.fx_N, p.fz_N, 1e-14);
    assert_close(q.iy_Nm, p.ix_Nm, 1e-16);
    assert_close(q.jz_Nm, p.jy_Nm, 1e-16);
    assert_close(b.sy_m, a.sx_m, 1e-18);
}

// Contacts of every depth, speed and history: in single precision each force errs by some parts in
// 2^24 of what is added up in it. A dozen roundings follow each other in a term.
TEST(single_precision_errs_by_its_roundings)
{
    const double                  eps     = 0x1p-24;
    const struct dig_law_material m       = dem_material(0.3, 0.2);
    const struct dig_law          law     = dig_law_pair(&m, GRAIN_m, GRAIN_m, GRAIN_kg, GRAIN_kg);
    const struct dig_law_single   rough   = dig_law_to_single(&law);
    uint64_t                      random  = 7;
    size_t                        sliding = 0;
    for (int k = 0; k < 20000; k++) {
        const double deep  = GRAIN_m * pow(10.0, dig_chance_between(&random, -7.0, -1.0));
        const double speed = pow(10.0, dig_chance_between(&random, -6.0, 0.0));
        const double spring =
            law.friction * deep * pow(10.0, dig_chance_between(&random, -2.0, 1.0));
        const double torque = law.rolling_lever_m * law.normal_Npm * deep;
        double       n[3];
        double       r[15];
        double       n2 = 0.0;
        for (int a = 0; a < 3; a++) {
            n[a] = dig_chance_between(&random, -1.0, 1.0);
            n2 += n[a] * n[a];
        }
        for (int a = 0; a < 15; a++) {
            r[a] = dig_chance_between(&random, -1.0, 1.0);
        }
        const double                d_m = (law.reach_m - deep) / sqrt(n2);
        const struct dig_kinematics t   = { d_m * n[0],   d_m * n[1],   d_m * n[2], speed * r[0],
                                            speed * r[1], speed * r[2], r[3],       r[4],
                                            r[5],         r[6],         r[7],       r[8] };
        struct dig_contact_history  h   = { spring * r[9],  spring * r[10], spring * r[11],
                                            torque * r[12], torque * r[13], torque * r[14] };
        struct dig_contact_history_single      hs = { (float)h.sx_m,  (float)h.sy_m,  (float)h.sz_m,
                                                      (float)h.mx_Nm, (float)h.my_Nm, (float)h.mz_Nm };
        const struct dig_contact_motion_single ts = { (float)t.vx_mps,   (float)t.vy_mps,
                                                      (float)t.vz_mps,   (float)t.ix_radps,
                                                      (float)t.iy_radps, (float)t.iz_radps,
                                                      (float)t.jx_radps, (float)t.jy_radps,
                                                      (float)t.jz_radps };
        const struct dig_contact_force         p  = dig_law_step(law, STEP_s, t, &h);
        const struct dig_contact_force_single  q  = dig_law_force_single(
              rough, (float)STEP_s, dig_law_normal_single(law.reach_m, t.dx_m, t.dy_m, t.dz_m), ts,
              &hs);

        // Springs and dampings that are added, and the torque's two parts.
        const double slip = speed + 2.0 * GRAIN_m;
        const double N =
            law.normal_Npm * (deep + spring + slip * STEP_s) + law.damping_Nspm * 2.0 * slip;
        const double Nm = N * GRAIN_m + torque + law.rolling_Nmprad * STEP_s * 4.0;
        assert_close(q.fx_N, p.fx_N, 24.0 * eps * N);
        assert_close(q.fy_N, p.fy_N, 24.0 * eps * N);
        assert_close(q.fz_N, p.fz_N, 24.0 * eps * N);
        assert_close(q.ix_Nm, p.ix_Nm, 24.0 * eps * Nm);
        assert_close(q.jz_Nm, p.jz_Nm, 24.0 * eps * Nm);
        assert_close(hs.sx_m, h.sx_m, 24.0 * eps * N / law.normal_Npm);
        sliding += spring > law.friction * deep;
    }
    assert_in_range(sliding, 4000, 16000);
}
