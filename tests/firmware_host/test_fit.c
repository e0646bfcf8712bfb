// Tests for firmware_host/matching/fit.c: which digs identify. What it makes of several, of digs of
// several depths, and over a restart: test_fit_ground.c, test_fit_as_dug.c, test_fit_state.c.

#include "tests/firmware_host/fit_bench.h"

TEST(a_simple_dig_identifies_the_gravel_it_was_made_of)
{
    struct bench *const b = bench_create();
    for (int gravel = 0; gravel < GRAVELS; gravel++) {
        struct dig_fit_result result;
        b->fit.track = (struct dig_gravel_track){ .any = false };
        bench_dig(b, gravel, 0, 1.0);
        const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
        assert_non_null(basis);
        assert_true(basis->known && basis->set == &b->cube.set && basis->generation == 1);
        assert_int_equal(basis->dig_count, 5);
        assert_true(basis->forecast.expected[0].valid);
        assert_false(basis->forecast.expected[1].valid); // the table has no such curve
        assert_true(dig_ring_pop(&b->wires.handoffs.results, &result));
        assert_true(result.track.valid && !result.track.restored);
        assert_int_equal(result.track.match.nearest, gravel);
        assert_string_equal(result.track.trajectory, "simpleA");
        assert_int_equal(result.track.match.digs, 1);
        assert_close(result.track.path_measured, 1.0, 0.0);
        assert_string_equal(result.hint_trajectory, ""); // nor says it what a bucket carries
    }
    assert_int_equal(atomic_load(&b->fit.count.matches), GRAVELS);
    assert_false(dig_fit_once(&b->fit));
    free(b);
}

TEST(a_dig_that_does_not_identify_is_passed_over)
{
    struct bench *const b = bench_create();
    struct dig_log_line note;
    bench_dig(b, 0, 1, 1.0);
    assert_null(dig_latest_look(&b->wires.handoffs.basis));
    assert_false(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_int_equal(atomic_load(&b->fit.count.matches), 0);
    free(b);
}

TEST(a_dig_the_table_has_no_curve_for_is_said_and_matches_nothing)
{
    struct bench *const b = bench_create();
    struct dig_log_line note;
    (void)strcpy(b->config.identify_trajectory[0], "actual");
    b->config.identify_trajectories = 1;
    bench_dig(b, 0, 1, 1.0);
    assert_null(dig_latest_look(&b->wires.handoffs.basis));
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_non_null(strstr(note.text, "dig 5 (actual): no match"));
    free(b);
}

TEST(a_dig_broken_off_leaves_what_is_known)
{
    struct bench *const    b   = bench_create();
    struct dig_observation dig = bench_observation(7, 1.0);
    bench_dig(b, 3, 0, 1.0);
    dig.dig_count = 6;
    dig.last      = 0.59;
    dig_fit_take(&b->fit, &dig);
    assert_int_equal(b->fit.track.match.dig_count, 5);
    struct dig_log_line note;
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_non_null(strstr(note.text, "59 % of its path was measured, expected at least 60 %"));

    dig.last = 0.61;
    dig_fit_take(&b->fit, &dig);
    assert_int_equal(b->fit.track.match.dig_count, 6);
    free(b);
}

// Told and counted by how they ended; that a dig was aborted changes nothing of what it tells.
TEST(how_digs_ended_is_told_and_changes_no_number)
{
    struct bench *const    b    = bench_create();
    struct bench *const    same = bench_create();
    struct dig_observation dig  = bench_observation(5, 1.0);
    struct dig_log_line    note;
    dig.last = 0.7;
    dig_fit_take(&same->fit, &dig);
    assert_int_equal(same->fit.track.ending, DIG_ENDING_OPEN);
    assert_false(dig_latest_take(&same->wires.handoffs.fit_log, &note));

    dig.ending = DIG_ENDING_ABORTED;
    dig_fit_take(&b->fit, &dig);
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_string_equal(note.text, "dig 5 (simpleA): aborted at 70 % of its path");
    assert_int_equal(b->fit.track.ending, DIG_ENDING_ABORTED);
    assert_close(b->fit.track.path_measured, 0.7, 0.0);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(b->fit.track.match.low.value[a], same->fit.track.match.low.value[a], 0.0);
        assert_close(b->fit.track.match.high.value[a], same->fit.track.match.high.value[a], 0.0);
    }
    dig.last       = 0.5;
    dig.trajectory = 1;
    dig_fit_take(&b->fit, &dig);
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_string_equal(note.text, "dig 5 (actual): aborted at 50 % of its path");
    dig.trajectory = 0;
    dig_fit_take(&b->fit, &dig);
    assert_true(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_non_null(strstr(note.text, "aborted, no match, 50 % of its path"));

    dig.last   = 1.0;
    dig.ending = DIG_ENDING_WHOLE;
    dig_fit_take(&b->fit, &dig);
    assert_int_equal(b->fit.track.ending, DIG_ENDING_WHOLE);
    assert_false(dig_latest_take(&b->wires.handoffs.fit_log, &note));
    assert_int_equal(atomic_load(&b->fit.count.whole), 1);
    assert_int_equal(atomic_load(&b->fit.count.aborted), 3);
    assert_int_equal(atomic_load(&b->fit.count.unknown), 0);
    free(same);
    free(b);
}
