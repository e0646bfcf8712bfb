// Tests for firmware_host/tick/loop.c: the tick, with a real estimator and a table of formulas.

#include "firmware_host/tick/loop.h"

#include "tests/count_allocations.h"
#include "tests/firmware_host/loop_bench.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#define MS 1000000LL

static void a_whole_sample_becomes_an_estimate(void **state)
{
    (void)state;
    struct bench *const      b = bench_create();
    const struct dig_reading r = bench_still(1000 * MS);
    struct dig_record        record;
    assert_true(dig_ring_push(&b->wires.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.records, &record));
    assert_true(record.has_estimate);
    assert_true(record.estimate.time_ns == 1000 * MS);
    assert_close(record.sample.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8.4e6, 0.0);
    assert_false(dig_ring_pop(&b->wires.records, &record));
    const struct dig_tick_status tick_status = bench_tick_status(b);
    assert_true(tick_status.fresh);
    assert_int_equal(tick_status.ticks, 1);
    assert_int_equal(tick_status.missing, 0);
    bench_destroy(b);
}

// For who looks at the dig going on; when he does not keep up, nothing is counted as lost.
static void each_estimate_is_shared_and_none_waited_for(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_estimate estimate;
    for (int64_t i = 0; i < 11; i++) {
        struct dig_reading r = bench_still(1000 * MS + i * 5 * MS);
        if (i == 3) {
            r.state[DIG_SIGNAL_BUCKET_HEAD_Pa] = DIG_READING_NOT_AVAILABLE;
        }
        assert_true(dig_ring_push(&b->wires.readings, &r));
        dig_loop_tick(&b->loop, 1001 * MS + i * 5 * MS);
    }
    for (int64_t i = 0; i < 9; i++) {
        if (i != 3) {
            assert_true(dig_ring_pop(&b->wires.estimates, &estimate));
            assert_true(estimate.time_ns == 1000 * MS + i * 5 * MS);
        }
    }
    assert_false(dig_ring_pop(&b->wires.estimates, &estimate));
    assert_int_equal(bench_tick_status(b).lost, 0);
    bench_destroy(b);
}

static void a_sample_with_a_hole_is_passed_on_without_an_estimate(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_reading  r = bench_still(1000 * MS);

    r.state[DIG_SIGNAL_BUCKET_HEAD_Pa] = DIG_READING_NOT_AVAILABLE;
    struct dig_record record;
    assert_true(dig_ring_push(&b->wires.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.records, &record));
    assert_false(record.has_estimate);
    const struct dig_tick_status tick_status = bench_tick_status(b);
    assert_false(tick_status.fresh);
    assert_int_equal(tick_status.missing, 1);
    assert_int_equal(tick_status.drops.not_available, 1);
    bench_destroy(b);
}

static void without_a_pressure_of_the_arms_the_moment_is_told_and_no_force(void **state)
{
    (void)state;
    struct bench *const b           = bench_create();
    struct dig_reading  r           = bench_still(1000 * MS);
    r.state[DIG_SIGNAL_ARM_HEAD_Pa] = DIG_READING_ABSENT;
    struct dig_record record;
    assert_true(dig_ring_push(&b->wires.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.records, &record));
    assert_true(record.has_estimate);
    assert_true(record.estimate.wrench.moment_valid);
    assert_true(record.estimate.wrench.sigma_My_Nm > 0.0);
    assert_false(record.estimate.wrench.force_valid);
    assert_false(record.sample.valid[DIG_SIGNAL_ARM_HEAD_Pa]);
    assert_true(bench_tick_status(b).fresh);
    bench_destroy(b);
}

static void silence_is_missing_after_the_stale_time_only(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    dig_loop_tick(&b->loop, 995 * MS);
    assert_int_equal(bench_tick_status(b).missing, 1);
    const struct dig_reading r = bench_still(1000 * MS);
    assert_true(dig_ring_push(&b->wires.readings, &r));
    for (int64_t now = 1000; now <= 1200; now += 5) {
        dig_loop_tick(&b->loop, now * MS);
        assert_true(bench_tick_status(b).fresh == (now <= 1100));
    }
    assert_int_equal(b->loop.tick_status.missing, 1 + 20);
    bench_destroy(b);
}

