// Tests for files/lcm/lcm_log.c, against logs written by LCM's own library.

#include "files/lcm/lcm_log.h"

#include "messages/digsight_sample_t.h"
#include "tests/blank_messages.h"
#include "tests/logged.h"
#include "tests/scratch.h"

#include <math.h>
#include <stdlib.h>

LOG_TYPE(sample)
LOG_TYPE(match)

static lcm_eventlog_t *begin(const char *const name)
{
    lcm_eventlog_t *const log = lcm_eventlog_create(scratch_path(name), "w");
    assert_non_null(log);
    return log;
}

static void put_sample(lcm_eventlog_t *const log, const int64_t time_ns, const int signals)
{
    double value[DIG_SIGNALS + 1]   = { 0.5 };
    int8_t valid[DIG_SIGNALS + 1]   = { 1 };
    value[DIG_SIGNAL_BOOM_HEAD_Pa]  = 1e6 + (double)time_ns;
    valid[DIG_SIGNAL_BOOM_HEAD_Pa]  = 1;
    value[DIG_SIGNAL_ARM_HEAD_Pa]   = 7.0; // not valid
    const digsight_sample_t message = {
        .time_ns = time_ns, .signals = signals, .value = value, .valid = valid
    };
    log_sample(log, "DIGSIGHT_SAMPLE", 1, &message);
}

struct counts {
    int estimates, matches, predictions, healths;
};

static void count_estimate(void *const context, const int64_t time_us,
                           const digsight_estimate_t *const m)
{
    assert_true(time_us > 0 && m->time_ns > 0);
    ((struct counts *)context)->estimates++;
}

static void count_any_match(void *const context, const int64_t time_us,
                            const digsight_match_t *const m)
{
    assert_true(time_us > 0 && m->valid == 1);
    ((struct counts *)context)->matches++;
}

static void count_prediction(void *const context, const int64_t time_us,
                             const digsight_prediction_t *const m)
{
    assert_true(time_us > 0 && m->points == 64);
    ((struct counts *)context)->predictions++;
}

static void count_health(void *const context, const int64_t time_us,
                         const digsight_health_t *const m)
{
    assert_true(time_us > 0);
    assert_string_equal(m->input, "replay run.csv");
    ((struct counts *)context)->healths++;
}

// Logged by lcm-logger from a running daemon, cut down to the first messages of each channel: logs
// of this version stay readable, or this test says that they do not.
TEST(the_example_of_the_formats_is_read)
{
    static const char            path[] = "tests/data/formats/daemon.lcm";
    struct counts                counts = { 0 };
    const struct dig_lcm_reader  reader = { &counts, count_estimate, count_any_match,
                                            count_prediction, count_health };
    struct dig_machine_recording r;
    assert_int_equal(dig_lcm_log_each(path, &reader, NULL), DIG_OK);
    assert_int_equal(counts.estimates, 20);
    assert_int_equal(counts.matches, 2);
    assert_int_equal(counts.predictions, 2);
    assert_int_equal(counts.healths, 2);
    assert_int_equal(dig_lcm_log_read(path, &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 20);
    assert_true(dig_sample_is_complete(&r.row[19]));
    dig_machine_recording_finish(&r);
}

TEST(samples_become_a_recording_that_begins_at_zero)
{
    lcm_eventlog_t *const log = begin("good.lcm");
    put_sample(log, 5000000000, DIG_SIGNALS);
    put_sample(log, 5010000000, DIG_SIGNALS);
    put_sample(log, 5010000000, DIG_SIGNALS); // a repetition
    put_sample(log, 5020000000, DIG_SIGNALS);
    lcm_eventlog_destroy(log);

    assert_true(dig_lcm_log_is(scratch_path("good.lcm")));
    struct dig_machine_recording r;
    struct dig_error             error = { "" };
    assert_int_equal(dig_lcm_log_read(scratch_path("good.lcm"), &r, &error), DIG_OK);
    assert_int_equal(r.rows, 3);
    assert_int_equal(r.row[0].time_ns, 0);
    assert_int_equal(r.row[2].time_ns, 20000000);
    assert_close(r.row[1].value[DIG_SIGNAL_BOOM_HEAD_Pa], 5011000000.0, 0.0);
    assert_true(r.row[1].valid[DIG_SIGNAL_BOOM_rad]);
    assert_false(r.row[1].valid[DIG_SIGNAL_ARM_HEAD_Pa]);
    assert_close(r.row[1].value[DIG_SIGNAL_ARM_HEAD_Pa], 0.0, 0.0);
    dig_machine_recording_finish(&r);
}

static void count_match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    int *const count = context;
    assert_int_equal(time_us, 1);
    assert_string_equal(m->trajectory, "simpleA");
    assert_close(m->friction, 0.45, 0.0);
    (*count)++;
}

