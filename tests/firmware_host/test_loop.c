// Tests for firmware_host/tick/loop.c: the tick, with a real estimator and a table of formulas.

#include "firmware_host/tick/loop.h"

#include "tests/firmware_host/loop_bench.h"

#include <pthread.h>
#include <time.h>

TEST(a_whole_sample_becomes_an_estimate)
{
    struct bench *const      b = bench_create();
    const struct dig_reading r = bench_still(1000 * MS);
    struct dig_record        record;
    assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.handoffs.records, &record));
    assert_true(record.has_estimate);
    assert_true(record.estimate.time_ns == 1000 * MS);
    assert_close(record.sample.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8.4e6, 0.0);
    assert_false(dig_ring_pop(&b->wires.handoffs.records, &record));
    const struct dig_tick_status tick_status = bench_tick_status(b);
    assert_true(tick_status.fresh);
    assert_int_equal(tick_status.ticks, 1);
    assert_int_equal(tick_status.missing, 0);
    bench_destroy(b);
}

// For who looks at the dig going on; when he does not keep up, nothing is counted as lost.
TEST(each_estimate_is_shared_and_none_waited_for)
{
    struct bench *const b = bench_create();
    struct dig_estimate estimate;
    for (int64_t i = 0; i < 11; i++) {
        struct dig_reading r = bench_still(1000 * MS + i * 5 * MS);
        if (i == 3) {
            r.state[DIG_SIGNAL_BUCKET_HEAD_Pa] = DIG_READING_NOT_AVAILABLE;
        }
        assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
        dig_loop_tick(&b->loop, 1001 * MS + i * 5 * MS);
    }
    for (int64_t i = 0; i < 9; i++) {
        if (i != 3) {
            assert_true(dig_ring_pop(&b->wires.handoffs.estimates, &estimate));
            assert_true(estimate.time_ns == 1000 * MS + i * 5 * MS);
        }
    }
    assert_false(dig_ring_pop(&b->wires.handoffs.estimates, &estimate));
    assert_int_equal(bench_tick_status(b).lost, 0);
    bench_destroy(b);
}

TEST(a_sample_with_a_hole_is_passed_on_without_an_estimate)
{
    struct bench *const b = bench_create();
    struct dig_reading  r = bench_still(1000 * MS);

    r.state[DIG_SIGNAL_BUCKET_HEAD_Pa] = DIG_READING_NOT_AVAILABLE;
    struct dig_record record;
    assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.handoffs.records, &record));
    assert_false(record.has_estimate);
    const struct dig_tick_status tick_status = bench_tick_status(b);
    assert_false(tick_status.fresh);
    assert_int_equal(tick_status.missing, 1);
    assert_int_equal(tick_status.drops.not_available, 1);
    bench_destroy(b);
}

TEST(without_a_pressure_of_the_arms_the_moment_is_told_and_no_force)
{
    struct bench *const b           = bench_create();
    struct dig_reading  r           = bench_still(1000 * MS);
    r.state[DIG_SIGNAL_ARM_HEAD_Pa] = DIG_READING_ABSENT;
    struct dig_record record;
    assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
    dig_loop_tick(&b->loop, 1001 * MS);
    assert_true(dig_ring_pop(&b->wires.handoffs.records, &record));
    assert_true(record.has_estimate);
    assert_true(record.estimate.wrench.moment_valid);
    assert_true(record.estimate.wrench.sigma_My_Nm > 0.0);
    assert_false(record.estimate.wrench.force_valid);
    assert_false(record.sample.valid[DIG_SIGNAL_ARM_HEAD_Pa]);
    assert_true(bench_tick_status(b).fresh);
    bench_destroy(b);
}

TEST(silence_is_missing_after_the_stale_time_only)
{
    struct bench *const b = bench_create();
    dig_loop_tick(&b->loop, 995 * MS);
    assert_int_equal(bench_tick_status(b).missing, 1);
    const struct dig_reading r = bench_still(1000 * MS);
    assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
    for (int64_t now = 1000; now <= 1200; now += 5) {
        dig_loop_tick(&b->loop, now * MS);
        assert_true(bench_tick_status(b).fresh == (now <= 1100));
    }
    assert_int_equal(b->loop.tick_status.missing, 1 + 20);
    bench_destroy(b);
}

