// Tests for tools/digreport/shift.c, shift_page.c and shift_text.c, on logs written by LCM's own
// library.

#include "tools/digreport/shift.h"

#include "tests/blank_messages.h"
#include "tests/logged.h"
#include "tests/scratch.h"
#include "tools/digreport/shift_page.h"

LOG_TYPE(estimate)
LOG_TYPE(match)
LOG_TYPE(prediction)
LOG_TYPE(health)

#define START_us INT64_C(1700000000000000) // 2023-11-14 22:13:20 UTC
#define MINUTE   INT64_C(60000000)

static char actual[]  = "actual";
static char running[] = "running";
static char hostile[] = "\033[2J<script>alert('x')<img src=x>\"&\xff /home/somebody/run.csv";

static struct digreport_shift shift;

static int fresh(void **state)
{
    (void)state;
    digreport_shift_finish(&shift);
    digreport_shift_begin(&shift, 10.0);
    return 0;
}

static void read_log(const char *const name)
{
    struct dig_error error = { "" };
    if (digreport_shift_log(&shift, scratch_path(name), &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
}

static lcm_eventlog_t *begin(const char *const name)
{
    lcm_eventlog_t *const log = lcm_eventlog_create(scratch_path(name), "w");
    assert_non_null(log);
    return log;
}

static digsight_match_t a_match(const int64_t time_us, const double friction, const bool valid,
                                char *const text)
{
    digsight_match_t m   = blank_match();
    m.time_ns            = time_us; // any that differs
    m.valid              = valid ? 1 : 0;
    m.friction           = friction;
    m.friction_low       = friction - 0.1;
    m.friction_high      = friction + 0.1;
    m.rolling            = 0.5;
    m.rolling_low        = 0.3;
    m.rolling_high       = 0.8;
    m.density_kgpm3      = 2500.0;
    m.density_low_kgpm3  = 2000.0;
    m.density_high_kgpm3 = 3000.0;
    m.digs               = 1;
    m.wanted             = text;
    m.untold             = text;
    return m;
}

static void put_match(lcm_eventlog_t *const log, const int64_t time_us, const double friction,
                      const bool valid, char *const text)
{
    const digsight_match_t m = a_match(time_us, friction, valid, text);
    log_match(log, "DIGSIGHT_MATCH", time_us, &m);
}

static digsight_health_t healthy(void)
{
    digsight_health_t h = blank_health();
    h.state             = running;
    return h;
}

// A dig of one second at this moment, where 10 kNm +- 1 kNm and 20 kJ +- 2 kJ were predicted.
static void put_dig(lcm_eventlog_t *const log, const int64_t time_us, const int32_t digs,
                    const double moment_Nm)
{
    double                moment[DIG_PREDICTED_POINTS];
    double                sigma[DIG_PREDICTED_POINTS];
    digsight_prediction_t p = blank_prediction(actual, 10000.0, 10000.0, 1000.0, moment, sigma);
    p.peak_Nm               = 10000.0;
    p.peak_sigma_Nm         = 1000.0;
    p.energy_J              = 20000.0;
    p.energy_sigma_J        = 2000.0;
    for (int i = 0; i <= 11; i++) {
        digsight_estimate_t e = blank_estimate();
        e.time_ns             = 1000 * (time_us + 100000 * i);
        e.moment_valid        = 1;
        e.force_valid         = 1;
        e.moment_Nm           = moment_Nm;
        e.phase               = i <= 10 ? 2 : 3;
        e.dig_count           = i <= 10 ? digs : digs + 1;
        e.trajectory          = actual;
        e.progress            = 0.1 * i;
        log_estimate(log, "DIGSIGHT_ESTIMATE", time_us + 100000 * i, &e);
        if (i == 0) {
            log_prediction(log, "DIGSIGHT_PREDICTION", time_us, &p);
        }
    }
}

// Two gravels, two digs, timeouts in two bursts; the oracle is worked out by hand.
static void make_day(void)
{
    lcm_eventlog_t *const log = begin("day.lcm");
    digsight_health_t     h   = healthy();
    h.timeouts                = 100; // from before we listened
    log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
    put_match(log, START_us + MINUTE, 0.4, true, no_text);
    put_match(log, START_us + MINUTE, 0.4, true, no_text); // said again
    put_dig(log, START_us + 2 * MINUTE, 4, 8000.0);        // off by 2 of 8: 25 %
    h.timeouts   = 103;
    h.digs_whole = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 3 * MINUTE, &h);
    h.timeouts = 110;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 3 * MINUTE + 30000000, &h);
    put_match(log, START_us + 4 * MINUTE, 0.6, true, no_text);
    put_dig(log, START_us + 5 * MINUTE, 5, 12500.0); // off by 2.5 of 12.5: 20 %
    h.timeouts     = 111;
    h.digs_aborted = 1;
    h.digs_whole   = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 8 * MINUTE, &h);
    lcm_eventlog_destroy(log);
}

