// Tests for estimator/wrench/cylinder.c

#include "estimator/wrench/cylinder.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

static const struct dig_cylinder pair = {
    .count             = 2,
    .bore_m            = 0.12,
    .rod_m             = 0.08,
    .relief_Pa         = 3.4e7,
    .min_length_m      = 2.0,
    .max_length_m      = 3.0,
    .pressure_sigma_Pa = 5e4,
};

// Worked by hand: 0.12 m bore is 1.130973355e-2 m2, less 0.08 m rod 6.283185307e-3 m2.
TEST(pressures_push_on_their_areas_times_the_count)
{
    struct dig_push push;
    assert_int_equal(dig_cylinder_push(&pair, 10e6, 0.0, 2e5, &push), DIG_OK);
    assert_close(push.push_N, 226194.671, 1e-3);
    assert_int_equal(dig_cylinder_push(&pair, 0.0, 10e6, 2e5, &push), DIG_OK);
    assert_close(push.push_N, -125663.706, 1e-3);
    assert_true(push.valid);
}

// Monte Carlo: readings of chambers anywhere between the steps, with noise, scatter as sigma says.
TEST(sigma_is_the_scatter_of_quantised_noisy_readings)
{
    enum { TRIALS = 40000 };
    uint64_t seed = 1;
    double   sum2 = 0.0, sigma_N = 0.0;
    for (int i = 0; i < TRIALS; i++) {
        const double    head_Pa = 12e6 + 4e5 * model_uniform(&seed);
        const double    rod_Pa  = 1e6 + 4e5 * model_uniform(&seed);
        struct dig_push truth, read;
        assert_int_equal(dig_cylinder_push(&pair, head_Pa, rod_Pa, 2e5, &truth), DIG_OK);
        assert_int_equal(dig_cylinder_push(&pair, model_reading(head_Pa, 5e4, 2e5, &seed),
                                           model_reading(rod_Pa, 5e4, 2e5, &seed), 2e5, &read),
                         DIG_OK);
        sum2 += pow(read.push_N - truth.push_N, 2.0);
        sigma_N = read.sigma_N;
    }
    assert_close(sqrt(sum2 / TRIALS) / sigma_N, 1.0, 0.02);
}

// A steady signal read often: the mean of the readings keeps the error that slow says.
TEST(slow_is_what_averaging_leaves_of_the_quantisation)
{
    const double dithers[] = { 0.25, 0.35 };
    uint64_t     seed      = 7;
    for (size_t d = 0; d < sizeof dithers / sizeof dithers[0]; d++) {
        double sum2 = 0.0;
        enum { PLACES = 200, READINGS = 4000 };
        for (int p = 0; p < PLACES; p++) {
            const double value = ((double)p + 0.5) / PLACES;
            double       sum   = 0.0;
            for (int i = 0; i < READINGS; i++) {
                sum += model_reading(value, dithers[d], 1.0, &seed) - value;
            }
            sum2 += pow(sum / READINGS, 2.0);
        }
        assert_close(sqrt(sum2 / PLACES), dig_reading_slow(1.0, dithers[d]), 0.006);
    }
    assert_close(dig_reading_slow(1.0, 0.0), 1.0 / (sqrt(2.0) * 3.14159265358979), 1e-9);
    assert_close(dig_reading_slow(0.0, 0.3), 0.0, 0.0);
}

TEST(a_chamber_at_relief_or_below_vacuum_is_invalid)
{
    const double bad_Pa[]  = { 3.38e7, 3.5e7, -4e5 };
    const double good_Pa[] = { 3.36e7, 0.0, -5e4 };
    for (size_t i = 0; i < 3; i++) {
        struct dig_push push;
        assert_int_equal(dig_cylinder_push(&pair, bad_Pa[i], 1e6, 2e5, &push), DIG_OK);
        assert_false(push.valid);
        assert_int_equal(dig_cylinder_push(&pair, 1e6, bad_Pa[i], 2e5, &push), DIG_OK);
        assert_false(push.valid);
        assert_int_equal(dig_cylinder_push(&pair, good_Pa[i], 1e6, 2e5, &push), DIG_OK);
        assert_true(push.valid);
    }
}

TEST(a_pressure_that_is_no_number_is_refused_and_writes_nothing)
{
    const double bad_Pa[] = { NAN, INFINITY, -INFINITY };
    for (size_t i = 0; i < 3; i++) {
        struct dig_push push = { .push_N = 42.0 };
        assert_int_equal(dig_cylinder_push(&pair, bad_Pa[i], 1e6, 2e5, &push), DIG_EINVAL);
        assert_int_equal(dig_cylinder_push(&pair, 1e6, bad_Pa[i], 2e5, &push), DIG_EINVAL);
        assert_close(push.push_N, 42.0, 0.0);
    }
}

TEST(stops_are_kept_clear_of)
{
    assert_true(dig_cylinder_is_clear(&pair, 2.5));
    assert_false(dig_cylinder_is_clear(&pair, 2.004));
    assert_false(dig_cylinder_is_clear(&pair, 2.996));
    assert_false(dig_cylinder_is_clear(&pair, NAN));
}
