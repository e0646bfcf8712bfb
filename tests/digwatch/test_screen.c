// Tests for tools/digwatch/screen.c, chart.c, grid.c, trouble.c and prometheus.c: what stands on
// the screen, as text.

#include "tests/digwatch/said.h"
#include "tests/scratch.h"
#include "tools/digwatch/prometheus.h"
#include "tools/digwatch/screen.h"

#include <locale.h>
#include <wchar.h>

static char waiting_state[] = "waiting for bus";

static struct digwatch_model model;
static struct digwatch_grid  grid;

static int fresh(void **state)
{
    (void)state;
    digwatch_model_init(&model);
    return 0;
}

static const struct digwatch_view plain = { .source = "day.lcm", .damage = "" };

// The screen of these sizes as UTF-8, a line a row, blanks at its end left out; valid until the
// next call.
static const char *screen(const int rows, const int columns, const bool ascii,
                          const struct digwatch_view *const view)
{
    static char text[DIGWATCH_ROWS_MAX * DIGWATCH_COLUMNS_MAX * 4];
    digwatch_grid_init(&grid, rows, columns, ascii);
    digwatch_screen(&model, view, &grid);
    FILE *const to = fmemopen(text, sizeof text, "w");
    assert_non_null(setlocale(LC_CTYPE, "C.UTF-8"));
    for (int r = 0; r < grid.rows; r++) {
        int end = grid.columns;
        while (end > 0 && grid.cell[r][end - 1].glyph == ' ') {
            end--;
        }
        for (int c = 0; c < end; c++) {
            (void)fprintf(to, "%lc", (wint_t)grid.cell[r][c].glyph);
        }
        (void)fputc('\n', to);
    }
    (void)fclose(to);
    return text;
}

// Ten seconds of a dig that resists by 12 kNm, where up to 10 kNm were predicted.
static void dig(void)
{
    say_rising_prediction(&model);
    for (int i = 0; i <= 100; i++) {
        const digsight_estimate_t e = estimate_at(INT64_C(100000000) * i, 0.01 * i, 12000.0);
        say_estimate(&model, &e);
    }
    const digsight_match_t m = match_of(0.46);
    say_match(&model, &m);
    const digsight_health_t h = health_at(10000000000, running_state);
    say_health(&model, &h);
}

TEST_WITH(everything_stands_in_80_by_24, fresh, NULL)
{
    dig();
    const char *const text = screen(24, 80, true, &plain);
    assert_contains(
        text, "digwatch day.lcm                                 2023-11-14 22:13:20 UTC q: quit\n"
              "running, can can0; 5 digs (1 aborted), 2 identified\n");
    assert_contains(text, "Phase     dig, curl           actual     ====================== 100 %");
    assert_contains(text, "Moment    12.00 +- 0.50 kNm, predicted 10.00 (8.36 to 11.64)");
    assert_contains(text, "Residual  +2.00 kNm, +2.0 sigma      this dig 63 % off");
    assert_contains(text, "Predicted actual: peak 10.5 +- 0.9 kNm, energy 21 +- 1.5 kJ");
    assert_contains(text,
                    "Gravel    friction 0.46     rolling 0.50      density 2848 kg/m3    2 digs");
    assert_contains(
        text, "  90 %    0.41 to 0.61      0.32 to 0.82      2435 to 3311          with force");
    assert_contains(text, "Health    good: nothing is wrong");
    assert_contains(text, "\n         17.8 s before now");
}