TEST(a_publisher_that_does_not_keep_up_is_counted_not_waited_for)
{
    struct bench *const b    = bench_create();
    const int64_t       room = sizeof b->wires.memory.records / sizeof b->wires.memory.records[0];
    for (int64_t i = 0; i < room + 76; i++) {
        const struct dig_reading r = bench_still(1000 * MS + i * 5 * MS);
        assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
        dig_loop_tick(&b->loop, 1000 * MS + i * 5 * MS);
    }
    assert_int_equal(bench_tick_status(b).lost, 76);
    bench_destroy(b);
}

TEST(one_tick_takes_a_bounded_number_of_readings)
{
    struct bench *const b = bench_create();
    for (int64_t i = 0; i < DIG_READINGS_PER_TICK + 10; i++) {
        const struct dig_reading r = bench_still(1000 * MS + i * MS);
        assert_true(dig_ring_push(&b->wires.handoffs.readings, &r));
    }
    struct dig_record record;
    int               first = 0, second = 0;
    dig_loop_tick(&b->loop, 1300 * MS);
    while (dig_ring_pop(&b->wires.handoffs.records, &record)) {
        first++;
    }
    dig_loop_tick(&b->loop, 1305 * MS);
    while (dig_ring_pop(&b->wires.handoffs.records, &record)) {
        second++;
    }
    assert_int_equal(first, DIG_READINGS_PER_TICK);
    assert_int_equal(second, 10);
    bench_destroy(b);
}

TEST(in_the_air_each_dig_is_predicted_whole_once_the_gravel_is_known)
{
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    assert_int_equal(outlooks_in_the_air(b, 1000, seen), 0);
    bench_set_basis(b, &b->wires.handoffs.basis, 3, 1, INT64_MAX);
    assert_in_range(outlooks_in_the_air(b, 3000, seen), 3, 5);
    for (size_t t = 0; t < b->cube.set.trajectories; t++) {
        assert_true(seen[t]);
    }
    bench_destroy(b);
}

TEST(nothing_is_predicted_from_a_gravel_that_expired)
{
    struct bench *const b                        = bench_create();
    bool                seen[DIG_TRAJECTORY_MAX] = { false };
    bench_set_basis(b, &b->wires.handoffs.basis, 3, 1, 2000 * MS);
    assert_in_range(outlooks_in_the_air(b, 1000, seen), 2, 3);
    assert_int_equal(outlooks_in_the_air(b, 3000, seen), 0);
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
TEST(the_loop_runs_beside_its_neighbours)
{
    struct run run = { .bench = bench_create() };
    pthread_t  thread;
    assert_int_equal(pthread_create(&thread, NULL, run_main, &run), 0);
    struct timespec        t;
    struct dig_tick_status tick_status = { 0 };
    int                    estimates   = 0;
    for (int i = 0; i < 100; i++) {
        (void)clock_gettime(CLOCK_MONOTONIC, &t);
        const struct dig_reading r = bench_still((int64_t)t.tv_sec * 1000000000 + t.tv_nsec);
        assert_true(dig_ring_push(&run.bench->wires.handoffs.readings, &r));
        const struct timespec pause = { .tv_nsec = 5 * MS };
        (void)nanosleep(&pause, NULL);
        struct dig_record record;
        while (dig_ring_pop(&run.bench->wires.handoffs.records, &record)) {
            estimates += record.has_estimate;
        }
        (void)dig_latest_take(&run.bench->wires.handoffs.tick_status, &tick_status);
    }
    atomic_store(&run.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_in_range(estimates, 90, 100);
    assert_in_range(tick_status.ticks, 10, 1000);
    assert_true(tick_status.worst_tick_us > 0.0);
    bench_destroy(run.bench);
}