static void a_publisher_that_does_not_keep_up_is_counted_not_waited_for(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    for (int64_t i = 0; i < 1100; i++) {
        const struct dig_reading r = bench_still(1000 * MS + i * 5 * MS);
        assert_true(dig_ring_push(&b->wires.readings, &r));
        dig_loop_tick(&b->loop, 1000 * MS + i * 5 * MS);
    }
    assert_int_equal(bench_tick_status(b).lost, 1100 - 1024);
    bench_destroy(b);
}

static void one_tick_takes_a_bounded_number_of_readings(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    for (int64_t i = 0; i < DIG_READINGS_PER_TICK + 10; i++) {
        const struct dig_reading r = bench_still(1000 * MS + i * MS);
        assert_true(dig_ring_push(&b->wires.readings, &r));
    }
    struct dig_record record;
    int               first = 0, second = 0;
    dig_loop_tick(&b->loop, 1300 * MS);
    while (dig_ring_pop(&b->wires.records, &record)) {
        first++;
    }
    dig_loop_tick(&b->loop, 1305 * MS);
    while (dig_ring_pop(&b->wires.records, &record)) {
        second++;
    }
    assert_int_equal(first, DIG_READINGS_PER_TICK);
    assert_int_equal(second, 10);
    bench_destroy(b);
}

// The bucket held in the air for two seconds; counts the outlooks, the valid ones by trajectory.
static int outlooks_in_the_air(struct bench *const b, const int64_t from_ms,
                               bool seen[DIG_TRAJECTORY_MAX])
{
    int                          outlooks = 0;
    struct dig_prediction_record predictions;
    for (int64_t i = 0; i < 400; i++) {
        const struct dig_reading r = bench_still((from_ms + i * 5) * MS);
        assert_true(dig_ring_push(&b->wires.readings, &r));
        dig_loop_tick(&b->loop, (from_ms + 1 + i * 5) * MS);
        if (dig_latest_take(&b->wires.predictions, &predictions)) {
            outlooks++;
            assert_true(predictions.prediction.valid);
            assert_int_equal(predictions.state, DIG_PREDICTION_VALID);
            assert_close(predictions.prediction.from_progress, 0.0, 0.0);
            assert_close(predictions.prediction.to_progress, 1.0, 0.0);
            assert_true(predictions.time_ns == (from_ms + i * 5) * MS);
            assert_true(predictions.expires_ns > predictions.time_ns);
            assert_int_equal(predictions.dig_count, 7);
            seen[predictions.prediction.trajectory] = true;
        }
    }
    return outlooks;
}

static void in_the_air_each_dig_is_predicted_whole_once_the_gravel_is_known(void **state)
{
    (void)state;
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    assert_int_equal(outlooks_in_the_air(b, 1000, seen), 0);
    bench_set_basis(b, &b->wires.basis, 3, 1, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 3000, seen), 3, 5);
    for (size_t t = 0; t < b->cube.set.trajectories; t++) {
        assert_true(seen[t]);
    }
    bench_destroy(b);
}

static void nothing_is_predicted_from_a_gravel_that_expired(void **state)
{
    (void)state;
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    bench_set_basis(b, &b->wires.basis, 3, 1, 2000 * MS);
    assert_in_range(outlooks_in_the_air(b, 1000, seen), 2, 3);
    assert_int_equal(outlooks_in_the_air(b, 3000, seen), 0);
    bench_destroy(b);
}

// Along the trajectory predicted last, of a gravel of the table.
static double peak_told_of(const struct bench *const b, const int gravel)
{
    static struct dig_forecast forecast;
    const struct dig_match     match = { .valid   = true,
                                         .gravel  = b->cube.gravel[gravel],
                                         .nearest = gravel };
    dig_forecast_make(&b->cube.set, 10.0, &match, &forecast);
    return forecast.expected[b->loop.published.prediction.trajectory].peak_Nm;
}

// Another table: what belongs to the one before is not used with it, and the other way round.
static void a_table_is_exchanged_with_the_forecast_that_belongs_to_it(void **state)
{
    (void)state;
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    bench_set_basis(b, &b->wires.basis, 3, 1, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 1000, seen), 3, 5);
    assert_int_equal(atomic_load(&b->loop.generation), 1);
    bench_set_basis(b, &b->wires.table, 5, 2, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 3000, seen), 3, 5);
    assert_int_equal(atomic_load(&b->loop.generation), 2);
    assert_int_equal(bench_tick_status(b).generation, 2);
    assert_close(b->loop.published.prediction.peak_Nm, peak_told_of(b, 5), 1e-9);
    bench_set_basis(b, &b->wires.basis, 3, 1, INT64_MAX); // late: of the table before
    assert_in_range(outlooks_in_the_air(b, 5000, seen), 3, 5);
    assert_close(b->loop.published.prediction.peak_Nm, peak_told_of(b, 5), 1e-9);
    assert_true(fabs(peak_told_of(b, 3) / peak_told_of(b, 5) - 1.0) > 0.1);
    bench_destroy(b);
}

