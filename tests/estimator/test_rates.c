// Tests for estimator/wrench/rates.c

#include "estimator/wrench/rates.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

#include <string.h>

static const double c0[DIG_JOINTS] = { 0.3, -1.2, -0.7 };
static const double c1[DIG_JOINTS] = { 0.2, -0.4, 0.9 };
static const double c2[DIG_JOINTS] = { 0.5, 1.5, -2.0 };

static void angles_at(const double t_s, double q[DIG_JOINTS])
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        q[j] = c0[j] + c1[j] * t_s + 0.5 * c2[j] * t_s * t_s;
    }
}

TEST(even_acceleration_is_told_exactly_at_the_windows_end)
{
    struct dig_rates_filter filter = { .window_s = 0.25 };
    struct dig_rates        rates  = { .velocity_sigma = 0.0 };
    uint64_t                seed   = 1;
    double                  t_s    = 0.0;
    for (int i = 0; i < 400; i++) {
        t_s += 0.004 + 0.002 * model_uniform(&seed); // never evenly spaced
        double q[DIG_JOINTS];
        angles_at(1e-9 * (double)(int64_t)(1e9 * t_s), q);
        rates = dig_rates_step(&filter, (int64_t)(1e9 * t_s), q, 1e-4);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(rates.velocity_radps[j], c1[j] + c2[j] * t_s, 1e-6);
        assert_close(rates.acceleration_radps2[j], c2[j], 1e-5);
    }
}

TEST(its_sigma_is_what_noise_does)
{
    const double            sigma  = 2e-4;
    struct dig_rates_filter filter = { .window_s = 0.25 };
    uint64_t                seed   = 2;
    double                  v2 = 0.0, a2 = 0.0, sv = 0.0, sa = 0.0;
    int                     n = 0;
    for (int i = 0; i < 40000; i++) {
        double q[DIG_JOINTS];
        for (int j = 0; j < DIG_JOINTS; j++) {
            q[j] = sigma * model_normal(&seed);
        }
        const struct dig_rates r = dig_rates_step(&filter, (int64_t)i * 5000000, q, sigma);
        if (i > 100) {
            v2 += r.velocity_radps[0] * r.velocity_radps[0];
            a2 += r.acceleration_radps2[1] * r.acceleration_radps2[1];
            sv = r.velocity_sigma;
            sa = r.acceleration_sigma;
            n++;
        }
    }
    assert_close(sqrt(v2 / n) / sv, 1.0, 0.05);
    assert_close(sqrt(a2 / n) / sa, 1.0, 0.05);
}

TEST(too_few_angles_or_a_gap_count_as_still)
{
    struct dig_rates_filter filter = { .window_s = 0.25 };
    double                  q[DIG_JOINTS];
    for (int i = 0; i < 200; i++) {
        angles_at(0.005 * i, q);
        const struct dig_rates r = dig_rates_step(&filter, (int64_t)i * 5000000, q, 1e-4);
        if (i < 20) {
            assert_close(r.velocity_radps[0], 0.0, 0.0);
            assert_close(r.velocity_sigma, 0.0, 0.0);
        }
    }
    angles_at(3.0, q);
    const struct dig_rates after = dig_rates_step(&filter, 3000000000, q, 1e-4);
    assert_close(after.velocity_radps[2], 0.0, 0.0);
}

TEST(centred_rates_have_no_lag)
{
    enum { N = 400 };
    double           t[N], q[DIG_JOINTS * N];
    struct dig_rates rates[N];
    for (int i = 0; i < N; i++) {
        t[i] = 0.005 * i;
        for (int j = 0; j < DIG_JOINTS; j++) {
            q[DIG_JOINTS * i + j] = 0.3 * sin(2.0 * t[i] + j);
        }
    }
    dig_rates_centred(N, t, q, 0.1, 1e-4, rates);
    for (int i = 40; i < N - 40; i++) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            // A mean over the window flattens by (omega half)^2 / 10, of no phase: a lag of 2 ms
            // would show.
            assert_close(rates[i].velocity_radps[j], 0.6 * cos(2.0 * t[i] + j), 0.6 * 0.005);
            assert_close(rates[i].acceleration_radps2[j], -1.2 * sin(2.0 * t[i] + j), 1.2 * 0.004);
        }
    }
}
