// Tests for firmware_host/bus/stuck.c

#include "firmware_host/bus/stuck.h"

#include "tests/testlib.h"

#define MS 1000000LL

// A front that moves at 0.2 rad/s, its pressures with it; what stands stands from sample `from` on.
// The pressures from the first on are measured.
static int64_t first_stuck_of(const bool angles_stand, const bool pressures_stand,
                              const double boom, const double pressure_Pa, const int from,
                              const int first)
{
    struct dig_stuck stuck = { 0 };
    for (int i = 0; i < 1000; i++) {
        const int         a = angles_stand && i > from ? from : i;
        const int         p = pressures_stand && i > from ? from : i;
        struct dig_sample s = { .time_ns = 1000 * MS + i * 10 * MS };
        for (int k = 0; k < 3; k++) {
            s.value[DIG_SIGNAL_BOOM_rad + k] = k == 2 ? 0.002 * a : boom * 0.002 * a;
            s.valid[DIG_SIGNAL_BOOM_rad + k] = true;
        }
        for (int k = first; k < 6; k++) {
            s.valid[DIG_SIGNAL_BOOM_HEAD_Pa + k] = true;
            s.value[DIG_SIGNAL_BOOM_HEAD_Pa + k] = 5e6 + pressure_Pa * (p % 50) / 50.0;
        }
        if (dig_stuck_step(&stuck, 0.5, &s)) {
            return i;
        }
    }
    return -1;
}

static int64_t first_stuck(const bool angles_stand, const bool pressures_stand, const double boom,
                           const double pressure_Pa, const int from)
{
    return first_stuck_of(angles_stand, pressures_stand, boom, pressure_Pa, from, 0);
}

TEST(values_that_move_are_never_stuck)
{
    assert_int_equal(first_stuck(false, false, 1.0, 3e6, 0), -1);
}

TEST(a_front_that_stands_is_not_stuck)
{
    assert_int_equal(first_stuck(true, true, 1.0, 3e6, 100), -1);
    assert_int_equal(first_stuck(true, false, 1.0, 0.5e6, 100), -1); // an engine's ripple
}

TEST(pressures_that_stand_while_boom_and_arm_turn_are_stuck)
{
    // 0.1 rad at 0.002 rad a sample.
    assert_in_range(first_stuck(false, true, 1.0, 3e6, 100), 149, 153);
    assert_int_equal(first_stuck(false, true, 0.0, 3e6, 100), -1); // the bucket alone
}

TEST(angles_that_stand_while_pressures_change_are_stuck_after_a_while)
{
    assert_in_range(first_stuck(true, false, 1.0, 3e6, 100), 150, 153);
}

// A bucket that hangs: its pressures may stand while boom and arm carry it.
TEST(the_buckets_pressures_alone_may_stand)
{
    enum { BUCKETS = 4 };
    assert_int_equal(first_stuck_of(false, true, 1.0, 3e6, 100, BUCKETS), -1);
    assert_in_range(first_stuck_of(true, false, 1.0, 3e6, 100, BUCKETS), 150, 153);
}
