// Tests for estimator/estimator.c: whole digs, from pressures to what is told of them.

#include "tests/driven.h"
#include "tests/testlib.h"

#include <stdlib.h>

// simpleA, as Froude has it, by perfect sensors.
static const struct drive calm = {
    .which = MADE_SIMPLE_A, .stretch = 1.0, .until = 1.0, .seed = 1
};
// Slowly, with a pause, by real sensors, of which a fifth of the samples is lost.
static const struct drive all_of_it = {
    .which   = MADE_ACTUAL,
    .stretch = 1.7,
    .pause_s = 3,
    .until   = 1,
    .drop    = 0.2,
    .sensors = true,
    .seed    = 3,
};

// The family's forces are -8 and 5 times its moment; so must those observed be, everywhere.
static double worst_force(const struct driven *const b)
{
    static const double by[]  = { -8.0, 5.0 };
    double              worst = 0.0;
    for (int c = 0; c < 2; c++) {
        double largest = 0.0, off = 0.0;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const double expected_N = by[c] * b->observation.moment_Nm[k];
            largest                 = fmax(largest, fabs(expected_N));
            off                     = fmax(off, fabs(b->observation.force_N[c][k] - expected_N));
        }
        worst = fmax(worst, off / largest);
    }
    return worst;
}

TEST(every_kind_of_dig_is_observed_as_it_was)
{
    const struct {
        const char  *name;
        double       error;
        struct drive drive;
    } cases[] = {
        { "simpleA", 0.002, calm },
        { "simpleB", 0.002, { .which = MADE_SIMPLE_B, .stretch = 1, .until = 1, .seed = 1 } },
        { "actual", 0.002, { .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 1 } },
        { "slow", 0.002, { .which = MADE_SIMPLE_A, .stretch = 2.5, .until = 1, .seed = 1 } },
        { "fast", 0.002, { .which = MADE_ACTUAL, .stretch = 0.6, .until = 1, .seed = 1 } },
        { "paused",
          0.002,
          { .which = MADE_SIMPLE_A, .stretch = 1, .pause_s = 8, .until = 1, .seed = 1 } },
        { "stepped back",
          0.002,
          { .which = MADE_ACTUAL, .stretch = 1, .back_s = 0.2, .until = 1, .seed = 1 } },
        { "sensors",
          0.02,
          { .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .sensors = true, .seed = 2 } },
        { "all of it", 0.01, all_of_it },
        { "broken off", 0.002, { .which = MADE_SIMPLE_A, .stretch = 1, .until = 0.7, .seed = 1 } },
        { "aborted", 0.002, { .which = MADE_ACTUAL, .stretch = 1, .until = 0.6, .seed = 1 } },
    };
    // simpleB and actual are one until the first turns on (40 % of its way is the shared turn) and
    // the other drags.
    const double known_before[MADE_TRAJECTORIES] = { 0.2, 0.75, 0.35 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct driven *const b = driven_create(cases[i].drive.sensors);
        driven_dig(b, cases[i].drive);
        const double error = driven_error(b, cases[i].drive.until);
        print_message("%-12s: error %.4f, off path %.2f mm, %.3f to %.3f, known from %.3f, "
                      "progress within %.3f\n",
                      cases[i].name, error, 1e3 * b->observation.off_path_m, b->observation.first,
                      b->observation.last, b->known_from, b->worst_progress);
        assert_int_equal(b->observations, 1);
        assert_int_equal(b->observation.trajectory, cases[i].drive.which);
        assert_int_equal(b->observation.dig_count, 1);
        assert_true(error < cases[i].error);
        print_message("              forces within %.4f\n", worst_force(b));
        assert_true(b->observation.forces);
        assert_true(worst_force(b) < (cases[i].drive.sensors ? 0.1 : 0.001));
        assert_close(b->observation.first, 0.0, 0.0);
        assert_close(b->observation.last, cases[i].drive.until, 0.03);
        assert_true(b->observation.off_path_m < 0.001);
        assert_int_equal(b->observation.ending,
                         cases[i].drive.until < 1 ? DIG_ENDING_ABORTED : DIG_ENDING_WHOLE);
        assert_int_equal(b->known_at_end, cases[i].drive.which);
        assert_true(b->known_from < known_before[cases[i].drive.which]);
        assert_true(b->worst_progress < 0.03);
        driven_destroy(b);
    }
}

