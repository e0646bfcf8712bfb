// Tests for closed_loop/recordings/alignment.c

#include "closed_loop/recordings/alignment.h"

#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>

#define TOOTH_m 0.09

enum { ROWS_MAX = 2700 };

static double progress[ROWS_MAX];

// Down and then along: 0.6 s at 0.05 m/s, 2 s at 0.0463 m/s, a turn of 0.3 rad/s in the last.
static const struct dig_trajectory dug = { "dug",
                                           -0.26,
                                           0.08,
                                           0.17,
                                           3,
                                           { { "in", 0.6, 0.03, -0.04, 0.0 },
                                             { "drag", 1.0, 0.0463, 0.0, 0.0 },
                                             { "turn", 1.0, 0.0, 0.0, 0.3 } } };

static const struct dig_alignment_target still = { &dug, TOOTH_m, 0.0, 0.0 };

static double way_m(const double t_s)
{
    const double drag_s = fmin(fmax(t_s - 0.6, 0.0), 1.0);
    const double turn_s = fmax(t_s - 1.6, 0.0);
    return 0.05 * fmin(t_s, 0.6) + 0.0463 * drag_s + TOOTH_m * 0.3 * turn_s;
}

struct scatter {
    double pin_m, theta_deg;
};

// The dig from one time of it to another, somewhere else, the poses read with noise.
static struct dig_recording drive(const double from_s, const double to_s, const double rate_Hz,
                                  const struct scatter *const noise)
{
    const size_t         rows  = (size_t)((to_s - from_s) * rate_Hz) + 1;
    struct dig_recording r     = { rows, calloc(rows, sizeof *r.row) };
    uint64_t             state = 17;
    assert_true(rows <= ROWS_MAX);
    for (size_t i = 0; i < rows; i++) {
        const double          t_s  = from_s + (double)i / rate_Hz;
        const struct dig_pose pose = dig_trajectory_pose(&dug, t_s);

        r.row[i].t_s     = t_s;
        r.row[i].pin_x_m = pose.x_m + 3.0 + noise->pin_m * model_normal(&state);
        r.row[i].pin_z_m = pose.z_m - 1.0 + noise->pin_m * model_normal(&state);
        r.row[i].theta_deg =
            pose.theta_rad / DIG_RAD_PER_DEG + noise->theta_deg * model_normal(&state);
    }
    return r;
}

static const struct scatter clean = { 0.0, 0.0 };
static const struct scatter real  = { 5e-5, 0.05 };

// Added up step by step the noise alone would make this way five times as long.
TEST(noise_of_the_path_makes_no_way)
{
    const struct scatter *const noises[] = { &clean, &real };
    for (int n = 0; n < 2; n++) {
        struct dig_recording r = drive(0.0, 2.6, 1000.0, noises[n]);
        assert_close(dig_alignment_progress(&r, TOOTH_m, progress) / way_m(2.6), 1.0,
                     n == 0 ? 0.01 : 0.2);
        for (size_t i = 0; i < r.rows; i++) {
            assert_close(progress[i], way_m(r.row[i].t_s) / way_m(2.6), n == 0 ? 0.003 : 0.015);
            assert_true(i == 0 || progress[i] >= progress[i - 1]);
        }
        assert_close(progress[r.rows - 1], 1.0, 1e-12);
        dig_recording_finish(&r);
    }
}

static void expect_part(const double from_s, const double to_s, const struct scatter *const noise,
                        const double within)
{
    struct dig_recording r = drive(from_s, to_s, 200.0, noise);
    (void)dig_alignment_progress(&r, TOOTH_m, progress);
    const struct dig_alignment_part part = dig_alignment_align(&r, progress, &still);
    assert_close(part.from, way_m(from_s) / way_m(2.6), within);
    assert_close(part.to, way_m(to_s) / way_m(2.6), within);
    assert_true(part.off < 0.004);
    dig_recording_finish(&r);
}