// The newest of 142 slots is at the right; a dig of ten seconds takes 81 of them, 41 columns.
TEST_WITH(the_chart_has_the_measured_the_predicted_and_the_band, fresh, NULL)
{
    dig();
    (void)screen(24, 80, true, &plain);
    int measured = 0;
    int top      = 0;
    for (int c = 0; c < 80; c++) {
        for (int r = 3; r < 11; r++) {
            if (grid.cell[r][c].glyph == '#') {
                measured++;
                top = r;
            }
        }
    }
    assert_in_range(measured, 40, 42);
    // 12 of a scale to 15 (steps of 1 to 2 kNm): high up, and all in one row.
    assert_in_range(top, 3, 5);
    assert_int_equal(grid.cell[top][79].glyph, '#');
    assert_int_equal(grid.cell[top][37].glyph, ' ');
    assert_int_equal(grid.cell[top][79].ink, DIGWATCH_MEASURED);
    // 1.6 kNm about a prediction that rises to 10: low at first, just below at last, nothing
    // before.
    int low  = 0;
    int last = 0;
    for (int r = 3; r < 11; r++) {
        low  = grid.cell[r][40].glyph == '-' ? r : low;
        last = grid.cell[r][79].glyph == '-' ? r : last;
    }
    assert_in_range(low, 9, 10);
    assert_in_range(last, top + 1, 6);
    int above = 0; // columns with the band above the predicted, and below
    int below = 0;
    for (int c = 40; c < 80; c++) {
        for (int r = 4; r < 10; r++) {
            const bool predicted = grid.cell[r][c].glyph == '-';
            above += predicted && grid.cell[r - 1][c].glyph == '.' ? 1 : 0;
            below += predicted && grid.cell[r + 1][c].glyph == '.' ? 1 : 0;
        }
    }
    assert_in_range(above, 20, 40);
    assert_in_range(below, 20, 40);
    // In braille the same, by dots; of the predicted every other.
    assert_contains(screen(24, 80, false, &plain), "\xe2\x96\x91"); // shade
    assert_true(grid.cell[top][79].glyph > 0x2800 && grid.cell[top][79].glyph <= 0x28ff);
    for (int c = 9; c < 80; c++) {
        for (int r = 3; r < 11; r++) {
            if (grid.cell[r][c].ink == DIGWATCH_PREDICTED) {
                assert_int_equal(grid.cell[r][c].glyph & 0xb8U, 0);
            }
        }
    }
}

TEST_WITH(which_axes_were_not_told_is_said, fresh, NULL)
{
    char             names[] = "friction, density_kgpm3";
    digsight_match_t m       = match_of(0.46);
    m.untold                 = names;
    dig();
    say_match(&model, &m);
    assert_contains(screen(24, 80, true, &plain), "resists alike; not told: friction, density\n");
}

TEST_WITH(health_says_what_is_wrong_and_what_to_do, fresh, NULL)
{
    assert_contains(screen(24, 80, true, &plain), "Health    no message of a daemon was heard yet");
    digsight_health_t h = health_at(1000000000, waiting_state);
    say_health(&model, &h);
    assert_contains(
        screen(24, 80, true, &plain),
        "Health    no fresh sample comes from the machine\n"
        "            switch the machine on; check the cable, and interface or address in\n"
        "            the configuration\n");
    h                 = health_at(2000000000, running_state);
    h.dropped_stuck   = 7;
    char boom[]       = "boom_head_Pa";
    h.missing_signals = boom;
    say_health(&model, &h);
    const char *text = screen(24, 80, true, &plain);
    assert_contains(text, "angles or pressures stand still while others move (7 so far)\n"
                          "            check the supply and the plug of those sensors");
    assert_contains(text, "no value of boom_head_Pa");
    h.time_ns         = 13000000000; // ten seconds later it is over
    h.missing_signals = no_text;
    say_health(&model, &h);
    assert_contains(screen(24, 80, true, &plain), "good: nothing is wrong");
    model.misread    = 3; // the last one eleven seconds ago, then nine
    model.misread_us = model.time_us - 11000000;
    assert_contains(screen(24, 80, true, &plain), "good: nothing is wrong");
    model.misread_us = model.time_us - 9000000;
    assert_contains(screen(24, 80, true, &plain), "3 messages on its channels were not understood");
    const struct digwatch_view silent = { .source = "", .damage = "", .silent_s = 12.3 };
    assert_contains(screen(24, 80, true, &silent), "no message for 12 s");
    const struct digwatch_view damaged = { .source = "",
                                           .damage = "day.lcm: damaged at byte 7",
                                           .ended  = true };
    text                               = screen(24, 80, true, &damaged);
    assert_contains(text, "day.lcm: damaged at byte 7");
    assert_contains(text, ", at its end");
}

