// Tests for firmware_host/tick/assemble.c

#include "firmware_host/tick/assemble.h"

#include "tests/firmware_host/readings.h"
#include "tests/testlib.h"

// The daemon starts between the two frames of a cycle: what it pairs must still be one cycle's.
TEST(frames_of_one_cycle_are_paired_wherever_it_starts)
{
    for (int begin = 0; begin < 2; begin++) {
        struct dig_assembler a;
        dig_assembler_init(&a, &can);
        int samples = 0;
        for (int i = begin; i < 100; i++) {
            const int64_t      cycle = i / 2;
            const int64_t      at_ns = 1000 * MS + cycle * 10 * MS + i % 2 * 200000;
            struct dig_reading r =
                i % 2 == 0 ? pressures(at_ns, (double)cycle) : angles(at_ns, (double)cycle);
            struct dig_sample s;
            if (dig_assembler_take(&a, &r, &s)) {
                samples++;
                assert_true(dig_sample_is_complete(&s));
                // At the pressures' stamp; the angles, 0.2 ms younger, between their frames.
                const double angle = cycle > 0 ? (double)cycle - 0.02 : (double)cycle;
                assert_close(s.value[DIG_SIGNAL_BOOM_HEAD_Pa], (double)cycle, 0.0);
                assert_close(s.value[DIG_SIGNAL_BOOM_rad], angle, 1e-9);
                assert_int_equal(s.time_ns, at_ns - 200000);
            }
        }
        assert_in_range(samples, 49, 50);
    }
}

TEST(nothing_comes_while_one_needed_message_is_missing)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &can);
    struct dig_sample s = { .time_ns = 42 };
    for (int64_t i = 0; i < 20; i++) {
        const struct dig_reading r = pressures(1000 * MS + i * 10 * MS, 1.0);
        assert_false(dig_assembler_take(&a, &r, &s));
    }
    assert_int_equal(s.time_ns, 42);

    // It comes back: at once, and with the youngest pressures.
    const struct dig_reading back = angles(1000 * MS + 191 * MS, 2.0);
    assert_true(dig_assembler_take(&a, &back, &s));
}

// As a machine has it whose boom and arm have a sensor box of their own, in group 3.
static struct dig_reading force_pressures(const int64_t time_ns, const double level)
{
    struct dig_reading r = { .time_ns = time_ns, .group = 3 };
    for (int i = DIG_SIGNAL_BOOM_HEAD_Pa; i <= DIG_SIGNAL_ARM_ROD_Pa; i++) {
        r.state[i] = DIG_READING_OK;
        r.value[i] = level;
    }
    return r;
}

static struct dig_reading bucket_pressures(const int64_t time_ns, const double level)
{
    struct dig_reading r = { .time_ns = time_ns, .group = 0 };
    for (int i = DIG_SIGNAL_BUCKET_HEAD_Pa; i <= DIG_SIGNAL_BUCKET_ROD_Pa; i++) {
        r.state[i] = DIG_READING_OK;
        r.value[i] = level;
    }
    return r;
}

static struct dig_assembler_settings boxes(void)
{
    struct dig_assembler_settings settings = can;
    settings.has_alive                     = false;
    settings.groups                        = 4;
    settings.needed[3]                     = true;
    settings.dispensable[3]                = true;
    return settings;
}

// One cycle of all boxes, the force's last; the sample it gives, if any.
static bool cycle(struct dig_assembler *const a, const int64_t at_ns, const double level,
                  const bool with_force, struct dig_sample *const sample)
{
    const struct dig_reading p = bucket_pressures(at_ns, level), g = angles(at_ns, level),
                             f = force_pressures(at_ns + MS, level);
    bool came                  = dig_assembler_take(a, &p, sample);
    came                       = dig_assembler_take(a, &g, sample) || came;
    return (with_force && dig_assembler_take(a, &f, sample)) || came;
}

TEST(without_the_force_the_moment_goes_on_until_it_is_back)
{
    const struct dig_assembler_settings settings = boxes();
    struct dig_assembler                a;
    dig_assembler_init(&a, &settings);
    int came[3] = { 0 }, whole[3] = { 0 };
    for (int64_t i = 0; i < 300; i++) {
        const int         part = (int)(i / 100);
        struct dig_sample s    = { .time_ns = 0 };
        if (cycle(&a, 1000 * MS + i * 10 * MS, (double)i, part != 1, &s)) {
            came[part]++;
            whole[part] += dig_sample_is_complete(&s) ? 1 : 0;
            assert_true(dig_sample_has_moment(&s));
            assert_close(s.value[DIG_SIGNAL_BUCKET_HEAD_Pa], (double)i, 1e-9);
            assert_close(s.value[DIG_SIGNAL_ARM_ROD_Pa],
                         s.valid[DIG_SIGNAL_ARM_ROD_Pa] ? (double)i : 0.0, 0.11);
            assert_true(s.valid[DIG_SIGNAL_BOOM_HEAD_Pa] == s.valid[DIG_SIGNAL_ARM_ROD_Pa]);
        }
    }
    assert_true(came[0] == 100 && whole[0] == 100);
    assert_in_range(came[1], 88, 91); // a tenth of a second of patience
    assert_int_equal(whole[1], 0);
    assert_true(came[2] == 100 && whole[2] == 99); // it comes after the first sample is made
    assert_int_equal(a.drops.without_force, came[1] + 1);
}

