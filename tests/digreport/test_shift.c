// Tests for tools/digreport/shift.c

#include "tests/digreport/shift_log.h"

TEST_WITH(a_shift_has_its_digs_gravels_and_troubles, fresh, NULL)
{
    make_day();
    read_log("day.lcm");
    assert_int_equal(shift.digs, 2);
    assert_int_equal(shift.dig[0].number, 5);
    assert_close(shift.dig[0].error, 0.25, 1e-9);
    assert_close(shift.dig[1].error, 0.2, 1e-9);
    double error;
    double floor;
    assert_int_equal(digreport_shift_error(&shift, &error, &floor), 2);
    assert_close(error, 0.225, 1e-9);
    assert_close(floor, 0.5 * (1.0 / 8.0 + 1.0 / 12.5), 1e-9);

    assert_int_equal(shift.gravels, 2);
    assert_null(digreport_shift_gravel_at(&shift, START_us));
    assert_close(digreport_shift_gravel_at(&shift, shift.dig[0].time_us)->gravel.value[0], 0.4,
                 0.0);
    assert_close(digreport_shift_gravel_at(&shift, shift.dig[1].time_us)->gravel.value[0], 0.6,
                 0.0);

    assert_int_equal(shift.events, 2);
    assert_string_equal(shift.event[0].text->name, "timeouts");
    assert_int_equal(shift.event[0].count, 10);
    assert_int_equal(shift.event[0].to_us - shift.event[0].from_us, 30000000);
    assert_int_equal(shift.event[1].count, 1);
    assert_int_equal(shift.ended[DIGREPORT_WHOLE], 1);
    assert_int_equal(shift.ended[DIGREPORT_ABORTED], 1);
    assert_int_equal(shift.dig[0].ended, DIGREPORT_WHOLE);
    assert_int_equal(shift.dig[1].ended, DIGREPORT_ABORTED);
    assert_int_equal(shift.last_us - shift.first_us, 8 * MINUTE);
}

TEST_WITH(a_second_log_begins_anew, fresh, NULL)
{
    make_day();
    read_log("day.lcm");
    lcm_eventlog_t *const log = begin("next.lcm");
    digsight_health_t     h   = healthy();
    h.timeouts                = 5000;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 60 * MINUTE, &h);
    put_dig(log, START_us + 61 * MINUTE, 0, 10000.0);
    put_match(log, START_us + 62 * MINUTE, 0.0, false, hostile);
    digsight_match_t m = a_match(START_us + 63 * MINUTE, 0.0, false, hostile);
    m.dig_count        = 5; // as a dig of the first log was
    m.ending           = DIGREPORT_ABORTED;
    log_match(log, "DIGSIGHT_MATCH", START_us + 63 * MINUTE, &m);
    lcm_eventlog_destroy(log);
    read_log("next.lcm");
    assert_int_equal(shift.digs, 3);
    assert_int_equal(shift.dig[2].number, 1);
    assert_int_equal(shift.dig[2].ended, DIGREPORT_NOT_TOLD);
    assert_int_equal(shift.dig[0].ended, DIGREPORT_WHOLE);
    assert_close(shift.dig[2].error, 0.0, 1e-9);
    assert_int_equal(shift.events, 3); // timeouts before it are not its own
    assert_null(shift.event[2].text);
    assert_null(digreport_shift_gravel_at(&shift, INT64_MAX));
}

// HEALTH tells nothing of the first of four digs, and not which of the last two is which: MATCH
// does.
TEST_WITH(how_a_dig_ended_is_told_where_the_log_tells_it, fresh, NULL)
{
    lcm_eventlog_t *const log = begin("ends.lcm");
    digsight_health_t     h   = healthy();
    digsight_match_t      m   = a_match(START_us + 4 * MINUTE, 0.4, true, no_text);
    log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
    put_dig(log, START_us + MINUTE, 0, 1000.0);
    put_dig(log, START_us + 2 * MINUTE, 1, 1000.0);
    h.digs_unknown = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 3 * MINUTE, &h);
    put_dig(log, START_us + 4 * MINUTE, 2, 1000.0);
    put_dig(log, START_us + 5 * MINUTE, 3, 1000.0);
    h.digs_whole = h.digs_aborted = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 6 * MINUTE, &h);
    m.dig_count = 3;
    m.ending    = DIGREPORT_ABORTED;
    log_match(log, "DIGSIGHT_MATCH", START_us + 6 * MINUTE, &m);
    m.dig_count = 1; // of the daemon's run before
    m.restored  = 1;
    log_match(log, "DIGSIGHT_MATCH", START_us + 6 * MINUTE, &m);
    lcm_eventlog_destroy(log);
    read_log("ends.lcm");
    static const char *const ended[] = { "", "unknown", "aborted", "" };
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(digreport_ending_name(shift.dig[i].ended), ended[i]);
    }
}

