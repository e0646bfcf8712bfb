// Tests for offline_dem/sweep/sweep.c and worker.c, with an engine that takes no time.

#include "offline_dem/sweep/sweep.h"

#include "tests/tables_fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <time.h>

// What the engine shall do wrong; workers inherit it when they are forked.
enum mischief {
    NONE,
    DIE_ONCE,        // the second dig of a bed kills its worker, the first time
    DIE_ALWAYS,      // in gravel of friction .5, whenever it is poured
    FAIL,            // in gravel of friction .5
    GIVE_NAN,        // in gravel of friction .5
    DAWDLE,          // a minute a dig, telling progress
    SLEEP,           // a minute a dig, saying nothing
    REFUSE_TO_START, // the test fails when a worker is begun at all
};
static enum mischief mischief;

// Every call of the engine leaves a letter in this file, whatever becomes of its worker.
static void leave_mark(const char mark)
{
    const int fd = open(scratch_path("marks"), O_WRONLY | O_CREAT | O_APPEND, 0666);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, &mark, 1), 1);
    (void)close(fd);
}

static size_t marks(const char mark)
{
    if (!scratch_exists("marks")) {
        return 0;
    }
    size_t      size = 0, count = 0;
    char *const text = scratch_read(scratch_path("marks"), &size);
    for (size_t i = 0; i < size; i++) {
        count += text[i] == mark;
    }
    free(text);
    return count;
}

// True for one worker only, however many ask.
static bool is_first(void)
{
    const int fd = open(scratch_path("first"), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd >= 0) {
        (void)close(fd);
    }
    return fd >= 0;
}

static bool is_marked_gravel(const struct dig_gravel *const gravel)
{
    return gravel->value[DIG_AXIS_FRICTION] > .4;
}

static enum dig_status fake_pour(const struct dig_scene *const  scene,
                                 const struct dig_gravel *const gravel, const uint64_t seed,
                                 const struct dig_progress *const progress,
                                 struct dig_bed *const bed, struct dig_error *const error)
{
    (void)scene;
    (void)error;
    leave_mark(mischief == REFUSE_TO_START ? '!' : 'p');
    if (mischief == DIE_ALWAYS && is_marked_gravel(gravel)) {
        (void)raise(SIGKILL);
    }
    assert_true(progress->report(progress->context, 0.1, 0.2) != 0);
    bed->grains = (size_t)(seed % 1000);
    return DIG_OK;
}

// The moment of a bed's dig: anything that follows from seed, gravel and trajectory.
static double moment_of(const struct dig_gravel *const gravel, const size_t grains,
                        const struct dig_trajectory *const t)
{
    return gravel->value[DIG_AXIS_FRICTION] + 0.001 * (double)grains + (double)(t->phases) +
           t->theta0_rad;
}

static enum dig_status
fake_dig(const struct dig_scene *const scene, const struct dig_gravel *const gravel,
         const struct dig_bed *const bed, const struct dig_trajectory *const t,
         const char *const vtk_dir, const struct dig_progress *const progress,
         struct dig_recording *const recording, struct dig_error *const error)
{
    (void)scene;
    assert_null(vtk_dir);
    leave_mark('d');
    if (mischief == DIE_ONCE && t->phases == 2 && is_first()) {
        leave_mark('k');
        (void)raise(SIGKILL);
    }
    if (mischief == FAIL && is_marked_gravel(gravel)) {
        return dig_error_set(error, DIG_EINVAL, "the grains have gone on strike");
    }
    if (mischief == SLEEP) {
        (void)sleep(60);
    }
    for (int i = 0; mischief == DAWDLE && i < 6000; i++) {
        const struct timespec wait = { .tv_nsec = 10000000 };
        (void)nanosleep(&wait, NULL);
        (void)progress->report(progress->context, i, 6000);
    }
    const size_t               rows = t->phases == 1 ? 400 : 200;
    const double               my   = moment_of(gravel, bed->grains, t);
    const struct dig_recording made = fixture_recording(
        rows, mischief == GIVE_NAN && is_marked_gravel(gravel) ? (double)NAN : my);
    recording->row = malloc(rows * sizeof *recording->row);
    assert_non_null(recording->row);
    memcpy(recording->row, made.row, rows * sizeof *recording->row);
    recording->rows = rows;
    return DIG_OK;
}