TEST(other_messages_are_handed_on_one_by_one)
{
    char                  trajectory[] = "simpleA";
    lcm_eventlog_t *const log          = begin("match.lcm");
    digsight_match_t      match        = blank_match();
    match.valid                        = 1;
    match.friction                     = 0.45;
    match.trajectory                   = trajectory;
    put_sample(log, 1, DIG_SIGNALS);
    log_match(log, "DIGSIGHT_MATCH", 1, &match);
    log_match(log, "SOMETHING_ELSE", 1, &match);
    log_match(log, "DIGSIGHT_MATCH", 1, &match);
    lcm_eventlog_destroy(log);

    int                         count  = 0;
    const struct dig_lcm_reader reader = { .context = &count, .match = count_match };
    assert_int_equal(dig_lcm_log_each(scratch_path("match.lcm"), &reader, NULL), DIG_OK);
    assert_int_equal(count, 2);
}

// A logger that was killed leaves its last event unfinished: the rest counts.
TEST(a_log_cut_off_in_its_last_event_is_read_up_to_there)
{
    lcm_eventlog_t *const log = begin("whole.lcm");
    for (int64_t i = 0; i < 4; i++) {
        put_sample(log, i, DIG_SIGNALS);
    }
    lcm_eventlog_destroy(log);
    FILE *const file = fopen(scratch_path("whole.lcm"), "rb");
    assert_non_null(file);
    char         bytes[4096];
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    assert_int_equal(fclose(file), 0);
    assert_in_range(size, 200, sizeof bytes - 1);

    struct dig_machine_recording r;
    (void)scratch_write_bytes("cut.lcm", bytes, size - 5);
    assert_int_equal(dig_lcm_log_read(scratch_path("cut.lcm"), &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 3);
    dig_machine_recording_finish(&r);
}

static void check_refused(const char *const name, const enum dig_status status,
                          const char *const expected)
{
    struct dig_machine_recording r     = { .rows = 42 };
    struct dig_error             error = { "" };
    assert_int_equal(dig_lcm_log_read(scratch_path(name), &r, &error), status);
    assert_contains(error.text, expected);
    assert_int_equal(r.rows, 42);
}

TEST(defects_are_refused_and_write_nothing)
{
    check_refused("none.lcm", DIG_EIO, "none.lcm: No such file");
    (void)scratch_write("text.lcm", "t_s,boom_rad\n");
    assert_false(dig_lcm_log_is(scratch_path("text.lcm")));
    check_refused("text.lcm", DIG_EINVAL, "text.lcm:1: does not begin with ED A1 DA 01");

    lcm_eventlog_t *log = begin("few.lcm");
    put_sample(log, 1, DIG_SIGNALS);
    lcm_eventlog_destroy(log);
    check_refused("few.lcm", DIG_EINVAL,
                  "few.lcm: 1 samples on DIGSIGHT_SAMPLE, expected at least 2");

    log = begin("other.lcm");
    put_sample(log, 1, 10);
    lcm_eventlog_destroy(log);
    check_refused("other.lcm", DIG_EINVAL, "event 0: 10 signals, expected 11 to 16");
    // From before there were force sensors: what was added since has no value.
    log = begin("before.lcm");
    put_sample(log, 1, 11);
    put_sample(log, 2, 11);
    lcm_eventlog_destroy(log);
    struct dig_machine_recording before = { 0 };
    assert_int_equal(dig_lcm_log_read(scratch_path("before.lcm"), &before, NULL), DIG_OK);
    assert_true(before.rows == 2 && before.row[1].valid[DIG_SIGNAL_BOOM_HEAD_Pa]);
    assert_false(before.row[1].valid[DIG_SIGNAL_PIN_X_m] ||
                 before.row[1].valid[DIG_SIGNAL_SENSOR_MY_Nm]);
    dig_machine_recording_finish(&before);
    log = begin("more.lcm");
    put_sample(log, 1, DIG_SIGNALS + 1);
    lcm_eventlog_destroy(log);
    check_refused("more.lcm", DIG_EINVAL, "event 0: 17 signals, expected 11 to 16");

    // Another type's fingerprint under our channel's name: what an older build's log looks like.
    char                   text[] = "";
    const digsight_match_t match  = {
         .trajectory      = text,
         .table           = text,
         .wanted          = text,
         .hint_trajectory = text,
         .advice          = text,
         .untold          = text,
    };
    log = begin("version.lcm");
    log_match(log, "DIGSIGHT_SAMPLE", 1, &match);
    lcm_eventlog_destroy(log);
    check_refused("version.lcm", DIG_ESCHEMA, "DIGSIGHT_SAMPLE is of another version of its type");

    log = begin("damaged.lcm");
    for (int64_t i = 0; i < 4; i++) {
        put_sample(log, i, DIG_SIGNALS);
    }
    assert_int_equal(fseek(log->f, 200, SEEK_SET), 0);
    static const char rubbish[300] = { 1, 2, 3 };
    assert_int_equal(fwrite(rubbish, 1, sizeof rubbish, log->f), sizeof rubbish);
    lcm_eventlog_destroy(log);
    check_refused("damaged.lcm", DIG_EINVAL, "damaged.lcm: damaged at byte ");
}

// What anybody on the network may have sent.
TEST(values_that_are_no_numbers_and_times_that_cannot_be_are_not_taken)
{
    double               value[DIG_SIGNALS] = { 0.5, (double)NAN, (double)INFINITY, -0.25 };
    int8_t               valid[DIG_SIGNALS] = { 1, 1, 1, 1 };
    digsight_sample_t    message = { .signals = DIG_SIGNALS, .value = value, .valid = valid };
    static const int64_t times[] = { 0, INT64_C(1) << 62 };
    lcm_eventlog_t      *log     = begin("nan.lcm");
    for (size_t i = 0; i < 2; i++) {
        message.time_ns = times[i];
        log_sample(log, "DIGSIGHT_SAMPLE", 1, &message);
    }
    lcm_eventlog_destroy(log);
    struct dig_machine_recording r = { 0 };
    assert_int_equal(dig_lcm_log_read(scratch_path("nan.lcm"), &r, NULL), DIG_OK);
    assert_true(r.row[0].valid[0] && r.row[0].valid[3]);
    assert_false(r.row[0].valid[1] || r.row[0].valid[2]);
    for (int i = 0; i < DIG_SIGNALS; i++) {
        assert_true(isfinite(r.row[1].value[i]));
    }
    dig_machine_recording_finish(&r);

    static const int64_t absurd[] = { -1, INT64_MIN, INT64_MAX, (INT64_C(1) << 62) + 1 };
    for (size_t i = 0; i < sizeof absurd / sizeof absurd[0]; i++) {
        log = begin("when.lcm");
        put_sample(log, 1, DIG_SIGNALS);
        message.time_ns = absurd[i];
        log_sample(log, "DIGSIGHT_SAMPLE", 1, &message);
        lcm_eventlog_destroy(log);
        check_refused("when.lcm", DIG_EINVAL, "expected 0 to 2^62");
    }
}

// A length from a damaged header must not be believed.
TEST(lengths_that_cannot_be_are_refused)
{
    uint8_t header[40] = { 0xED, 0xA1, 0xDA, 0x01, [23] = 3, [28] = 'a', 'b', 'c' };
    header[24]         = 0xFF;
    (void)scratch_write_bytes("long.lcm", header, sizeof header);
    check_refused("long.lcm", DIG_EINVAL, "long.lcm: damaged at byte 0, expected an event");
    header[24] = 0;
    header[20] = 0xFF;
    (void)scratch_write_bytes("channel.lcm", header, sizeof header);
    check_refused("channel.lcm", DIG_EINVAL, "channel.lcm: damaged at byte 0, expected an event");

    uint8_t ours[40] = { 0xED, 0xA1, 0xDA, 0x01, [23] = 9, [26] = 0xFF };
    memcpy(ours + 28, "DIGSIGHT_", 9);
    (void)scratch_write_bytes("ours.lcm", ours, sizeof ours);
    check_refused("ours.lcm", DIG_EINVAL, "ours.lcm: damaged at byte 0, expected an event");
}

TESTS_WITH(scratch_setup, scratch_teardown)