static void a_shift_has_its_digs_gravels_and_troubles(void **state)
{
    (void)state;
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

static void a_second_log_begins_anew(void **state)
{
    (void)state;
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
static void how_a_dig_ended_is_told_where_the_log_tells_it(void **state)
{
    (void)state;
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

static char *text_of(void (*const put)(const struct digreport_shift *, FILE *))
{
    static char text[16384];
    FILE *const to = fmemopen(text, sizeof text, "w");
    put(&shift, to);
    (void)fclose(to);
    return text;
}

static void one_sentence_says_what_came_out(void **state)
{
    (void)state;
    assert_string_equal(text_of(digreport_shift_sentence),
                        "0 digs in 1 min; no gravel was known at the end; nothing was predicted; "
                        "health: 0 events.");
    make_day();
    read_log("day.lcm");
    assert_string_equal(
        text_of(digreport_shift_sentence),
        "2 digs in 8 min, 1 aborted; the gravel at the end: friction 0.60 (0.50 to 0.70), "
        "rolling friction 0.50 (0.30 to 0.80), density 2500 (2000 to 3000) kg/m3; 2 "
        "predictions, off by 22 % (median; noise floor 10 %); health: 2 events.");
}

static void the_csv_has_a_line_a_dig(void **state)
{
    (void)state;
    make_day();
    read_log("day.lcm");
    const char *const csv = text_of(digreport_shift_csv);
    assert_contains(csv, "time_utc,dig,trajectory,ended,duration_s,peak_Nm,");
    // At rig scale a moment and an energy are 10^4 times less.
    assert_contains(
        csv, "\n2023-11-14T22:15:20Z,5,actual,whole,1,8000,10000,1000,0,20000,2000,0.8,0,0.25,"
             "0.125,0.4,0.3,0.5,0.5,0.3,0.8,2500,2000,3000\n");
    assert_contains(csv, "\n2023-11-14T22:18:20Z,6,actual,aborted,1,12500,");
}

static void json_holds_digs_gravels_and_troubles(void **state)
{
    (void)state;
    make_day();
    read_log("day.lcm");
    const char *const json = text_of(digreport_shift_json);
    assert_contains(json,
                    "\n {\"time_utc\": \"2023-11-14T22:18:20Z\", \"dig\": 6, \"trajectory\": "
                    "\"actual\", \"ended\": \"aborted\", \"duration_s\": 1, \"peak_Nm\": 12500,");
    assert_contains(json, "\"friction\": 0.6, \"friction_low\": 0.5, \"friction_high\": 0.7,");
    assert_contains(json, "\"count\": 10, \"what\": \"Modbus requests had no answer\"");
}

static char *page_of(const struct digreport_shift_subject *const subject)
{
    struct dig_error error = { "" };
    size_t           size  = 0;
    FILE *const      to    = fopen(scratch_path("page.html"), "w");
    assert_non_null(to);
    if (digreport_shift_html(&shift, subject, to, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    (void)fclose(to);
    return scratch_read(scratch_path("page.html"), &size);
}

static void the_page_stands_alone_and_holds_the_numbers(void **state)
{
    (void)state;
    make_day();
    read_log("day.lcm");
    const struct digreport_shift_subject subject = {
        .title = "Tuesday", .machine = "zx200", .scene = "rig", .logs = 1
    };
    char *const page = page_of(&subject);
    assert_contains(page, "<h1>Tuesday</h1>");
    assert_contains(page, "<p class=result>2 digs in 8 min, 1 aborted; the gravel at the end: ");
    assert_contains(page, "<th>22:15:20</th><td>5</td><td>actual</td><td>whole</td><td>1.0</td>"
                          "<td>8.0</td>"
                          "<td>10.0 ± 1.6</td><td>0.80</td><td>0.0</td><td>20.0 ± 3.3</td>"
                          "<td>0.00</td><td>25</td><td>12</td>");
    assert_contains(page, "<td>Modbus requests had no answer</td><td>10</td>");
    assert_contains(page, ">peak moment, kN·m</text>");
    assert_contains(page, ">at rig scale, N·m</text>");
    assert_contains(page, "time since 2023-11-14T22:13:20Z, min");
    int pictures = 0;
    for (const char *at = page; (at = strstr(at, "<svg")) != NULL; at++) {
        pictures++;
    }
    assert_int_equal(pictures, 7);
    for (const char *at = page; (at = strstr(at, "://")) != NULL; at++) {
        assert_memory_equal(at, "://www.w3.org/", 14);
    }
    free(page);
}

// Where nothing tells the machine's size, all is at its scale.
static void a_machine_of_unknown_size_has_a_page_too(void **state)
{
    (void)state;
    digreport_shift_begin(&shift, 0.0);
    make_day();
    read_log("day.lcm");
    assert_close(shift.dig[0].peak_Nm, 8000.0, 1e-9);
    assert_contains(text_of(digreport_shift_csv), ",8000,10000,1000,0,20000,2000,,,0.25,0.125,");
    const struct digreport_shift_subject subject = {
        .title = "Tuesday", .machine = "", .scene = "", .logs = 1
    };
    char *const page = page_of(&subject);
    assert_contains(page, "All at machine scale");
    assert_contains(page, "<td>8.0</td><td>10.0 ± 1.6</td><td>0.0</td>");
    assert_null(strstr(page, "rig scale"));
    free(page);
}

static void a_shift_without_anything_is_a_page(void **state)
{
    (void)state;
    const struct digreport_shift_subject subject = { .title = "", .machine = "", .scene = "" };
    char *const                          page    = page_of(&subject);
    assert_contains(page, "No dig was finished.");
    assert_contains(page, "No dig identified a gravel.");
    assert_contains(page, "Nothing was wrong.");
    free(page);
}

// Text of messages, of others on the network, and of the machine that logged.
static void no_text_of_a_message_is_markup_or_somebodys_path(void **state)
{
    (void)state;
    lcm_eventlog_t *const log = begin("hostile.lcm");
    digsight_health_t     h   = healthy();
    h.note = h.state = h.input = h.table = hostile;
    log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
    put_match(log, START_us + MINUTE, 0.4, true, hostile);
    put_match(log, START_us + 2 * MINUTE, 0.4, false, hostile);
    put_match(log, START_us + 3 * MINUTE, (double)NAN, true, hostile);
    put_match(log, START_us + 3 * MINUTE, 1e300, true, hostile);
    static const int64_t counts[] = { INT64_MIN, INT64_MAX, -1, 0, INT64_MAX, 7 };
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) { // no step of these is a growth
        h.timeouts = h.reloads = counts[i];
        h.digs_whole = h.digs_aborted = i % 2 == 0 ? 0 : 5;
        log_health(log, "DIGSIGHT_HEALTH", START_us + 4 * MINUTE, &h);
    }
    const digsight_health_t other = healthy();
    log_health(log, "DIGSIGHT_ESTIMATE", START_us + 4 * MINUTE, &other);
    log_health(log, "DIGSIGHT_HEALTH", INT64_MIN, &h);
    log_health(log, "DIGSIGHT_HEALTH", INT64_MAX, &h);
    lcm_eventlog_destroy(log);
    read_log("hostile.lcm");
    assert_int_equal(shift.misread, 1);
    assert_int_equal(shift.gravels, 2);
    assert_int_equal(shift.ended[DIGREPORT_WHOLE], 15); // three daemons of five digs
    for (size_t i = 0; i < shift.events; i++) {
        assert_int_equal(shift.event[i].count, 0);
    }
    struct dig_model                     model   = { .effects = 1 };
    const struct digreport_shift_subject subject = {
        .title = hostile, .machine = hostile, .scene = hostile, .model = &model, .logs = 1
    };
    (void)snprintf(model.effect[0].parameter[0].name, DIG_NAME_SIZE, "<b>&N");
    model.effect[0].parameters = 1;
    char *const page           = page_of(&subject);
    assert_null(strstr(page, "<script>"));
    assert_null(strchr(page, '\033'));
    assert_contains(page, "&lt;script&gt;");
    assert_contains(page, "1 messages on the daemon's channels were not understood");
    assert_contains(page, "&lt;b&gt;&amp;N");
    // What the daemon said names the file without its folders.
    assert_contains(strstr(page, "<h2>Health"), " run.csv</td>");
    assert_null(strstr(strstr(page, "<h2>Health"), "somebody"));
    free(page);
}

static void a_log_that_is_none_or_damaged_is_refused(void **state)
{
    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_shift_has_its_digs_gravels_and_troubles, fresh),
        cmocka_unit_test_setup(a_second_log_begins_anew, fresh),
        cmocka_unit_test_setup(how_a_dig_ended_is_told_where_the_log_tells_it, fresh),
        cmocka_unit_test_setup(one_sentence_says_what_came_out, fresh),
        cmocka_unit_test_setup(the_csv_has_a_line_a_dig, fresh),
        cmocka_unit_test_setup(json_holds_digs_gravels_and_troubles, fresh),
        cmocka_unit_test_setup(the_page_stands_alone_and_holds_the_numbers, fresh),
        cmocka_unit_test_setup(a_machine_of_unknown_size_has_a_page_too, fresh),
        cmocka_unit_test_setup(a_shift_without_anything_is_a_page, fresh),
        cmocka_unit_test_setup(no_text_of_a_message_is_markup_or_somebodys_path, fresh),
        cmocka_unit_test_setup(a_log_that_is_none_or_damaged_is_refused, fresh),
    };
    const int failed = cmocka_run_group_tests_name("shift", tests, scratch_setup, scratch_teardown);
    digreport_shift_finish(&shift);
    return failed;
}