static void fake_bed_finish(struct dig_bed *const bed)
{
    *bed = (struct dig_bed){ 0 };
}

// The effect sets the first trajectory's angle: any change that shows.
static enum dig_status fake_vary(const struct dig_scene *const scene,
                                 const enum dig_effect_id effect, const double magnitude,
                                 struct dig_scene *const varied, struct dig_error *const error)
{
    if (magnitude > 90.0) {
        return dig_error_set(error, DIG_EINVAL, "%s %g: too much", dig_effect_name(effect),
                             magnitude);
    }
    *varied                          = *scene;
    varied->trajectory[0].theta0_rad = magnitude;
    return DIG_OK;
}

static const struct dig_engine engine = { "fake",   "3.1",           fake_pour,
                                          fake_dig, fake_bed_finish, fake_vary };

// Two frictions by three rolling frictions.
static struct dig_plan plan_of(const size_t packings)
{
    static struct dig_plan_point point[6];
    static const double          rolling[] = { .1, .2, .4 };
    for (size_t i = 0; i < 6; i++) {
        point[i] = (struct dig_plan_point){ .gravel = { { i < 3 ? .3 : .5, rolling[i % 3], 2500 } },
                                            .packings = packings };
    }
    return (
        struct dig_plan){ .points = 6, .point = point, .trajectories = 2, .trajectory = { 0, 1 } };
}
#define DIGS_A_PACKING ((size_t)12)

struct outcome {
    enum dig_status        status;
    struct dig_sweep_state state;
    struct dig_error       error;
};

static struct outcome sweep(const char *const name, const size_t packings,
                            const struct dig_sweep_options *const options)
{
    struct outcome          o     = { .status = DIG_OK };
    const struct dig_scene  scene = fixture_scene();
    const struct dig_plan   plan  = plan_of(packings);
    struct dig_store *const store = fixture_create(name);
    o.status = dig_sweep_run(&scene, &plan, &engine, options, store, &o.state, &o.error);
    dig_store_close(store);
    return o;
}

static struct outcome sweep_by(const char *const name, const size_t packings, const size_t workers)
{
    const struct dig_sweep_options options = { .workers      = workers,
                                               .time_limit_s = (double)INFINITY };
    return sweep(name, packings, &options);
}

struct tally {
    size_t runs;
    double sum;
};

static enum dig_status check_run(void *const context, const struct dig_run *const run,
                                 struct dig_error *const error)
{
    (void)error;
    struct tally *const          tally = context;
    const struct dig_scene       scene = fixture_scene();
    const struct dig_run_origin *o     = &run->origin;
    assert_true(o->seed == dig_bed_seed(&o->gravel, o->packing));
    assert_int_equal(o->grains, o->seed % 1000);
    assert_string_equal(o->engine, "fake");
    assert_string_equal(o->version, "3.1");
    assert_int_equal(strlen(o->made_utc), 20);
    assert_close((double)run->value[7],
                 moment_of(&o->gravel, o->grains, &scene.trajectory[o->trajectory]), 1e-6);
    tally->runs++;
    tally->sum += (double)run->value[7];
    return DIG_OK;
}

