// Tests for firmware_host/tick/assemble.c: what stands still, jumps, freezes or fails to come

#include "firmware_host/tick/assemble.h"

#include "tests/firmware_host/readings.h"
#include "tests/testlib.h"

TEST(what_is_no_number_is_missing_and_counted)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &can);
    struct dig_reading p              = pressures(1000 * MS, 5.0);
    p.state[DIG_SIGNAL_BOOM_HEAD_Pa]  = DIG_READING_NOT_AVAILABLE;
    p.state[DIG_SIGNAL_ARM_ROD_Pa]    = DIG_READING_OUT_OF_RANGE;
    p.state[DIG_SIGNAL_BUCKET_ROD_Pa] = DIG_READING_NAN;
    p.value[DIG_SIGNAL_BUCKET_ROD_Pa] = NAN;
    const struct dig_reading g        = angles(1001 * MS, 0.5);
    struct dig_sample        s;
    assert_false(dig_assembler_take(&a, &p, &s));
    assert_true(dig_assembler_take(&a, &g, &s));
    assert_false(dig_sample_is_complete(&s));
    assert_false(s.valid[DIG_SIGNAL_BOOM_HEAD_Pa]);
    assert_false(s.valid[DIG_SIGNAL_ARM_ROD_Pa]);
    assert_close(s.value[DIG_SIGNAL_BUCKET_ROD_Pa], 0.0, 0.0);
    assert_true(s.valid[DIG_SIGNAL_BOOM_ROD_Pa]);
    assert_int_equal(a.drops.not_available, 1);
    assert_int_equal(a.drops.out_of_range, 1);
    assert_int_equal(a.drops.nan, 1);

    // The next cycle is whole again.
    const struct dig_reading p2 = pressures(1010 * MS, 5.0), g2 = angles(1011 * MS, 0.5);
    assert_false(dig_assembler_take(&a, &p2, &s));
    assert_true(dig_assembler_take(&a, &g2, &s));
    assert_true(dig_sample_is_complete(&s));
}

TEST(a_counter_that_stands_still_stops_samples_until_it_moves)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &can);
    struct dig_sample s;
    int               before = 0, during = 0, after = 0;
    for (int64_t i = 0; i < 300; i++) {
        const int64_t  at_ns = 1000 * MS + i * 10 * MS;
        const uint64_t count = i < 100 ? (uint64_t)i : i < 200 ? 99 : (uint64_t)i;

        const struct dig_reading c = alive(at_ns, count), p = pressures(at_ns, 1.0),
                                 g = angles(at_ns, 1.0);
        if (i % 5 == 0) {
            (void)dig_assembler_take(&a, &c, &s);
        }
        int *const period = i < 100 ? &before : i < 200 ? &during : &after;
        (void)dig_assembler_take(&a, &p, &s);
        *period += dig_assembler_take(&a, &g, &s) ? 1 : 0;
    }
    assert_int_equal(before, 100);
    assert_in_range(during, 45, 52); // half a second of grace
    assert_int_equal(after, 100);
    assert_in_range(a.drops.frozen, 90, 120);
}

TEST(a_poll_that_repeats_the_counter_gives_no_second_sample)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &poll_settings);
    struct dig_sample s;
    int               samples = 0;
    for (int64_t i = 0; i < 90; i++) {
        const struct dig_reading r = poll(1000 * MS + i * 5 * MS, (uint64_t)(i / 3));
        samples += dig_assembler_take(&a, &r, &s) ? 1 : 0;
    }
    assert_int_equal(samples, 30);
    assert_int_equal(a.drops.frozen, 0);

    // From now on it stands still: silence, and after half a second it counts as frozen.
    for (int64_t i = 90; i < 290; i++) {
        const struct dig_reading r = poll(1000 * MS + i * 5 * MS, 29);
        assert_false(dig_assembler_take(&a, &r, &s));
    }
    assert_in_range(a.drops.frozen, 90, 110);
}

TEST(a_value_that_jumps_is_dropped_until_it_could_have_come_there)
{
    struct dig_assembler_settings careful     = poll_settings;
    careful.max_rate[DIG_SIGNAL_BOOM_HEAD_Pa] = 100.0; // and so 2 at once, and 1 more each 10 ms
    struct dig_assembler a;
    dig_assembler_init(&a, &careful);
    struct dig_sample s;
    for (int64_t i = 0; i < 60; i++) {
        struct dig_reading r             = poll(1000 * MS + i * 10 * MS, (uint64_t)i);
        r.value[DIG_SIGNAL_BOOM_HEAD_Pa] = i == 10 ? 50.0 : i >= 20 ? 11.0 : 1.0;
        assert_true(dig_assembler_take(&a, &r, &s));
        // 10 away: believed once 20 ms and 80 ms are over.
        assert_true(s.valid[DIG_SIGNAL_BOOM_HEAD_Pa] == !(i == 10 || (i >= 20 && i < 27)));
        assert_true(s.valid[DIG_SIGNAL_BOOM_ROD_Pa]);
    }
    assert_int_equal(a.drops.jump, 1 + 7);
}

TEST(frames_that_repeat_or_fail_to_come_are_counted)
{
    struct dig_assembler_settings counted = can;
    counted.frame[0].counter_mod          = 16;
    counted.frame[1].cycle_s              = 0.010;
    struct dig_assembler a;
    dig_assembler_init(&a, &counted);
    struct dig_sample s;
    int               samples = 0;
    for (int64_t i = 0; i < 200; i++) {
        struct dig_reading       p = pressures(1000 * MS + i * 10 * MS, 1.0);
        const struct dig_reading g = angles(1000 * MS + i * 10 * MS, 1.0);
        p.counter                  = (uint64_t)(i == 50 ? 49 : i); // the one before again
        if (i != 20 && i != 21) {
            (void)dig_assembler_take(&a, &p, &s);
        }
        samples += i != 100 && dig_assembler_take(&a, &g, &s) ? 1 : 0;
    }
    assert_int_equal(a.drops.repeated, 1);
    assert_int_equal(a.drops.missed, 2 + 1 + 1); // two, the one replaced, the angles
    assert_int_equal(samples, 200 - 2 - 1 - 1);
}

TEST(pressures_that_freeze_under_a_moving_front_stop_samples)
{
    struct dig_assembler_settings watchful = poll_settings;
    watchful.stuck_s                       = 0.5;
    struct dig_assembler a;
    dig_assembler_init(&a, &watchful);
    struct dig_sample s;
    int               during = 0, after = 0;
    for (int64_t i = 0; i < 300; i++) {
        struct dig_reading r             = poll(1000 * MS + i * 10 * MS, (uint64_t)i);
        const bool         stands        = i >= 100 && i < 200;
        r.value[DIG_SIGNAL_BOOM_HEAD_Pa] = stands ? 7.0 : (double)i;
        r.value[DIG_SIGNAL_BOOM_rad]     = 0.004 * (double)i;
        const bool came                  = dig_assembler_take(&a, &r, &s);
        during += stands && came ? 1 : 0;
        after += i >= 200 && came ? 1 : 0;
    }
    assert_in_range(during, 25, 27); // 0.1 rad
    assert_int_equal(after, 100);
    assert_int_equal(a.drops.stuck, 100 - during);
}