// The moment that an estimator of the file's machine tells of a bucket held still, with a
// correction from the start or without, after so many samples.
static double moment_of_Nm(const struct bench *const b, const struct dig_correction *const by,
                           const int samples)
{
    struct dig_estimator *const e = calloc(1, dig_estimator_size());
    struct dig_estimate         estimate;
    assert_non_null(e);
    assert_int_equal(dig_estimator_init(e, &b->machine, &b->cube.set, &b->estimator_settings),
                     DIG_OK);
    assert_int_equal(dig_estimator_set_correction(e, by), DIG_OK);
    for (int64_t i = 0; i < samples; i++) {
        const struct dig_reading r      = bench_still((1000 + i * 5) * MS);
        struct dig_sample        sample = { .time_ns = r.time_ns };
        for (size_t s = 0; s < DIG_SIGNALS; s++) {
            sample.value[s] = r.value[s];
            sample.valid[s] = true;
        }
        assert_int_equal(dig_estimator_step(e, &sample, &estimate), DIG_OK);
    }
    free(e);
    return estimate.wrench.My_Nm;
}

// So many ticks with the bucket in the air, or in soil that pushes; the moment of the last.
static double moment_after_Nm(struct bench *const b, int64_t *const at_ms, const int ticks,
                              const double push_Pa)
{
    for (int i = 0; i < ticks; i++) {
        struct dig_reading r = bench_still(*at_ms * MS);
        r.value[DIG_SIGNAL_BUCKET_HEAD_Pa] += push_Pa;
        assert_true(dig_ring_push(&b->wires.readings, &r));
        dig_loop_tick(&b->loop, (*at_ms + 1) * MS);
        *at_ms += 5;
    }
    return b->loop.estimate.wrench.My_Nm;
}

// What a reload brings: a machine that a model corrects, with the table it comes with.
static void offer_machine(struct bench *const b, const struct dig_correction *const by,
                          const int64_t generation)
{
    struct dig_prediction_basis *const made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->set        = &b->cube.set;
    made->generation = generation;
    assert_int_equal(dig_correction_apply(&b->machine, by, &made->machine), DIG_OK);
    dig_latest_put(&b->wires.table, made);
    free(made);
}

static void a_corrected_machine_is_taken_up_between_two_digs_as_if_from_the_start(void **state)
{
    (void)state;
    struct bench *const         b     = bench_create();
    const struct dig_correction heavy = { .bucket = { .mass_kg = 250.0 } };
    int64_t                     at_ms = 1000;

    // In a dig the machine stays as it is; push_Pa makes the moment of another sample.
    (void)moment_after_Nm(b, &at_ms, 200, 0.0);
    const double digging_Nm = moment_after_Nm(b, &at_ms, 100, 15e6);
    assert_int_not_equal(b->loop.estimate.phase, DIG_PHASE_AIR);
    offer_machine(b, &heavy, 2);
    assert_close(moment_after_Nm(b, &at_ms, 100, 15e6), digging_Nm, 1e-9);
    assert_int_equal(b->loop.tick_status.generation, 1);

    // In the air the new one is used, as by an estimator that has had it from the start.
    int waited = 0;
    while (b->loop.tick_status.generation == 1 && waited++ < 1000) {
        (void)moment_after_Nm(b, &at_ms, 1, 0.0);
    }
    assert_int_equal(b->loop.tick_status.generation, 2);
    assert_true(fabs(moment_of_Nm(b, &heavy, 100) - moment_of_Nm(b, NULL, 100)) > 100.0);
    assert_close(moment_after_Nm(b, &at_ms, 99, 0.0), moment_of_Nm(b, &heavy, 100), 1e-6);

    // The same again is nothing new: what free air taught stays learnt.
    offer_machine(b, &heavy, 3);
    assert_close(moment_after_Nm(b, &at_ms, 100, 0.0), moment_of_Nm(b, &heavy, 200), 1e-6);
    assert_int_equal(b->loop.tick_status.generation, 3);

    // And taken off again.
    offer_machine(b, NULL, 4);
    assert_close(moment_after_Nm(b, &at_ms, 100, 0.0), moment_of_Nm(b, NULL, 100), 1e-6);
    bench_destroy(b);
}

