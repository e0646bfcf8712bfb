// Tests for estimator/wrench/dynamics.c. The oracle is Lagrange's equation.

#include "estimator/wrench/dynamics.h"

#include "tests/estimator/lagrange.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

TEST(moments_are_those_of_lagrange)
{
    const struct dig_machine m    = model_machine();
    uint64_t                 seed = 4;
    for (int i = 0; i < 200; i++) {
        struct lagrange_state s;
        struct dig_rates      rates = { .velocity_sigma = 0.0 };
        for (int j = 0; j < DIG_JOINTS; j++) {
            s.q[j] =
                m.link[j].min_rad + (m.link[j].max_rad - m.link[j].min_rad) * model_uniform(&seed);
            s.v[j]                       = model_normal(&seed);
            rates.velocity_radps[j]      = s.v[j];
            rates.acceleration_radps2[j] = 2.0 * model_normal(&seed);
        }
        const double           pitch_rad = 0.1 * model_normal(&seed);
        const struct dig_front front     = dig_front_place(&m, s.q);
        double                 found[DIG_JOINTS];
        dig_dynamics_Nm(&m, &front, &rates, pitch_rad, found);
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double truth =
                -lagrange_needed_Nm(&m, &s, rates.acceleration_radps2, j, pitch_rad);
            assert_close(found[j], truth, 1e-4 * fabs(truth) + 2.0);
        }
    }
}

TEST(standing_still_it_is_the_weight)
{
    const struct dig_machine m             = model_machine();
    const double             q[DIG_JOINTS] = { 0.4, -1.4, -0.6 };
    const struct dig_front   front         = dig_front_place(&m, q);
    const struct dig_rates   still         = { .velocity_sigma = 0.0 };
    double                   moving[DIG_JOINTS], weight[DIG_JOINTS];
    dig_dynamics_Nm(&m, &front, &still, 0.05, moving);
    dig_statics_weight_Nm(&m, &front, 0.05, weight);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(moving[j], weight[j], 1e-9 * fabs(weight[j]));
    }
}

TEST(the_inertia_is_symmetric_and_adds_up)
{
    const struct dig_machine m             = model_machine();
    const double             q[DIG_JOINTS] = { 0.2, -1.1, -0.9 };
    const struct dig_front   front         = dig_front_place(&m, q);
    double                   by[DIG_JOINTS][DIG_JOINTS];
    dig_dynamics_inertia_kgm2(&m, &front, by);
    struct dig_rates still = { .velocity_sigma = 0.0 }, turning = still;
    turning.acceleration_radps2[DIG_JOINT_ARM] = 3.0;
    double rest[DIG_JOINTS], moved[DIG_JOINTS];
    dig_dynamics_Nm(&m, &front, &still, 0.0, rest);
    dig_dynamics_Nm(&m, &front, &turning, 0.0, moved);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_true(by[j][j] > 0.0);
        assert_close(rest[j] - moved[j], 3.0 * by[j][DIG_JOINT_ARM], 1e-6 * by[0][0]);
        for (int k = 0; k < DIG_JOINTS; k++) {
            assert_close(by[j][k], by[k][j], 1e-9 * by[0][0]);
        }
    }
}