TEST(what_a_recording_lacks_is_told_by_the_poses)
{
    expect_part(0.0, 2.6, &clean, 1e-12);
    expect_part(0.0, 2.6, &real, 1e-12);
    expect_part(0.0, 2.4, &clean, 0.004);
    expect_part(0.2, 2.6, &clean, 0.004);
    expect_part(0.15, 2.3, &clean, 0.004);
    expect_part(0.15, 2.3, &real, 0.015);
    expect_part(0.0, 1.9, &clean, 0.004);
    expect_part(0.0, 1.5, &clean, 0.004);
    expect_part(0.5, 2.6, &clean, 0.004);
}

// What lacks more than is looked for is not taken for the most that may be lacking.
TEST(too_much_lacking_is_told)
{
    static const double to_s[] = { 2.4, 1.9, 1.5 };
    for (int i = 0; i < 3; i++) {
        struct dig_recording r = drive(0.0, to_s[i], 200.0, &real);
        (void)dig_alignment_progress(&r, TOOTH_m, progress);
        const struct dig_alignment_part part = dig_alignment_align(&r, progress, &still);
        assert_int_equal(dig_alignment_lacks_too_much(&part), way_m(to_s[i]) < 0.7 * way_m(2.6));
        dig_recording_finish(&r);
    }
}

// A path that is no part of the trajectory's is compared with all of it.
TEST(another_path_is_not_bent_to_fit)
{
    struct dig_recording r = drive(0.0, 2.6, 200.0, &clean);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].pin_z_m += 0.003 * sin(2.4 * r.row[i].t_s);
    }
    (void)dig_alignment_progress(&r, TOOTH_m, progress);
    const struct dig_alignment_part part  = dig_alignment_align(&r, progress, &still);
    struct dig_alignment_part       whole = { .to = 1.0 };
    dig_alignment_compare(&r, progress, &still, &whole);
    assert_close(part.from, 0.0, 0.0);
    assert_close(part.to, 1.0, 0.0);
    assert_close(part.off, whole.off, 1e-12);
    assert_true(part.off > 0.01);
    dig_recording_finish(&r);
}

// Of a turn beyond what the target allows the rest is distance.
TEST(a_turned_bucket_is_told_within_the_range)
{
    static const struct dig_alignment_target target = { &dug, TOOTH_m, -0.1, 0.1 };
    struct dig_recording                     r      = drive(0.0, 2.6, 200.0, &clean);
    (void)dig_alignment_progress(&r, TOOTH_m, progress);
    for (int turns = 1; turns <= 3; turns++) { // each by .06 rad
        for (size_t i = 0; i < r.rows; i++) {
            r.row[i].theta_deg += 0.06 / DIG_RAD_PER_DEG;
        }
        const struct dig_alignment_part part = dig_alignment_align(&r, progress, &target);
        assert_close(part.turned_rad, fmin(0.06 * turns, 0.1), 0.001);
        assert_close(part.off, fmax(0.06 * turns - 0.1, 0.0), 0.002);
        assert_close(part.to - part.from, 1.0, 0.0);
    }
    dig_recording_finish(&r);
}

// What is missing is told beside a turn, too.
TEST(a_part_of_a_turned_dig_is_told)
{
    static const struct dig_alignment_target target = { &dug, TOOTH_m, -0.2, 0.2 };
    struct dig_recording                     r      = drive(0.15, 2.3, 200.0, &clean);
    (void)dig_alignment_progress(&r, TOOTH_m, progress);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].theta_deg -= 0.1 / DIG_RAD_PER_DEG;
    }
    const struct dig_alignment_part part = dig_alignment_align(&r, progress, &target);
    assert_close(part.from, way_m(0.15) / way_m(2.6), 0.01);
    assert_close(part.to, way_m(2.3) / way_m(2.6), 0.01);
    assert_close(part.turned_rad, -0.1, 0.005);
    dig_recording_finish(&r);
}
