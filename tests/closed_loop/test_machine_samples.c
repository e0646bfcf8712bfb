// Tests for closed_loop/machine_digs/machine_samples.c

#include "closed_loop/machine_digs/machine_dig.h"

#include "tests/testlib.h"

// Four samples, the last a while after the others; the boom turns ever faster.
static struct dig_machine_dig four_samples(double time_s[4], struct dig_rates rates[4])
{
    static const double at_s[4] = { 0.0, 0.02, 0.04, 0.1 };
    for (size_t i = 0; i < 4; i++) {
        time_s[i] = at_s[i];
        rates[i]  = (struct dig_rates){ .velocity_radps[DIG_JOINT_BOOM] = 10.0 * at_s[i] };
    }
    return (struct dig_machine_dig){ .samples = 4, .time_s = time_s, .rates = rates };
}

TEST(a_time_is_found_from_either_side)
{
    double                       time_s[4];
    struct dig_rates             rates[4];
    const struct dig_machine_dig dig = four_samples(time_s, rates);
    for (size_t near = 0; near < 4; near++) {
        const struct dig_between at = dig_machine_dig_between(&dig, 0.025, near);
        assert_int_equal(at.sample, 1);
        assert_close(at.fraction, 0.25, 1e-12);
        assert_close(dig_machine_dig_rates(&dig, at).velocity_radps[DIG_JOINT_BOOM], 0.25, 1e-12);
    }
}

// An angle that is younger than its pressures asks beyond the last sample.
TEST(beyond_the_ends_the_nearest_sample_counts)
{
    double                       time_s[4];
    struct dig_rates             rates[4];
    const struct dig_machine_dig dig = four_samples(time_s, rates);
    for (size_t near = 0; near < 4; near++) {
        const struct dig_between before = dig_machine_dig_between(&dig, -1.0, near);
        const struct dig_between after  = dig_machine_dig_between(&dig, 1.0, near);
        assert_int_equal(before.sample, 0);
        assert_close(before.fraction, 0.0, 1e-12);
        assert_int_equal(after.sample, 2);
        assert_close(after.fraction, 1.0, 1e-12);
    }
}
