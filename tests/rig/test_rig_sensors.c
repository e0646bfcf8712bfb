// Tests for tools/rig/sensors.c

#include "tools/rig/sensors.h"

#include "tests/testlib.h"

#include <string.h>

static const struct dig_machine machine = {
    .cylinder         = { { .pressure_sigma_Pa = 5e4 },
                          { .pressure_sigma_Pa = 2e4 },
                          { .pressure_sigma_Pa = 1e4 } },
    .pressure_step_Pa = 2e5,
    .angle_step_rad   = 4e-4,
    .angle_sigma_rad  = 2e-4,
};

static const struct dig_rig_row row = {
    .joints    = { .rad = { 0.2, -1.0, -0.5 } },
    .pressures = { .head_Pa = { 8e6, 1e6, 1.1e6 }, .rod_Pa = { 1e6, 4.2e6, 2.2e6 } },
};

TEST(without_noise_the_sensors_read_the_truth)
{
    const struct dig_sample sample = dig_rig_sense(&machine, &row, 5000000, NULL);
    assert_int_equal(sample.time_ns, 5000000);
    assert_true(dig_sample_is_complete(&sample));
    const double expected[DIG_SIGNALS] = { 0.2,   -1.0,  -0.5,  8e6, 1e6, 1e6,
                                           4.2e6, 1.1e6, 2.2e6, 0.0, 45.0 };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        assert_close(sample.value[s], expected[s], 0.0);
    }
}

// Mean and deviation of 20000 readings; the bands are five standard errors.
TEST(noise_has_the_machine_s_sigmas_and_no_bias)
{
    enum { N = 20000 };
    struct dig_rig_noise    noise           = dig_rig_noise_init(7);
    const struct dig_sample truth           = dig_rig_sense(&machine, &row, 0, NULL);
    const double sigma[DIG_SIGNALS_NEEDED]  = { 2e-4, 2e-4, 2e-4, 5e4, 5e4, 2e4, 2e4, 1e4, 1e4 };
    double       sum[DIG_SIGNALS_NEEDED]    = { 0.0 };
    double       square[DIG_SIGNALS_NEEDED] = { 0.0 };
    double       product = 0.0; // of two signals, to see that they are independent
    for (int i = 0; i < N; i++) {
        const struct dig_sample sample = dig_rig_sense(&machine, &row, 0, &noise);
        double                  z[DIG_SIGNALS_NEEDED];
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            z[s] = (sample.value[s] - truth.value[s]) / sigma[s];
            sum[s] += z[s];
            square[s] += z[s] * z[s];
        }
        product += z[DIG_SIGNAL_BOOM_HEAD_Pa] * z[DIG_SIGNAL_BOOM_ROD_Pa];
    }
    for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
        assert_close(sum[s] / N, 0.0, 5.0 / sqrt((double)N));
        assert_close(square[s] / N, 1.0, 5.0 * sqrt(2.0 / N));
    }
    assert_close(product / N, 0.0, 5.0 / sqrt((double)N));
}

TEST(one_seed_is_one_stream)
{
    struct dig_rig_noise a    = dig_rig_noise_init(3);
    struct dig_rig_noise b    = dig_rig_noise_init(3);
    struct dig_rig_noise c    = dig_rig_noise_init(4);
    int                  same = 0;
    for (int i = 0; i < 100; i++) {
        const double x = dig_rig_noise_normal(&a);
        assert_close(dig_rig_noise_normal(&b), x, 0.0);
        same += fabs(dig_rig_noise_normal(&c) - x) < 1e-12 ? 1 : 0;
    }
    assert_int_equal(same, 0);
}

TEST(quantised_values_are_whole_steps_half_a_step_off_at_most)
{
    struct dig_rig_noise noise = dig_rig_noise_init(1);
    for (int i = 0; i < 1000; i++) {
        const struct dig_sample exact  = dig_rig_sense(&machine, &row, 0, &noise);
        struct dig_sample       sample = exact;
        dig_rig_quantise(&machine, &sample);
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            const double step  = s < DIG_SIGNAL_BOOM_HEAD_Pa ? 4e-4 : 2e5;
            const double steps = sample.value[s] / step;
            assert_close(steps, round(steps), 1e-6);
            assert_close(sample.value[s], exact.value[s], 0.5 * step * (1.0 + 1e-9));
        }
    }
}

TEST(machine_without_steps_is_not_quantised)
{
    struct dig_machine smooth     = machine;
    smooth.pressure_step_Pa       = 0.0;
    smooth.angle_step_rad         = 0.0;
    const struct dig_sample exact = dig_rig_sense(&smooth, &row, 0, NULL);
    struct dig_sample       same  = exact;
    dig_rig_quantise(&smooth, &same);
    assert_memory_equal(&same, &exact, sizeof same);
}