// A message that never came is waited for no longer than one that fell silent.
TEST(a_force_that_never_comes_does_not_stop_the_moment)
{
    const struct dig_assembler_settings settings = boxes();
    struct dig_assembler                a;
    dig_assembler_init(&a, &settings);
    int came = 0;
    for (int64_t i = 0; i < 100; i++) {
        struct dig_sample s;
        came += cycle(&a, 1000 * MS + i * 10 * MS, 1.0, false, &s) ? 1 : 0;
    }
    assert_in_range(came, 88, 91);

    // The moment's own messages are not done without.
    const struct dig_assembler_settings deaf = boxes();
    dig_assembler_init(&a, &deaf);
    for (int64_t i = 0; i < 100; i++) {
        struct dig_sample        s;
        const struct dig_reading f = force_pressures(1000 * MS + i * 10 * MS, 1.0),
                                 g = angles(1000 * MS + i * 10 * MS, 1.0);
        assert_false(dig_assembler_take(&a, &f, &s));
        assert_false(dig_assembler_take(&a, &g, &s));
    }
    assert_int_equal(a.drops.without_force, 0);
}

// Neither a lost frame, nor a box slower than the others, nor a pause of the whole bus is a
// silence.
TEST(what_is_only_late_is_waited_for)
{
    const struct dig_assembler_settings settings = boxes();
    struct dig_assembler                a;
    dig_assembler_init(&a, &settings);
    int came = 0;
    for (int64_t i = 0; i < 300; i++) {
        struct dig_sample s;
        const int64_t     pause = i < 200 ? 0 : 3000 * MS;
        came += cycle(&a, 1000 * MS + i * 10 * MS + pause, 1.0, i % 10 != 5, &s) ? 1 : 0;
    }
    assert_int_equal(came, 270);
    assert_int_equal(a.drops.without_force, 0);

    struct dig_assembler_settings slow = boxes();
    slow.coherent_s                    = 0.012;
    slow.frame[3].cycle_s              = 0.2;
    dig_assembler_init(&a, &slow);
    came = 0;
    for (int64_t i = 0; i < 300; i++) {
        struct dig_sample s;
        came += cycle(&a, 1000 * MS + i * 10 * MS, 1.0, i % 20 == 0, &s) ? 1 : 0;
    }
    assert_int_equal(came, 15);
    assert_int_equal(a.drops.without_force, 0);
}

TEST(an_optional_signal_comes_along_until_it_is_old)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &can);
    const struct dig_reading tilt = alive(1000 * MS, 1);
    struct dig_sample        s;
    assert_false(dig_assembler_take(&a, &tilt, &s));
    const struct dig_reading p = pressures(1010 * MS, 5.0), g = angles(1010 * MS, 0.5);
    (void)dig_assembler_take(&a, &p, &s);
    assert_true(dig_assembler_take(&a, &g, &s));
    assert_true(s.valid[DIG_SIGNAL_PITCH_rad]);
    assert_close(s.value[DIG_SIGNAL_PITCH_rad], 0.1, 0.0);
    assert_false(s.valid[DIG_SIGNAL_TEMPERATURE_degC]);

    struct dig_assembler_settings forgetful = can;
    forgetful.optional_s                    = 0.005;
    dig_assembler_init(&a, &forgetful);
    (void)dig_assembler_take(&a, &tilt, &s);
    (void)dig_assembler_take(&a, &p, &s);
    assert_true(dig_assembler_take(&a, &g, &s));
    assert_false(s.valid[DIG_SIGNAL_PITCH_rad]);
}

TEST(time_scale_makes_a_fast_bench_look_like_the_machine)
{
    struct dig_assembler_settings fast = poll_settings;
    fast.time_scale                    = 4.0;
    struct dig_assembler a;
    dig_assembler_init(&a, &fast);
    struct dig_sample s;
    for (int64_t i = 0; i < 10; i++) {
        const struct dig_reading r = poll(1000 * MS + i * 5 * MS, (uint64_t)i);
        assert_true(dig_assembler_take(&a, &r, &s));
        assert_int_equal(s.time_ns, 1000 * MS + i * 20 * MS);
    }
}

TEST(time_that_goes_back_gives_no_sample)
{
    struct dig_assembler a;
    dig_assembler_init(&a, &poll_settings);
    struct dig_sample        s;
    const struct dig_reading one = poll(1000 * MS, 1), back = poll(999 * MS, 2),
                             on = poll(1001 * MS, 3);
    assert_true(dig_assembler_take(&a, &one, &s));
    assert_false(dig_assembler_take(&a, &back, &s));
    assert_true(dig_assembler_take(&a, &on, &s));
}

// Angles every 10 ms, pressures every 50 ms and out of step: values belong to one moment all the
// same.
TEST(messages_of_unlike_rates_are_brought_to_one_time)
{
    struct dig_assembler_settings slow = can;
    slow.coherent_s                    = 0.012;
    slow.frame[0].delay_s              = 0.003; // the pressures are older than their stamps say
    struct dig_assembler a;
    dig_assembler_init(&a, &slow);
    int samples = 0;
    for (int64_t ms = 0; ms < 2000; ms++) {
        const int64_t      at_ns  = (1000 + ms) * MS;
        const double       past_s = 1e-3 * (double)(ms - 3);
        struct dig_reading r =
            ms % 50 == 7 ? pressures(at_ns, past_s) : angles(at_ns, 1e-3 * (double)ms);
        struct dig_sample s;
        if ((ms % 50 == 7 || ms % 10 == 2) && dig_assembler_take(&a, &r, &s)) {
            const double t_s = 1e-9 * (double)(s.time_ns - 1000 * MS);
            if (samples++ == 0) {
                continue; // there is nothing before the first pressures
            }
            assert_close(s.value[DIG_SIGNAL_BOOM_HEAD_Pa], t_s, 1e-9);
            assert_close(s.value[DIG_SIGNAL_BOOM_rad], t_s, 1e-9);
        }
    }
    assert_in_range(samples, 38, 40);
}