TEST_WITH(no_text_of_a_message_moves_the_cursor, fresh, NULL)
{
    char              hostile[] = "\033[2J\r\n\t\007\x9b"
                                  "31m\xc2\x9b\xe2\x80\xae\xff\xf0\x9f\x92\xa9\xcc\x81\xd2\x83 \xc3\xa4";
    digsight_health_t h         = health_at(1000000000, hostile);
    h.input = h.note = h.missing_signals = hostile;
    say_health(&model, &h);
    digsight_match_t m = match_of(1e300);
    m.wanted = m.untold = hostile;
    say_match(&model, &m);
    const struct digwatch_view view = { .source = hostile, .damage = hostile };
    for (int ascii = 0; ascii < 2; ascii++) {
        for (const char *c = screen(40, 120, ascii == 1, &view); *c != '\0'; c++) {
            assert_true(*c == '\n' || (unsigned char)*c >= 0x20);
            assert_true(ascii == 0 || (unsigned char)*c < 0x7f);
        }
        for (int r = 0; r < grid.rows; r++) {
            for (int c = 0; c < grid.columns; c++) {
                const uint32_t g = grid.cell[r][c].glyph;
                assert_true((g >= 0x20 && g < 0x7f) || (g >= 0xa0 && g < 0x300) ||
                            (g >= 0x370 && g < 0x530 && (g < 0x483 || g > 0x489)) ||
                            (g >= 0x2800 && g < 0x2900) || g == 0x2591);
            }
        }
    }
    assert_contains(screen(40, 120, false, &view), "? \xc3\xa4"); // a letter stays
}

TEST_WITH(any_size_is_drawn, fresh, NULL)
{
    dig();
    for (int rows = 0; rows <= DIGWATCH_ROWS_MAX + 10; rows += rows < 30 ? 1 : 16) {
        for (int columns = 0; columns <= DIGWATCH_COLUMNS_MAX + 10;
             columns += columns < 90 ? 7 : 60) {
            (void)screen(rows, columns, false, &plain);
        }
    }
    assert_contains(screen(10, 70, true, &plain),
                    "70 x 10 is too small: 80 x 18 at least. q: quit");
    assert_contains(screen(18, 80, true, &plain), "Health");
    assert_contains(screen(100, 320, true, &plain), "Health");
}

TEST_WITH(any_moment_has_a_scale, fresh, NULL)
{
    static const double moments[] = { 0.0, 1e-9, -3.0, 999.0, 1e3, -1e9, 1e9, 1e12, (double)NAN };
    for (size_t i = 0; i < sizeof moments / sizeof moments[0]; i++) {
        digwatch_model_init(&model);
        const digsight_estimate_t e = estimate_at(0, 0.5, moments[i]);
        say_estimate(&model, &e);
        assert_null(strstr(screen(24, 80, true, &plain), "inf"));
        assert_null(strstr(screen(24, 80, true, &plain), "nan"));
    }
}

TEST_WITH(prometheus_gets_all_counters_whole_or_not_at_all, fresh, NULL)
{
    const char *const path = scratch_path("d.prom");
    size_t            size = 0;
    assert_int_equal(digwatch_prometheus(&model, 0.0, path, NULL), DIG_OK);
    char *text = scratch_read(path, &size);
    assert_contains(text, "\ndigsight_up 0\n");
    assert_null(strstr(text, "digsight_digs_total"));
    free(text);

    digsight_health_t h = health_at(1000000000, running_state);
    h.timeouts          = 3;
    h.frames            = 123456789012345;
    h.latency_p99_us    = 250.0;
    say_health(&model, &h);
    assert_int_equal(digwatch_prometheus(&model, 0.0, path, NULL), DIG_OK);
    text = scratch_read(path, &size);
    assert_contains(text, "# HELP digsight_timeouts_total Modbus requests had no answer\n"
                          "# TYPE digsight_timeouts_total counter\ndigsight_timeouts_total 3\n");
    assert_contains(text, "\ndigsight_up 1\n");
    assert_contains(text, "\ndigsight_running 1\n");
    assert_contains(text, "\ndigsight_frames_total 123456789012345\n");
    assert_contains(text, "\ndigsight_latency_p99_seconds 0.00025\n");
    assert_int_equal(text[size - 1], '\n');
    free(text);
    assert_false(scratch_exists("d.prom.part"));

    struct dig_error error = { "" };
    assert_refused(digwatch_prometheus(&model, 0.0, scratch_path("no/where.prom"), &error), error,
                   DIG_EIO, "no/where.prom: No such file");
}

TESTS_WITH(scratch_setup, scratch_teardown)
