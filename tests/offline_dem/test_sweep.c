// Tests for offline_dem/sweep/sweep.c and worker.c, with an engine that takes no time.

#include "offline_dem/sweep/sweep.h"

#include "tests/offline_dem/fake_engine.h"
#include "tests/tables_fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/wait.h>

// No process and no descriptor is left over.
static size_t open_descriptors(void)
{
    size_t open_now = 0;
    for (int fd = 0; fd < 256; fd++) {
        open_now += fcntl(fd, F_GETFD) >= 0;
    }
    return open_now;
}

TEST_WITH(every_dig_is_done_once_on_any_number_of_workers, before_each, NULL)
{
    const size_t   before = open_descriptors();
    struct outcome o      = sweep_by("one.sqlite", 2, 1);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_total, 2 * DIGS_A_PACKING);
    assert_int_equal(o.state.digs_done, 2 * DIGS_A_PACKING);
    assert_int_equal(o.state.failed, 0);
    assert_int_equal(marks('p'), DIGS_A_PACKING);
    assert_int_equal(marks('d'), 2 * DIGS_A_PACKING);
    const struct tally one = check_table("one.sqlite");
    assert_int_equal(one.runs, 2 * DIGS_A_PACKING);

    o = sweep_by("many.sqlite", 2, 7);
    assert_int_equal(o.status, DIG_OK);
    const struct tally many = check_table("many.sqlite");
    assert_int_equal(many.runs, one.runs);
    assert_close(many.sum, one.sum, 0.0);

    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
    assert_int_equal(open_descriptors(), before);
}

TEST_WITH(what_is_there_is_not_begun_again, before_each, NULL)
{
    assert_int_equal(sweep_by("again.sqlite", 1, 2).status, DIG_OK);
    mischief         = REFUSE_TO_START;
    struct outcome o = sweep_by("again.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, DIGS_A_PACKING);
    assert_int_equal(marks('!'), 0);

    mischief = NONE;
    o        = sweep_by("again.sqlite", 2, 2);
    assert_int_equal(o.state.digs_done, 2 * DIGS_A_PACKING);
    assert_int_equal(marks('d'), 2 * DIGS_A_PACKING);
}

TEST_WITH(a_killed_worker_costs_its_unfinished_dig_only, before_each, NULL)
{
    mischief               = DIE_ONCE;
    const struct outcome o = sweep_by("killed.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, DIGS_A_PACKING);
    assert_int_equal(check_table("killed.sqlite").runs, DIGS_A_PACKING);
    assert_int_equal(marks('k'), 1);
    assert_int_equal(marks('p'), DIGS_A_PACKING / 2 + 1); // its bed was poured again,
    assert_int_equal(marks('d'), DIGS_A_PACKING + 1);     // its first dig was not dug again
}

TEST_WITH(beds_that_cannot_be_dug_are_told_and_the_others_are_dug, before_each, NULL)
{
    mischief         = DIE_ALWAYS;
    struct outcome o = sweep_by("dying.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_EIO);
    assert_contains(o.error.text, "friction 0.5");
    assert_contains(o.error.text, "killed by signal 9, twice");
    assert_int_equal(o.state.failed, DIGS_A_PACKING / 2);
    assert_int_equal(o.state.digs_done, DIGS_A_PACKING / 2);
    assert_int_equal(check_table("dying.sqlite").runs, DIGS_A_PACKING / 2);
    assert_int_equal(marks('p'), 3 + 2 * 3);

    mischief = FAIL;
    o        = sweep_by("failing.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_EIO);
    assert_contains(o.error.text, "packing 0: the grains have gone on strike");
    assert_int_equal(o.state.failed, DIGS_A_PACKING / 2);
    assert_int_equal(check_table("failing.sqlite").runs, DIGS_A_PACKING / 2);

    mischief = GIVE_NAN;
    o        = sweep_by("nan.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_EIO);
    assert_contains(o.error.text, "expected finite forces");
    assert_int_equal(o.state.failed, DIGS_A_PACKING / 2);
    assert_int_equal(check_table("nan.sqlite").runs, DIGS_A_PACKING / 2);

    mischief = NONE;
    assert_int_equal(sweep_by("nan.sqlite", 1, 2).status, DIG_OK);
    assert_int_equal(check_table("nan.sqlite").runs, DIGS_A_PACKING);
}

// The moment tells the scene's cohesion: the engine was given the varied one.
TEST_WITH(an_effect_is_put_into_the_scene_of_its_beds_alone, before_each, NULL)
{
    const struct dig_scene      scene    = fixture_scene();
    const struct dig_plan_point points[] = {
        { .gravel = { { .3, .2, 2500 } }, .packings = 1 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "cohesion", .magnitude = 7, .packings = 1 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "grain_shape", .magnitude = 99, .packings = 1 },
    };
    const struct dig_plan          plan    = { .points = 3, .point = points, .trajectories = 1 };
    const struct dig_sweep_options options = { .workers = 2, .time_limit_s = (double)INFINITY };
    struct dig_sweep_state         st      = { .failed = 0 };
    struct dig_error               error   = { "" };
    struct dig_store              *store   = fixture_create("vary.sqlite");
    assert_int_equal(dig_sweep_run(&scene, &plan, &engine, &options, store, &st, &error), DIG_EIO);
    assert_contains(error.text,
                    "2500 kg/m3, grain_shape 99, packing 0: grain_shape: 99 1, expected");
    assert_int_equal(st.digs_done, 2);
    assert_int_equal(st.failed, 1);
    dig_store_close(store);
    assert_int_equal(dig_store_open(scratch_path("vary.sqlite"), &store, NULL), DIG_OK);
    double                       seen[2] = { 0.0 };
    const struct dig_run_visitor visitor = { note_moment, seen };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    assert_close(seen[1] - seen[0], 7.0, 1e-5);
    dig_store_close(store);
}

TESTS_WITH(scratch_setup, scratch_teardown)
