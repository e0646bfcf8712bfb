#include "closed_loop/recordings/lateness.h"

#include "tests/closed_loop/world_fixture.h"

static const double growth = 3.0; // of a force, a second of its own time

static const struct dig_trajectory *way(void)
{
    return &world.set->trajectory[MADE_ACTUAL];
}

// A dig of that pace whose forces grow steadily from its begin, channel by channel as much more.
static struct dig_measured steady(const double pace)
{
    struct dig_measured dig = { .trajectory = MADE_ACTUAL, .pace = pace, .last = 1.0 };
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        dig.measured[c] = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double at_s = dig_trajectory_time_s(way(), world.set->tooth_m,
                                                      (double)k / (DIG_CURVE_POINTS - 1));
            dig.value[c][k]   = growth * ((double)c + 1.0) * at_s / pace;
        }
    }
    return dig;
}

TEST(a_rate_is_by_the_digs_own_time)
{
    for (double pace = 0.5; pace < 3.0; pace *= 2.0) {
        const struct dig_measured dig = steady(pace);
        double                    rate[DIG_FEATURES];
        dig_lateness_rate(way(), world.set->tooth_m, &dig, rate);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const double channel = (double)(f / DIG_FEATURE_BINS) + 1.0;
            assert_close(rate[f], growth * channel, 1e-6 * growth * channel);
        }
    }
}

TEST(what_was_not_measured_has_no_rate)
{
    struct dig_measured dig = steady(1.0);
    double              rate[DIG_FEATURES];
    dig.measured[DIG_CHANNEL_FX_N] = false;
    dig.first                      = 0.3;
    for (size_t k = 0; k < 3 * DIG_CURVE_POINTS / 10; k++) {
        dig.value[DIG_CHANNEL_MY_Nm][k] = 0.0; // as observed
    }
    dig_lateness_rate(way(), world.set->tooth_m, &dig, rate);
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        assert_close(rate[DIG_CHANNEL_FX_N * DIG_FEATURE_BINS + b], 0.0, 0.0);
        // No step where the recording begins; its first bin lacks a point.
        assert_close(rate[b], b < 3 ? 0.0 : growth, b == 3 ? 0.1 * growth : 1e-6);
    }
}

TEST(beds_share_a_rate_each_at_its_pace)
{
    struct dig_measured dig[4] = { steady(1.0), steady(2.0), steady(1.0), steady(1.0) };
    const bool          fit[4] = { true, true, false, true };
    const double        own[4] = { 1.0, 8.0, 100.0, 4.0 };
    dig[3].trajectory          = MADE_SIMPLE_A;
    for (size_t i = 0; i < 4; i++) {
        dig[i].rate[5] = own[i];
    }
    dig_lateness_share(4, dig, fit);
    assert_close(dig[0].rate[5], 2.5, 1e-12); // the mean of 1 and 8 / 2
    assert_close(dig[1].rate[5], 5.0, 1e-12);
    assert_close(dig[2].rate[5], 2.5, 1e-12); // held out: what it has itself says nothing
    assert_close(dig[3].rate[5], 4.0, 1e-12);
}

TEST(a_curve_is_read_later)
{
    enum { LATE = DIG_CURVE_POINTS / 2 };
    const double        pace = 2.0;
    struct dig_measured dig  = steady(pace);
    const double        at   = dig.value[0][LATE];
    dig_lateness_delay(way(), world.set->tooth_m, pace, 0.05, dig.value);
    assert_close(dig.value[0][0], 0.0, 0.0); // as it began
    assert_close(dig.value[0][LATE], at - growth * 0.05, 1e-6);
    dig_lateness_delay(way(), world.set->tooth_m, pace, -0.05, dig.value);
    assert_close(dig.value[0][LATE], at, 1e-6);
}

TESTS_WITH(world_setup, world_teardown)