// A dig, ten seconds later the clock is set by ten days, then a match; a second after that it is
// set back. All is told by the last clock.
TEST_WITH(a_clock_that_is_set_moves_what_was_before, fresh, NULL)
{
    static const int64_t  second = 1000000;
    const int64_t         days[] = { 10, -3 };
    lcm_eventlog_t *const log    = begin("set.lcm");
    digsight_health_t     h      = healthy();
    int64_t               at     = START_us;
    int64_t               set    = 0;
    put_dig(log, at, 4, 8000.0);
    for (int i = 0; i < 2; i++) {
        at += 10 * second;
        h.time_ns = 1000 * at;
        log_health(log, "DIGSIGHT_HEALTH", at + set, &h);
        set += days[i] * 24 * 60 * MINUTE;
        at += second;
        h.time_ns = 1000 * at;
        log_health(log, "DIGSIGHT_HEALTH", at + set, &h);
        put_match(log, at + second / 2 + set, 0.4, true, no_text);
    }
    lcm_eventlog_destroy(log);
    read_log("set.lcm");
    assert_int_equal(shift.digs, 1);
    assert_int_equal(shift.dig[0].time_us, START_us + set);
    assert_int_equal(shift.first_us, START_us + set);
    assert_int_equal(shift.last_us, at + second / 2 + set);
    assert_int_equal(shift.gravels, 2);
    assert_int_equal(shift.gravel[0].time_us, START_us + 11 * second + second / 2 + set);
    assert_int_equal(shift.gravel[1].time_us, shift.last_us);
    assert_int_equal(shift.events, 1);
    assert_string_equal(shift.event[0].text->name, "clock");
    assert_int_equal(shift.event[0].count, 2);
    assert_int_equal(shift.event[0].from_us, START_us + 11 * second + set);
}

// Nor is it taken for set where nobody was there for a day, or the computer was started anew.
TEST_WITH(a_pause_or_another_start_is_no_clock_that_was_set, fresh, NULL)
{
    static const struct {
        int64_t log_us, mono_us;
    } later[] = { { 24 * 60 * MINUTE, 24 * 60 * MINUTE },       // a pause
                  { 24 * 60 * MINUTE, 24 * 60 * MINUTE / 100 }, // on a slow bench
                  { 24 * 60 * MINUTE, -MINUTE },                // another start
                  { MINUTE / 2, 1 },                            // less than it is seen by
                  { -500000, 1000000 } };                       // two senders, late
    for (size_t i = 0; i < sizeof later / sizeof later[0]; i++) {
        (void)fresh(NULL);
        lcm_eventlog_t *const log = begin("pause.lcm");
        digsight_health_t     h   = healthy();
        h.time_ns                 = 1000 * START_us;
        log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
        h.time_ns += 1000 * later[i].mono_us;
        log_health(log, "DIGSIGHT_HEALTH", START_us + later[i].log_us, &h);
        lcm_eventlog_destroy(log);
        read_log("pause.lcm");
        assert_int_equal(shift.events, 0);
        assert_int_equal(shift.last_us, START_us + later[i].log_us);
    }
}

TEST_WITH(a_log_that_is_none_or_damaged_is_refused, fresh, NULL)
{
    struct dig_error error = { "" };
    assert_int_equal(digreport_shift_log(&shift, scratch_path("none.lcm"), &error), DIG_EIO);
    assert_contains(error.text, "none.lcm: No such file");
    (void)scratch_write("text.lcm", "t_s\n");
    assert_int_equal(digreport_shift_log(&shift, scratch_path("text.lcm"), &error), DIG_EINVAL);
    make_day();
    size_t      size = 0;
    char *const day  = scratch_read(scratch_path("day.lcm"), &size);
    (void)scratch_write_bytes("cut.lcm", day, size - 5); // its last HEALTH is lost
    read_log("cut.lcm");
    assert_int_equal(shift.digs, 2);
    assert_int_equal(shift.events, 1);
    day[size / 2] ^= 0x55; // within a message or a header
    memset(day + size / 2, 0x55, 300);
    (void)scratch_write_bytes("damaged.lcm", day, size);
    assert_int_equal(digreport_shift_log(&shift, scratch_path("damaged.lcm"), &error), DIG_EINVAL);
    assert_contains(error.text, "damaged.lcm: damaged at byte");
    free(day);
}

TEST_WITH(the_last_health_says_by_what_scene_was_predicted, fresh, NULL)
{
    static char old[] = "0123abcd", now[] = "4567abcd",
                hash_too_long[] =
                    "0123456789012345678901234567890123456789012345678901234567890123456789";
    char *const       said[] = { no_text, old, now, no_text, hash_too_long };
    const char *const kept[] = { "", old, now, now, hash_too_long };
    for (size_t i = 0; i < sizeof said / sizeof said[0]; i++) {
        lcm_eventlog_t *const log = begin("table.lcm");
        digsight_health_t     h   = healthy();
        h.table                   = said[i];
        log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
        lcm_eventlog_destroy(log);
        read_log("table.lcm");
        assert_int_equal(strncmp(shift.scene_hash, kept[i], 64), 0);
    }
}

static int finish_all(void **state)
{
    digreport_shift_finish(&shift);
    return scratch_teardown(state);
}

TESTS_WITH(scratch_setup, finish_all)
