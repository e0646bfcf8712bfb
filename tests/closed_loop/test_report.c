// Tests for closed_loop/report/report.c and closed_loop/report/plot.c

#include "closed_loop/report/report.h"

#include "closed_loop/report/plot.h"
#include "tests/written.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct dig_report one_run(void)
{
    struct dig_report report         = { .title  = "A <demo> & more",
                                         .table  = "/home/somebody/t.sqlite",
                                         .lambda = 10.0 };
    report.runs                      = 1;
    struct dig_report_run *const run = &report.run[0];
    *run                             = (struct dig_report_run){ .name        = "Modbus TCP",
                                                                .dig         = "a recording",
                                                                .truth_known = true,
                                                                .truth       = { { 0.5, 0.5, 2500.0 } },
                                                                .gravel      = { { 0.523, 0.47, 2431.0 } },
                                                                .low         = { { 0.41, 0.31, 2100.0 } },
                                                                .high        = { { 0.63, 0.66, 2800.0 } },
                                                                .nearest     = { { 0.5, 0.5, 2500.0 } },
                                                                .distance    = 0.2,
                                                                .error       = 0.1234,
                                                                .noise_floor = 0.1111 };
    (void)snprintf(run->simple.trajectory, sizeof run->simple.trajectory, "simpleA");
    (void)snprintf(run->real.trajectory, sizeof run->real.trajectory, "actual");
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        run->simple.last = run->real.last = 1.0;
        run->simple.measured_Nm[k] = run->real.measured_Nm[k] = 0.01 * k;
        run->simple.model_Nm[k] = run->real.model_Nm[k] = 0.011 * k;
        run->simple.sigma_Nm[k] = run->real.sigma_Nm[k] = 0.1;
        run->simple.recording_Nm[k]                     = NAN;
    }
    return report;
}

TEST(the_page_stands_alone_and_holds_the_numbers)
{
    const struct dig_report report = one_run();
    struct dig_error        error  = { "" };
    char                   *page   = NULL;
    FILE *const             to     = written_begin(&page);
    assert_ok(dig_report_html(&report, to, &error), error);
    written_end(to);
    assert_non_null(strstr(page, "A &lt;demo&gt; &amp; more"));
    assert_non_null(strstr(page, "off by 12 % (noise floor 11 %) in the run Modbus TCP.</p>"));
    assert_non_null(strstr(page, "Table: t.sqlite. The machine is 10 times the rig, which makes a "
                                 "moment 10000 times as large."));
    assert_null(strstr(page, "somebody"));
    assert_non_null(strstr(page, ">moment about the bucket pin, kN·m</text>"));
    assert_non_null(strstr(page, ">at rig scale, N·m</text>"));
    assert_non_null(strstr(page, "0.123"));
    assert_non_null(strstr(page, "2100 to 2800"));
    assert_int_equal(count_of(page, "<svg"), 2);
    // Of the simple dig no recording is known; the actual one's is drawn, and named in the key.
    assert_int_equal(count_of(page, ">recording fed to the rig</text>"), 1);
    assert_int_equal(count_of(page, ">measured through pressures</text>"), 2);
    check_page_stands_alone(page);
    free(page);
}

TEST(a_chance_too_small_to_say_is_not_called_none)
{
    static const struct {
        double      chance;
        const char *said;
    } of[] = { { 0.0, "below 1e-6" }, { 9e-7, "below 1e-6" }, { 0.0031, "0.0031" }, { 1.0, "1" } };
    char text[32];
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        assert_string_equal(dig_report_chance(of[i].chance, sizeof text, text), of[i].said);
    }
}

TEST(the_terminal_gets_truth_estimate_interval_and_error)
{
    struct dig_report report = one_run();
    char             *text   = NULL;
    FILE *const       to     = written_begin(&text);
    dig_report_text(&report, to);
    report.run[0].truth_known = false;
    dig_report_text(&report, to);
    written_end(to);
    assert_non_null(strstr(text, "0.50        0.52   0.41 to 0.63"));
    assert_non_null(strstr(text, "error of the predicted actual dig: 0.123"));
    assert_non_null(strstr(text, "unknown"));
    free(text);
}

TEST(json_holds_the_same)
{
    const struct dig_report report = one_run();
    char                   *text   = NULL;
    FILE *const             to     = written_begin(&text);
    dig_report_json(&report, to);
    written_end(to);
    assert_non_null(strstr(text, "\"identified\":{\"friction\":0.523,\"rolling\":0.47,"
                                 "\"density_kgpm3\":2431}"));
    assert_non_null(strstr(text, "\"error\":0.1234,\"noise_floor\":0.1111"));
    free(text);
}

TEST(without_gnuplot_it_says_so)
{
    const struct dig_report report = one_run();
    struct dig_error        error  = { "" };
    const char *const       kept   = getenv("PATH");
    char *const             path   = strdup(kept == NULL ? "" : kept);
    (void)setenv("PATH", "/nonexistent", 1);
    char       *page = NULL;
    FILE *const to   = written_begin(&page);
    assert_int_equal(dig_report_html(&report, to, &error), DIG_EIO);
    written_end(to);
    free(page);
    (void)setenv("PATH", path, 1);
    free(path);
    assert_contains(error.text, "gnuplot");
}
