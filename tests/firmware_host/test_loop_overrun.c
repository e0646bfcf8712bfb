// Tests for firmware_host/tick/loop.c: what the loop makes of ticks that begin late or take too
// long. The clock is the test's own (the Makefile has the linker put these functions in the
// library's place).

#include "tests/firmware_host/loop_bench.h"

#include <time.h>

#define BEATS  40
#define PERIOD (5 * MS)

// A clock that stands but for sleeps and what a test adds.
static struct {
    int64_t      now_ns;
    int64_t      late_ns[BEATS];     // by which the sleep before the beat ends too late
    int64_t      takes_ns[BEATS];    // of the tick
    int64_t      deadline_ns[BEATS]; // asked for
    int64_t      start_ns[BEATS];    // of the tick after
    int          beat, asked;        // clocks asked in this beat
    atomic_bool *stop;
    void (*at_beat)(int beat);
} fake;

// NOLINTBEGIN(bugprone-reserved-identifier)
int __wrap_clock_gettime(clockid_t clock, struct timespec *time);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *deadline,
                           struct timespec *left);

// The loop reads the monotonic clock before its tick and after it.
int __wrap_clock_gettime(const clockid_t clock, struct timespec *const time)
{
    if (clock == CLOCK_MONOTONIC && fake.asked++ == 1) {
        fake.now_ns += fake.takes_ns[fake.beat];
    }
    time->tv_sec  = (time_t)(fake.now_ns / 1000000000);
    time->tv_nsec = (long)(fake.now_ns % 1000000000);
    return 0;
}

int __wrap_clock_nanosleep(const clockid_t clock, const int flags,
                           const struct timespec *const deadline, struct timespec *const left)
{
    assert_int_equal(clock, CLOCK_MONOTONIC);
    assert_int_equal(flags, TIMER_ABSTIME);
    assert_null(left);
    const int64_t deadline_ns   = (int64_t)deadline->tv_sec * 1000000000 + deadline->tv_nsec;
    fake.deadline_ns[fake.beat] = deadline_ns;
    fake.beat++;
    fake.asked  = 0;
    fake.now_ns = (deadline_ns > fake.now_ns ? deadline_ns : fake.now_ns);
    if (fake.beat == BEATS) {
        atomic_store(fake.stop, true);
        fake.beat--;
        return 0;
    }
    fake.now_ns += fake.late_ns[fake.beat];
    fake.start_ns[fake.beat] = fake.now_ns;
    if (fake.at_beat != NULL) {
        fake.at_beat(fake.beat);
    }
    return 0;
}
// NOLINTEND(bugprone-reserved-identifier)

static struct bench *bench;

static void set_up(void)
{
    memset(&fake, 0, sizeof fake);
    fake.now_ns = 1000 * MS;
    fake.asked  = -1; // the loop asks once more before its first beat
    bench       = bench_create();
}

static void run(void)
{
    atomic_bool stop = false;
    fake.stop        = &stop;
    dig_loop_run(&bench->loop, &stop);
}

TEST(ticks_that_come_in_time_keep_the_beat)
{
    set_up();
    run();
    assert_int_equal(bench->loop.tick_status.ticks, BEATS);
    assert_int_equal(bench->loop.tick_status.overruns, 0);
    assert_close(bench->loop.tick_status.worst_late_us, 0.0, 0.0);
    for (int i = 0; i < BEATS; i++) {
        assert_int_equal(fake.deadline_ns[i], 1000 * MS + (i + 1) * PERIOD);
    }
    bench_destroy(bench);
}

TEST(a_tick_that_is_late_by_less_than_a_period_is_no_overrun_and_shifts_no_other)
{
    set_up();
    fake.late_ns[10] = PERIOD - 1;
    fake.late_ns[12] = PERIOD / 2;
    run();
    assert_int_equal(bench->loop.tick_status.overruns, 0);
    assert_close(bench->loop.tick_status.worst_late_us, 4999.999, 1e-9);
    for (int i = 0; i < BEATS; i++) {
        assert_int_equal(fake.deadline_ns[i], 1000 * MS + (i + 1) * PERIOD);
    }
    bench_destroy(bench);
}

TEST(a_tick_a_period_late_is_counted_and_what_was_missed_is_skipped)
{
    set_up();
    fake.late_ns[10] = PERIOD;
    fake.late_ns[20] = 7 * PERIOD + PERIOD / 2;
    run();
    assert_int_equal(bench->loop.tick_status.overruns, 2);
    assert_int_equal(bench->loop.tick_status.ticks, BEATS);
    assert_close(bench->loop.tick_status.worst_late_us, 37500.0, 1e-9);

    // One tick for all that were missed, and a whole period after it the next.
    assert_int_equal(fake.deadline_ns[10], fake.start_ns[10] + PERIOD);
    assert_int_equal(fake.deadline_ns[20], fake.start_ns[20] + PERIOD);
    for (int i = 1; i < BEATS; i++) {
        assert_true(fake.start_ns[i] - (i > 1 ? fake.start_ns[i - 1] : 1000 * MS) >= PERIOD);
    }
    bench_destroy(bench);
}

TEST(a_tick_that_takes_too_long_makes_the_next_an_overrun_and_is_told)
{
    set_up();
    fake.takes_ns[10] = 2 * PERIOD + MS;
    run();
    assert_int_equal(bench->loop.tick_status.overruns, 1);
    assert_close(bench->loop.tick_status.worst_tick_us, 11000.0, 1e-9);
    assert_close(bench->loop.tick_status.worst_late_us, 6000.0, 1e-9); // it should begin after 5 ms
    assert_int_equal(fake.start_ns[11], fake.start_ns[10] + 2 * PERIOD + MS);
    assert_int_equal(fake.deadline_ns[11], fake.start_ns[11] + PERIOD);
    bench_destroy(bench);
}

// Ten readings come while the tick does not.
static void readings_of_a_gap(const int beat)
{
    for (int64_t i = 0; beat == 20 && i < 10; i++) {
        const struct dig_reading r = bench_still(fake.now_ns - (10 - i) * PERIOD);
        assert_true(dig_ring_push(&bench->wires.handoffs.readings, &r));
    }
}

TEST(readings_wait_for_a_late_tick_and_keep_their_own_time)
{
    set_up();
    fake.late_ns[20] = 10 * PERIOD;
    fake.at_beat     = readings_of_a_gap;
    run();
    struct dig_record record;
    for (int64_t i = 0; i < 10; i++) {
        assert_true(dig_ring_pop(&bench->wires.handoffs.records, &record));
        assert_int_equal(record.sample.time_ns, fake.start_ns[20] - (10 - i) * PERIOD);
    }
    assert_false(dig_ring_pop(&bench->wires.handoffs.records, &record));
    assert_int_equal(bench->loop.tick_status.overruns, 1);
    assert_int_equal(bench->loop.tick_status.lost, 0);
    bench_destroy(bench);
}