static void a_tick_allocates_nothing(void **state)
{
    (void)state;
    skip_unless_allocations_count();
    struct bench *const b = bench_create();
    bench_set_basis(b, &b->wires.basis, 3, 1, INT64_MAX);
    unsigned long in_ticks = 0;
    int           digs     = 0;
    for (int64_t i = 0; i < 2000; i++) {
        struct dig_reading r = bench_still(1000 * MS + i * 5 * MS);

        // Pressures that come and go, so that digs begin and end.
        r.value[DIG_SIGNAL_BUCKET_HEAD_Pa] += i % 600 > 400 ? 15e6 : 0.0;
        (void)dig_ring_push(&b->wires.readings, &r);
        if (i % 100 == 0) {
            bench_set_basis(b, &b->wires.basis, 3, 1, INT64_MAX);
        }
        const unsigned long before = allocations;
        dig_loop_tick(&b->loop, 1000 * MS + i * 5 * MS);
        in_ticks += allocations - before;

        struct dig_recorded_dig *raw = NULL;
        if (dig_ring_pop(&b->wires.digs, &raw)) {
            digs++;
            assert_true(dig_ring_push(&b->wires.spares, &raw));
        }
    }
    assert_true(in_ticks == 0);
    assert_true(b->loop.tick_status.digs > 1);
    assert_int_equal(digs, b->loop.tick_status.digs);
    assert_int_equal(b->loop.tick_status.lost_digs, 0);
    bench_destroy(b);
}

struct run {
    struct bench *bench;
    atomic_bool   stop;
};

static void *run_main(void *const context)
{
    struct run *const run = context;
    dig_loop_run(&run->bench->loop, &run->stop);
    return NULL;
}

// The whole loop beside a producer and a consumer, for ThreadSanitizer; its pace only roughly,
// since tests run on busy machines.
static void the_loop_runs_beside_its_neighbours(void **state)
{
    (void)state;
    struct run run = { .bench = bench_create() };
    pthread_t  thread;
    assert_int_equal(pthread_create(&thread, NULL, run_main, &run), 0);
    struct timespec        t;
    struct dig_tick_status tick_status = { 0 };
    int                    estimates   = 0;
    for (int i = 0; i < 100; i++) {
        (void)clock_gettime(CLOCK_MONOTONIC, &t);
        const struct dig_reading r = bench_still((int64_t)t.tv_sec * 1000000000 + t.tv_nsec);
        assert_true(dig_ring_push(&run.bench->wires.readings, &r));
        const struct timespec pause = { .tv_nsec = 5 * MS };
        (void)nanosleep(&pause, NULL);
        struct dig_record record;
        while (dig_ring_pop(&run.bench->wires.records, &record)) {
            estimates += record.has_estimate;
        }
        (void)dig_latest_take(&run.bench->wires.tick_status, &tick_status);
    }
    atomic_store(&run.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_in_range(estimates, 90, 100);
    assert_in_range(tick_status.ticks, 10, 1000);
    assert_true(tick_status.worst_tick_us > 0.0);
    bench_destroy(run.bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_sample_becomes_an_estimate),
        cmocka_unit_test(each_estimate_is_shared_and_none_waited_for),
        cmocka_unit_test(a_sample_with_a_hole_is_passed_on_without_an_estimate),
        cmocka_unit_test(without_a_pressure_of_the_arms_the_moment_is_told_and_no_force),
        cmocka_unit_test(silence_is_missing_after_the_stale_time_only),
        cmocka_unit_test(a_publisher_that_does_not_keep_up_is_counted_not_waited_for),
        cmocka_unit_test(one_tick_takes_a_bounded_number_of_readings),
        cmocka_unit_test(in_the_air_each_dig_is_predicted_whole_once_the_gravel_is_known),
        cmocka_unit_test(nothing_is_predicted_from_a_gravel_that_expired),
        cmocka_unit_test(a_table_is_exchanged_with_the_forecast_that_belongs_to_it),
        cmocka_unit_test(a_corrected_machine_is_taken_up_between_two_digs_as_if_from_the_start),
        cmocka_unit_test(a_tick_allocates_nothing),
        cmocka_unit_test(the_loop_runs_beside_its_neighbours),
    };
    return cmocka_run_group_tests_name("loop", tests, NULL, NULL);
}
