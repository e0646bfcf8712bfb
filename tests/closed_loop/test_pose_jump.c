// Tests for closed_loop/machine_digs/recording_faults.c

#include "closed_loop/machine_digs/recording_faults.h"

#include "tests/testlib.h"

#include <math.h>

enum { SAMPLES = 400 };

static struct dig_sample sample[SAMPLES];

// A motion at 100 samples a second: the arm swings as fast as 2 rad/s, its sensor scatters by 4
// degrees.
static void swing(void)
{
    unsigned seed = 5;
    for (int i = 0; i < SAMPLES; i++) {
        seed      = 1664525U * seed + 1013904223U;
        sample[i] = (struct dig_sample){ .time_ns = (int64_t)i * 10000000 };
        sample[i].value[DIG_SIGNAL_ARM_rad] =
            sin(0.02 * i) + 0.07 * ((double)(seed >> 8U) / 8388608.0 - 1.0);
    }
}

static bool jumps(struct dig_pose_jump *const jump)
{
    return dig_pose_jump_find(SAMPLES, sample, jump);
}

TEST(a_motion_however_fast_is_one)
{
    struct dig_pose_jump jump = { .before = 7 };
    swing();
    assert_false(jumps(&jump));
    sample[200].value[DIG_SIGNAL_ARM_rad] += 2.0; // one sample was misread
    assert_false(jumps(&jump));
    sample[SAMPLES - 1].value[DIG_SIGNAL_ARM_rad] += 2.0;
    sample[0].value[DIG_SIGNAL_ARM_rad] += 2.0;
    assert_false(jumps(&jump));
    // Rows are missing while the bucket is turned.
    for (int i = 300; i < SAMPLES; i++) {
        sample[i].value[DIG_SIGNAL_BUCKET_rad] += 0.9;
        sample[i].time_ns += 500000000;
    }
    assert_false(jumps(&jump));
    assert_int_equal(jump.before, 7);
    assert_false(dig_pose_jump_find(3, sample, &jump));
}

TEST(what_begins_elsewhere_has_jumped)
{
    struct dig_pose_jump jump;
    for (int sign = -1; sign <= 1; sign += 2) {
        swing();
        for (int i = 300; i < SAMPLES; i++) {
            sample[i].value[DIG_SIGNAL_BUCKET_rad] += 0.25 * sign;
        }
        assert_true(jumps(&jump));
        assert_int_equal(jump.before, 299);
        assert_int_equal(jump.signal, DIG_SIGNAL_BUCKET_rad);
        assert_close(jump.rad, 0.25 * sign, 1e-9);
    }
}
