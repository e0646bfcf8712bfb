// Tests for firmware_host/bus/input_replay.c

#include "core/recording.h"
#include "firmware_host/bus/input.h"
#include "tests/testlib.h"

#include <stdlib.h>

#define MS   1000000LL
#define ROWS 50

static struct dig_machine_recording recording(void)
{
    struct dig_machine_recording r = { .rows = ROWS,
                                       .row  = calloc(ROWS, sizeof(struct dig_sample)) };
    assert_non_null(r.row);
    for (int64_t i = 0; i < ROWS; i++) {
        r.row[i].time_ns                    = 700 * MS + i * 10 * MS;
        r.row[i].value[DIG_SIGNAL_BOOM_rad] = (double)i;
        r.row[i].valid[DIG_SIGNAL_BOOM_rad] = true;
        r.row[i].value[DIG_SIGNAL_ARM_rad]  = i == 3 ? (double)NAN : 1.0;
        r.row[i].valid[DIG_SIGNAL_ARM_rad]  = true;

        r.row[i].valid[DIG_SIGNAL_PITCH_rad] = i == 5;
    }
    return r;
}

TEST(every_line_is_played_once_at_its_time)
{
    static struct dig_reading    memory[64];
    static struct dig_log_line   notes_memory[3];
    struct dig_ring              ring;
    struct dig_latest            log;
    atomic_bool                  stop  = false;
    struct dig_machine_recording r     = recording();
    struct dig_input             input = { .readings = &ring, .log = &log, .stop = &stop };
    dig_ring_init(&ring, sizeof memory[0], 64, memory);
    dig_latest_init(&log, sizeof notes_memory[0], notes_memory);
    assert_int_equal(dig_input_replay_create(&input, &r, "r.csv", 10.0), DIG_OK);
    assert_null(r.row); // taken over

    const int64_t begin_ns = dig_input_now_ns();
    dig_input_run(&input);
    const int64_t took_ns = dig_input_now_ns() - begin_ns;
    assert_true(atomic_load(&input.ended));
    assert_true(took_ns >= (ROWS - 1) * MS); // ten times as fast as 10 ms a line
    struct dig_reading reading, first = { 0 };
    for (int64_t i = 0; i < ROWS; i++) {
        assert_true(dig_ring_pop(&ring, &reading));
        first = i == 0 ? reading : first;
        assert_close(reading.value[DIG_SIGNAL_BOOM_rad], (double)i, 0.0);
        assert_true(reading.time_ns - first.time_ns == i * MS);
        assert_int_equal(reading.state[DIG_SIGNAL_ARM_rad],
                         i == 3 ? DIG_READING_NAN : DIG_READING_OK);
        assert_int_equal(reading.state[DIG_SIGNAL_PITCH_rad],
                         i == 5 ? DIG_READING_OK : DIG_READING_NOT_AVAILABLE);
        assert_int_equal(reading.state[DIG_SIGNAL_BUCKET_rad], DIG_READING_ABSENT); // nowhere
    }
    assert_false(dig_ring_pop(&ring, &reading));
    assert_int_equal(atomic_load(&input.frames), ROWS);
    dig_input_destroy(&input);
}

TEST(a_replay_can_be_stopped)
{
    static struct dig_log_line   notes_memory[3];
    static struct dig_reading    memory[64];
    struct dig_ring              ring;
    struct dig_latest            log;
    atomic_bool                  stop  = true;
    struct dig_machine_recording r     = recording();
    struct dig_input             input = { .readings = &ring, .log = &log, .stop = &stop };
    dig_ring_init(&ring, sizeof memory[0], 64, memory);
    dig_latest_init(&log, sizeof notes_memory[0], notes_memory);
    assert_int_equal(dig_input_replay_create(&input, &r, "r.csv", 1.0), DIG_OK);
    dig_input_run(&input);
    assert_int_equal(atomic_load(&input.frames), 0);
    assert_false(atomic_load(&input.ended));
    dig_input_destroy(&input);
}

TEST(what_cannot_be_played_is_refused_and_stays_the_callers)
{
    struct dig_machine_recording r = recording(), empty = { 0 };
    struct dig_input             input = { 0 };
    assert_int_equal(dig_input_replay_create(&input, &r, "r.csv", 0.0), DIG_EINVAL);
    assert_int_equal(dig_input_replay_create(&input, &r, "r.csv", (double)NAN), DIG_EINVAL);
    assert_int_equal(dig_input_replay_create(&input, &empty, "r.csv", 1.0), DIG_EINVAL);
    assert_null(input.ops);
    assert_int_equal(r.rows, ROWS);
    dig_machine_recording_finish(&r);
}
