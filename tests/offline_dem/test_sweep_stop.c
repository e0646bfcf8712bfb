// Tests for offline_dem/sweep/sweep.c: a sweep that is killed, stopped or out of time

#include "offline_dem/sweep/sweep.h"

#include "tests/offline_dem/fake_engine.h"
#include "tests/tables_fixture.h"

#include <poll.h>
#include <sys/wait.h>
#include <time.h>

TEST_WITH(a_killed_sweep_takes_its_workers_along_and_is_resumed, before_each, NULL)
{
    assert_int_equal(sweep_by("parent.sqlite", 1, 2).status, DIG_OK);
    mischief = SLEEP;
    int alive[2]; // its other end is open as long as one of them lives
    assert_int_equal(pipe(alive), 0);
    const pid_t child = fork();
    if (child == 0) {
        (void)sweep_by("parent.sqlite", 2, 3);
        _exit(0);
    }
    (void)close(alive[1]);
    const struct timespec wait = { .tv_nsec = 20000000 };
    for (int i = 0; i < 500 && marks('d') < DIGS_A_PACKING + 3; i++) {
        (void)nanosleep(&wait, NULL);
    }
    assert_int_equal(marks('d'), DIGS_A_PACKING + 3); // its three workers dig
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, NULL, 0), child);

    struct pollfd all_gone = { .fd = alive[0], .events = POLLIN };
    assert_int_equal(poll(&all_gone, 1, 10000), 1);
    (void)close(alive[0]);

    mischief               = NONE;
    const struct outcome o = sweep_by("parent.sqlite", 2, 3);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, 2 * DIGS_A_PACKING);
    assert_int_equal(check_table("parent.sqlite").runs, 2 * DIGS_A_PACKING);
    assert_int_equal(marks('d'), 2 * DIGS_A_PACKING + 3);
}

static volatile sig_atomic_t stop;

static void stop_it(const int signal)
{
    (void)signal;
    stop = 1;
}

struct told {
    size_t times, done;
    double most_under_way;
};

static void listen_to(void *const context, const struct dig_sweep_state *const s)
{
    struct told *const told = context;
    told->times++;
    assert_true(s->digs_done >= told->done);
    assert_true(s->digs_under_way >= 0.0 && s->digs_under_way <= 2.0 * (double)s->workers);
    told->done           = s->digs_done;
    told->most_under_way = fmax(told->most_under_way, s->digs_under_way);
}

TEST_WITH(a_stop_keeps_what_is_finished_and_ends_at_once, before_each, NULL)
{
    assert_int_equal(sweep_by("stop.sqlite", 1, 2).status, DIG_OK);
    mischief                                = DAWDLE;
    stop                                    = 0;
    struct told                    told     = { .times = 0 };
    const struct sigaction         on_alarm = { .sa_handler = stop_it };
    struct sigaction               before   = { .sa_handler = SIG_DFL };
    const struct dig_sweep_options options  = { .workers      = 2,
                                                .time_limit_s = (double)INFINITY,
                                                .stop         = &stop,
                                                .report       = listen_to,
                                                .context      = &told };
    assert_int_equal(sigaction(SIGALRM, &on_alarm, &before), 0);
    (void)alarm(2); // progress is told every second
    const time_t         from = time(NULL);
    const struct outcome o    = sweep("stop.sqlite", 2, &options);
    assert_int_equal(sigaction(SIGALRM, &before, NULL), 0);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, DIGS_A_PACKING);
    assert_int_equal(o.state.digs_total, 2 * DIGS_A_PACKING);
    assert_true(time(NULL) - from < 30); // a dig would take 60 s
    assert_true(told.most_under_way > 0.0);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(check_table("stop.sqlite").runs, DIGS_A_PACKING);
}

TEST_WITH(after_the_time_limit_nothing_is_begun, before_each, NULL)
{
    const struct dig_sweep_options options = { .workers = 2, .time_limit_s = 0.0 };
    const struct outcome           o       = sweep("limit.sqlite", 1, &options);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, 0);
    assert_int_equal(o.state.digs_total, DIGS_A_PACKING);
    assert_int_equal(marks('p'), 0);
}

TEST_WITH(progress_is_told_after_each_dig, before_each, NULL)
{
    struct told                    told    = { .times = 0 };
    const struct dig_sweep_options options = {
        .workers = 2, .time_limit_s = (double)INFINITY, .report = listen_to, .context = &told
    };
    assert_int_equal(sweep("told.sqlite", 1, &options).status, DIG_OK);
    assert_true(told.times >= DIGS_A_PACKING);
    assert_int_equal(told.done, DIGS_A_PACKING);
}

TESTS_WITH(scratch_setup, scratch_teardown)
