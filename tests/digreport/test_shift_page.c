// Tests for tools/digreport/shift_page.c and shift_text.c: what people and programs read of a shift

#include "tools/digreport/shift_page.h"

#include "tests/digreport/shift_log.h"
#include "tests/written.h"

static char *text_of(void (*const put)(const struct digreport_shift *, FILE *))
{
    static char text[16384];
    FILE *const to = fmemopen(text, sizeof text, "w");
    put(&shift, to);
    (void)fclose(to);
    return text;
}

TEST_WITH(one_sentence_says_what_came_out, fresh, NULL)
{
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

TEST_WITH(the_csv_has_a_line_a_dig, fresh, NULL)
{
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

TEST_WITH(json_holds_digs_gravels_and_troubles, fresh, NULL)
{
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
    char            *page  = NULL;
    FILE *const      to    = written_begin(&page);
    assert_ok(digreport_shift_html(&shift, subject, to, &error), error);
    written_end(to);
    return page;
}

TEST_WITH(the_page_stands_alone_and_holds_the_numbers, fresh, NULL)
{
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
    assert_int_equal(count_of(page, "<svg"), 7);
    check_page_stands_alone(page);
    free(page);
}

// Where nothing tells the machine's size, all is at its scale.
TEST_WITH(a_machine_of_unknown_size_has_a_page_too, fresh, NULL)
{
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

TEST_WITH(a_shift_without_anything_is_a_page, fresh, NULL)
{
    const struct digreport_shift_subject subject = { .title = "", .machine = "", .scene = "" };
    char *const                          page    = page_of(&subject);
    assert_contains(page, "No dig was finished.");
    assert_contains(page, "No dig identified a gravel.");
    assert_contains(page, "Nothing was wrong.");
    free(page);
}

// Text of messages, of others on the network, and of the machine that logged.
TEST_WITH(no_text_of_a_message_is_markup_or_somebodys_path, fresh, NULL)
{
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

static int finish_all(void **state)
{
    digreport_shift_finish(&shift);
    return scratch_teardown(state);
}

TESTS_WITH(scratch_setup, finish_all)