// What a dig looked like before it was over is what it turns out to have been, as far as it was
// dug; never a progress that no sample after it had smoothed. Which dig it is may not be known yet.
TEST(a_dig_going_on_is_observed_as_it_will_have_been)
{
    const struct {
        struct drive drive;
        int          known_from;
    } cases[] = {
        { calm, 0 },
        { { .which = MADE_SIMPLE_A, .stretch = 2.5, .pause_s = 8, .until = 1, .seed = 1 }, 0 },
        { all_of_it, 1 },
        { { .which = MADE_SIMPLE_B, .stretch = 1, .until = 1, .sensors = true, .seed = 1 }, 3 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct drive *const drive = &cases[i].drive;
        struct driven *const      b     = driven_create(drive->sensors);
        b->live                         = calloc(1, sizeof *b->live);
        dig_live_recording_clear(b->live, b->set);
        driven_dig(b, *drive);
        assert_int_equal(b->observations, 1);
        assert_int_equal(b->earlies, DRIVEN_LOOKS);
        assert_false(b->live->digging);
        for (int s = 0; s < DRIVEN_LOOKS; s++) {
            const struct dig_observation *const o = &b->early[s];
            if (s < cases[i].known_from) {
                continue;
            }
            assert_int_equal(o->trajectory, (int)drive->which);
            assert_int_equal(o->dig_count, 1);
            assert_int_equal(o->ending, DIG_ENDING_OPEN);
            const struct dig_trajectory t       = made_trajectory(drive->which);
            const double                tooth_m = b->set->tooth_m, at = driven_look_at[s];
            const double smoothed_s = dig_trajectory_time_s(&t, tooth_m, at) - DIG_SMOOTH_HALF_s;
            const double half       = at - dig_trajectory_path_m(&t, tooth_m, smoothed_s) /
                                         dig_trajectory_path_m(&t, tooth_m, 1e3);
            print_message("case %zu, %.2f of the path: %.3f to %.3f, half a window is %.3f\n", i,
                          at, o->first, o->last, half);
            assert_true(o->last <= at - half + 0.01 && o->last > at - half - 0.03);
            double miss2 = 0.0, whole2 = 0.0;
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                if (k / 255.0 >= o->first && k / 255.0 <= o->last) {
                    miss2 += pow(o->moment_Nm[k] - b->observation.moment_Nm[k], 2.0);
                    whole2 += pow(b->observation.moment_Nm[k], 2.0);
                }
            }
            print_message("    off what it turned out to be by %.4f\n", sqrt(miss2 / whole2));
            assert_true(sqrt(miss2 / whole2) < 0.02);
        }
        driven_destroy(b);
    }
}

// Slower than the window holds: every other sample is kept, and again.
TEST(a_dig_longer_than_the_window_is_still_observed)
{
    struct driven *const b = driven_create(false);
    driven_dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 24, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_true(driven_error(b, 1.0) < 0.01);
    driven_destroy(b);
}

// Who took the last dig keeps it: the next goes into no memory, and is counted.
TEST(a_dig_without_memory_for_the_next_is_lost_and_counted)
{
    const struct drive   drive = { .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .seed = 2 };
    struct driven *const b     = driven_create(true);
    driven_dig(b, drive);
    assert_int_equal(dig_estimator_lost_digs(b->estimator), 0);
    b->keeps = true;
    driven_dig(b, drive);
    driven_dig(b, drive);
    assert_int_equal(b->observations, 2);
    assert_int_equal(dig_estimator_lost_digs(b->estimator), 1);
    driven_destroy(b);
}