// The table is sound, each run in it is what the engine gives for its seed, and none is there
// twice.
static struct tally check_table(const char *const name)
{
    struct dig_store *store = NULL;
    assert_int_equal(dig_store_open(scratch_path(name), &store, NULL), DIG_OK);
    struct tally                 tally   = { .runs = 0 };
    const struct dig_run_visitor visitor = { check_run, &tally };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    struct dig_store_report report = { .entries = 0 };
    struct dig_error        error  = { "" };
    if (tally.runs > 0 && dig_store_check(store, &report, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    assert_int_equal(report.runs, tally.runs);
    dig_store_close(store);
    return tally;
}

static int before_each(void **state)
{
    (void)state;
    mischief = NONE;
    (void)unlink(scratch_path("marks"));
    (void)unlink(scratch_path("first"));
    return 0;
}

// No process and no descriptor is left over.
static size_t open_descriptors(void)
{
    size_t open_now = 0;
    for (int fd = 0; fd < 256; fd++) {
        open_now += fcntl(fd, F_GETFD) >= 0;
    }
    return open_now;
}

static void every_dig_is_done_once_on_any_number_of_workers(void **state)
{
    (void)state;
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

static void what_is_there_is_not_begun_again(void **state)
{
    (void)state;
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

static void a_killed_worker_costs_its_unfinished_dig_only(void **state)
{
    (void)state;
    mischief               = DIE_ONCE;
    const struct outcome o = sweep_by("killed.sqlite", 1, 2);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, DIGS_A_PACKING);
    assert_int_equal(check_table("killed.sqlite").runs, DIGS_A_PACKING);
    assert_int_equal(marks('k'), 1);
    assert_int_equal(marks('p'), DIGS_A_PACKING / 2 + 1); // its bed was poured again,
    assert_int_equal(marks('d'), DIGS_A_PACKING + 1);     // its first dig was not dug again
}

static void beds_that_cannot_be_dug_are_told_and_the_others_are_dug(void **state)
{
    (void)state;
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

static void a_killed_sweep_takes_its_workers_along_and_is_resumed(void **state)
{
    (void)state;
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

static void a_stop_keeps_what_is_finished_and_ends_at_once(void **state)
{
    (void)state;
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

static enum dig_status note_moment(void *const context, const struct dig_run *const run,
                                   struct dig_error *const error)
{
    (void)error;
    double *const seen                          = context;
    seen[run->origin.effect[0] != '\0' ? 1 : 0] = (double)run->value[7];
    return DIG_OK;
}

static void after_the_time_limit_nothing_is_begun(void **state)
{
    (void)state;
    const struct dig_sweep_options options = { .workers = 2, .time_limit_s = 0.0 };
    const struct outcome           o       = sweep("limit.sqlite", 1, &options);
    assert_int_equal(o.status, DIG_OK);
    assert_int_equal(o.state.digs_done, 0);
    assert_int_equal(o.state.digs_total, DIGS_A_PACKING);
    assert_int_equal(marks('p'), 0);
}

// The moment is that of the varied scene: the engine was given it.
static void an_effect_is_put_into_the_scene_of_its_beds_alone(void **state)
{
    (void)state;
    const struct dig_scene      scene    = fixture_scene();
    const struct dig_plan_point points[] = {
        { .gravel = { { .3, .2, 2500 } }, .packings = 1 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "cohesion", .magnitude = 7, .packings = 1 },
        { .gravel = { { .3, .2, 2500 } }, .effect = "cohesion", .magnitude = 99, .packings = 1 },
    };
    const struct dig_plan          plan    = { .points = 3, .point = points, .trajectories = 1 };
    const struct dig_sweep_options options = { .workers = 2, .time_limit_s = (double)INFINITY };
    struct dig_sweep_state         st      = { .failed = 0 };
    struct dig_error               error   = { "" };
    struct dig_store              *store   = fixture_create("vary.sqlite");
    assert_int_equal(dig_sweep_run(&scene, &plan, &engine, &options, store, &st, &error), DIG_EIO);
    assert_contains(error.text, "2500 kg/m3, cohesion 99, packing 0: cohesion 99: too much");
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

static void progress_is_told_after_each_dig(void **state)
{
    (void)state;
    struct told                    told    = { .times = 0 };
    const struct dig_sweep_options options = {
        .workers = 2, .time_limit_s = (double)INFINITY, .report = listen_to, .context = &told
    };
    assert_int_equal(sweep("told.sqlite", 1, &options).status, DIG_OK);
    assert_true(told.times >= DIGS_A_PACKING);
    assert_int_equal(told.done, DIGS_A_PACKING);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(every_dig_is_done_once_on_any_number_of_workers, before_each),
        cmocka_unit_test_setup(what_is_there_is_not_begun_again, before_each),
        cmocka_unit_test_setup(a_killed_worker_costs_its_unfinished_dig_only, before_each),
        cmocka_unit_test_setup(beds_that_cannot_be_dug_are_told_and_the_others_are_dug,
                               before_each),
        cmocka_unit_test_setup(a_killed_sweep_takes_its_workers_along_and_is_resumed, before_each),
        cmocka_unit_test_setup(a_stop_keeps_what_is_finished_and_ends_at_once, before_each),
        cmocka_unit_test_setup(after_the_time_limit_nothing_is_begun, before_each),
        cmocka_unit_test_setup(an_effect_is_put_into_the_scene_of_its_beds_alone, before_each),
        cmocka_unit_test_setup(progress_is_told_after_each_dig, before_each),
    };
    return cmocka_run_group_tests_name("sweep", tests, scratch_setup, scratch_teardown);
}
