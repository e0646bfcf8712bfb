// An engine that takes no time, for the tests of a sweep, and what a sweep with it did.

#ifndef DIG_TESTS_OFFLINE_DEM_FAKE_ENGINE_H
#define DIG_TESTS_OFFLINE_DEM_FAKE_ENGINE_H

#include "offline_dem/sweep/sweep.h"

#include "tests/tables_fixture.h"

#include <fcntl.h>
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
static inline void leave_mark(const char mark)
{
    const int fd = open(scratch_path("marks"), O_WRONLY | O_CREAT | O_APPEND, 0666);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, &mark, 1), 1);
    (void)close(fd);
}

static inline size_t marks(const char mark)
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
static inline bool is_first(void)
{
    const int fd = open(scratch_path("first"), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd >= 0) {
        (void)close(fd);
    }
    return fd >= 0;
}

static inline bool is_marked_gravel(const struct dig_gravel *const gravel)
{
    return gravel->value[DIG_AXIS_FRICTION] > .4;
}

static inline enum dig_status fake_pour(const struct dig_stepper *const stepper,
                                        const struct dig_scene *const   scene,
                                        const struct dig_gravel *const gravel, const uint64_t seed,
                                        const struct dig_progress *const progress,
                                        struct dig_bed *const bed, struct dig_error *const error)
{
    (void)stepper;
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
static inline double moment_of(const struct dig_gravel *const gravel, const size_t grains,
                               const struct dig_trajectory *const t)
{
    return gravel->value[DIG_AXIS_FRICTION] + 0.001 * (double)grains + (double)(t->phases) +
           t->theta0_rad;
}

static inline enum dig_status
fake_dig(const struct dig_stepper *const stepper, const struct dig_scene *const scene,
         const struct dig_gravel *const gravel, const struct dig_bed *const bed,
         const struct dig_trajectory *const t, const char *const vtk_dir,
         const struct dig_progress *const progress, struct dig_recording *const recording,
         struct dig_error *const error)
{
    (void)stepper;
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
    const double               my   = moment_of(gravel, bed->grains, t) + scene->laws.cohesion_Jpm3;
    const struct dig_recording made = fixture_recording(
        rows, mischief == GIVE_NAN && is_marked_gravel(gravel) ? (double)NAN : my);
    recording->row = malloc(rows * sizeof *recording->row);
    assert_non_null(recording->row);
    memcpy(recording->row, made.row, rows * sizeof *recording->row);
    recording->rows = rows;
    return DIG_OK;
}

static const struct dig_engine engine = {
    .name = "fake", .version = "3.1", .pour = fake_pour, .dig = fake_dig
};

// Two frictions by three rolling frictions.
static inline struct dig_plan plan_of(const size_t packings)
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

static inline struct outcome sweep(const char *const name, const size_t packings,
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

static inline struct outcome sweep_by(const char *const name, const size_t packings,
                                      const size_t workers)
{
    const struct dig_sweep_options options = { .workers      = workers,
                                               .time_limit_s = (double)INFINITY };
    return sweep(name, packings, &options);
}

struct tally {
    size_t runs;
    double sum;
};

static inline enum dig_status check_run(void *const context, const struct dig_run *const run,
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
static inline struct tally check_table(const char *const name)
{
    struct dig_store *store = NULL;
    assert_int_equal(dig_store_open(scratch_path(name), &store, NULL), DIG_OK);
    struct tally                 tally   = { .runs = 0 };
    const struct dig_run_visitor visitor = { check_run, &tally };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    struct dig_store_report report = { .entries = 0 };
    struct dig_error        error  = { "" };
    assert_ok(tally.runs > 0 && dig_store_check(store, &report, &error), error);
    assert_int_equal(report.runs, tally.runs);
    dig_store_close(store);
    return tally;
}

static inline int before_each(void **state)
{
    (void)state;
    mischief = NONE;
    (void)unlink(scratch_path("marks"));
    (void)unlink(scratch_path("first"));
    return 0;
}

static inline enum dig_status note_moment(void *const context, const struct dig_run *const run,
                                          struct dig_error *const error)
{
    (void)error;
    double *const seen                          = context;
    seen[run->origin.effect[0] != '\0' ? 1 : 0] = (double)run->value[7];
    return DIG_OK;
}

#endif // DIG_TESTS_OFFLINE_DEM_FAKE_ENGINE_H
