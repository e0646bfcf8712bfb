// Tests for closed_loop/machine_digs/recording_faults.c

#include "closed_loop/machine_digs/recording_faults.h"

#include "files/machine_yaml.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <string.h>

enum { ROWS = 4000 }; // 20 s

static struct dig_machine           machine;
static struct dig_sample            rows[ROWS];
static struct dig_machine_recording recording;

static double whole(const double value, const double step)
{
    return step > 0.0 ? step * floor(value / step + 0.5) : value;
}

// A load that comes and goes in every chamber, in steps of step_Pa with noise of half of one, cut
// off at limit_Pa; chamber 5 is a return side. The machine's file may tell of finer steps.
static void make(const double step_Pa, const double noise, const double limit_Pa)
{
    struct dig_error error = { "" };
    assert_int_equal(dig_machine_read("config/machines/zx200_trench.yaml", &machine, &error),
                     DIG_OK);
    recording = (struct dig_machine_recording){ ROWS, rows };
    memset(rows, 0, sizeof rows);
    unsigned seed = 7;
    for (int i = 0; i < ROWS; i++) {
        struct dig_sample *const row = &rows[i];
        row->time_ns                 = (int64_t)i * 5000000;
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            seed              = 1664525U * seed + 1013904223U;
            const double even = (double)(seed >> 8U) / 16777216.0 - 0.5;
            const double load =
                s == DIG_SIGNAL_BUCKET_ROD_Pa ? 0.0 : 8e6 * sin(0.00157 * i + 0.1 * s);
            const double Pa = 1e6 + fmax(load, 0.0) + 2.0 * noise * even;
            row->valid[s]   = true;
            row->value[s] = s < DIG_SIGNAL_BOOM_HEAD_Pa ? 0.3 : fmin(whole(Pa, step_Pa), limit_Pa);
        }
    }
}

TEST(a_load_that_comes_and_goes_is_whole)
{
    const double steps[]  = { 0.0, 2e5, 2e5, 1e3, 5e5, 5e5 };
    const double noises[] = { 0.0, 0.0, 1e5, 1e5, 0.0, 1e5 };
    for (int k = 0; k < 6; k++) {
        make(steps[k], noises[k], 1e9);
        struct dig_clip clip = { .time_s = -7.0 };
        assert_false(dig_saturation_find(&machine, &recording, &clip));
        assert_close(clip.time_s, -7.0, 0.0);
    }
}

TEST(a_sensor_that_ends_is_named_with_its_limit)
{
    const double steps[]  = { 0.0, 2e5, 2e5, 1e3, 5e5, 5e5 };
    const double noises[] = { 0.0, 0.0, 1e5, 1e5, 0.0, 1e5 };
    for (int k = 0; k < 6; k++) {
        make(steps[k], noises[k], 4e6);
        struct dig_clip clip = { .time_s = 0.0 };
        assert_true(dig_saturation_find(&machine, &recording, &clip));
        assert_close(clip.limit_Pa, 4e6, 1.0);
        assert_true(clip.time_s > 3.0 && clip.time_s < 20.0);
        assert_true(clip.signal >= DIG_SIGNAL_BOOM_HEAD_Pa &&
                    clip.signal < DIG_SIGNAL_BUCKET_ROD_Pa);
    }
}

TEST(a_return_side_may_stand_still)
{
    make(0.0, 0.0, 1e6); // nothing is ever above the return's pressure
    struct dig_clip clip = { .time_s = 0.0 };
    assert_false(dig_saturation_find(&machine, &recording, &clip));
    recording.rows = 1;
    assert_false(dig_saturation_find(&machine, &recording, &clip));
}

// Where every noisy reading but the cut-off ones moves, a fifth of a second at the limit is enough.
TEST(a_sensor_that_ends_for_a_moment_is_named)
{
    for (int k = 0; k < 2; k++) {
        make(2e5, 2e5, 1e9);
        struct dig_clip clip = { .time_s = -7.0 };
        assert_false(dig_saturation_find(&machine, &recording, &clip));
        for (int i = 800; i < 850; i++) {
            double *const Pa = &rows[i].value[DIG_SIGNAL_BUCKET_HEAD_Pa];
            *Pa              = fmin(*Pa + 5e7, 1.1e7);
        }
        if (k == 0) {
            assert_true(dig_saturation_find(&machine, &recording, &clip));
            assert_int_equal(clip.signal, DIG_SIGNAL_BUCKET_HEAD_Pa);
            assert_close(clip.limit_Pa, 1.1e7, 1.0);
            assert_close(clip.time_s, 0.25, 0.01);
        } else {
            // The same peak, but each reading another: whole.
            for (int i = 800; i < 850; i++) {
                rows[i].value[DIG_SIGNAL_BUCKET_HEAD_Pa] -= i % 2 == 0 ? 0.0 : 2e5;
            }
            assert_false(dig_saturation_find(&machine, &recording, &clip));
        }
    }
}

// A bucket held still, its readings without noise: the same value for seconds, which is no limit.
TEST(a_load_that_stands_still_without_noise_is_whole)
{
    make(2e5, 0.0, 1e9);
    struct dig_clip clip = { .time_s = -7.0 };
    for (int i = 0; i < ROWS; i++) {
        rows[i].value[DIG_SIGNAL_BUCKET_ROD_Pa] = i > 1000 && i < 3000 ? 2.2e6 : 1e6;
    }
    assert_false(dig_saturation_find(&machine, &recording, &clip));
    assert_close(dig_saturation_log10_chance(&recording, DIG_SIGNAL_BUCKET_ROD_Pa), 0.0, 0.0);
}

// Fine steps without noise: the load moves from reading to reading, but is held at two places.
TEST(a_load_that_is_held_elsewhere_as_long_is_whole)
{
    for (int k = 0; k < 2; k++) {
        make(1e3, 0.0, 1e9);
        struct dig_clip clip = { .time_s = -7.0 };
        for (int i = 0; i < ROWS; i++) {
            const bool held = (i > 500 && i < 600) || (k == 0 && i > 2000 && i < 2101);

            rows[i].value[DIG_SIGNAL_BUCKET_ROD_Pa] =
                held ? (i < 1000 ? 2.2e6 : 1.5e6) : 1e6 + 1e3 * (i % 7);
        }
        assert_int_equal(dig_saturation_find(&machine, &recording, &clip), k == 1);
    }
}

// By drawing: readings of a load that stands still, in steps of twice the noise's sigma, are called
// as improbable as p in at most a share p of recordings.
TEST(the_chance_is_no_smaller_than_it_is)
{
    enum { DRAWS = 2000, READINGS = 1000 };
    make(2e5, 0.0, 1e9);
    uint64_t seed     = 3;
    double   least[2] = { 0.0, 0.0 };
    recording.rows    = READINGS;
    for (int d = 0; d < DRAWS; d++) {
        const double load_Pa = 5e6 + 2e5 * d / DRAWS;
        for (int i = 0; i < READINGS; i++) {
            rows[i].value[DIG_SIGNAL_ARM_HEAD_Pa] = whole(load_Pa + 1e5 * model_normal(&seed), 2e5);
        }
        const double chance = dig_saturation_log10_chance(&recording, DIG_SIGNAL_ARM_HEAD_Pa);
        least[0] += chance < -1.0 ? 1.0 / DRAWS : 0.0;
        least[1] += chance < -2.0 ? 1.0 / DRAWS : 0.0;
    }
    assert_true(least[0] <= 0.1 && least[1] <= 0.01);
}
