// Tests for closed_loop/report/plot.c: what stands in a text is drawn, and nothing of it is run.

#include "closed_loop/report/plot.h"

#include "tests/scratch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double two[] = { 0.0, 1.0 };

static char *svg_of(const char *const text)
{
    const struct dig_plot plot = {
        .title   = text,
        .x_label = text,
        .y_label = text,
        .height  = 370,
        .series  = 1,
        .s       = { { text, DIG_PLOT_LINE, 0x1f5fa8, 2, two, two, NULL } },
    };
    struct dig_conditions c    = { .error = NULL };
    char                 *svg  = NULL;
    size_t                size = 0;
    FILE *const           to   = open_memstream(&svg, &size);
    dig_plot_figure(&plot, to, &c);
    assert_int_equal(c.status, DIG_OK);
    (void)fclose(to);
    return svg;
}

TEST(no_text_runs_a_command)
{
    static const struct {
        const char *before, *behind;
    } holds[] = {
        { "a`touch ", "`.csv" },
        { "a\"; system('touch ", "') #" },
        { "a\nsystem \"touch ", "\"\n" },
        { "a\nEOD\n!touch ", "\n" },
        { "$(touch ", ")" },
        { "@{`touch ", "`}" },
    };
    const char *const owned = scratch_path("OWNED");
    for (size_t i = 0; i < sizeof holds / sizeof holds[0]; i++) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s%s%s", holds[i].before, owned, holds[i].behind);
        free(svg_of(text));
        assert_false(scratch_exists("OWNED"));
    }
}

TEST(markup_and_control_characters_are_escaped)
{
    char *const svg = svg_of("<script>\"'&\x1b[31m\xff\xc2\x9b é");
    assert_null(strstr(svg, "<script>"));
    assert_null(strchr(svg, '\x1b'));
    assert_null(strchr(svg, '\xff'));
    assert_null(strstr(svg, "\xc2\x9b"));
    const char *at    = svg;
    int         found = 0;
    while ((at = strstr(at, "&lt;script&gt;&quot;&#39;&amp;\xef\xbf\xbd[31m\xef\xbf\xbd")) !=
           NULL) {
        at++;
        found++;
    }
    assert_int_equal(found, 4); // title, both labels, key
    assert_non_null(strstr(svg, " é"));
    free(svg);
}

// 0 to 1 kN·m at the left is 0 to 0.1 N·m at the right: both scales' numbers are drawn.
TEST(a_second_scale_stands_at_the_right)
{
    struct dig_plot       plot = { .title        = "",
                                   .x_label      = "x",
                                   .y_label      = "left, kN·m",
                                   .right_factor = 0.0625,
                                   .height       = 370,
                                   .series       = 1,
                                   .s = { { NULL, DIG_PLOT_LINE, 0, 2, two, two, NULL } } };
    struct dig_conditions c    = { .error = NULL };
    for (int i = 0; i < 2; i++) {
        char       *svg  = NULL;
        size_t      size = 0;
        FILE *const to   = open_memstream(&svg, &size);
        plot.right_label = i == 0 ? NULL : "right, N·m";
        dig_plot_figure(&plot, to, &c);
        assert_int_equal(c.status, DIG_OK);
        (void)fclose(to);
        assert_int_equal(strstr(svg, ">right, N·m</text>") != NULL, i);
        assert_int_equal(strstr(svg, "> 0.0625</text>") != NULL, i);
        assert_null(strstr(svg, "GNUPLOT")); // text browsers would show it
        free(svg);
    }
}

TEST(what_is_counted_has_no_marks_between)
{
    static const double   three[] = { 1.0, 3.0 };
    struct dig_plot       plot    = { .title     = "",
                                      .x_label   = "x",
                                      .y_label   = "digs",
                                      .from_zero = true,
                                      .height    = 370,
                                      .series    = 1,
                                      .s = { { NULL, DIG_PLOT_POINTS, 0, 2, three, three, NULL } } };
    struct dig_conditions c       = { .error = NULL };
    for (int i = 0; i < 2; i++) {
        char       *svg  = NULL;
        size_t      size = 0;
        FILE *const to   = open_memstream(&svg, &size);
        plot.counts      = i == 1;
        plot.x_to        = 40.0; // its own marks are whole
        dig_plot_figure(&plot, to, &c);
        assert_int_equal(c.status, DIG_OK);
        (void)fclose(to);
        assert_int_equal(strstr(svg, ".5</text>") == NULL, i);
        assert_non_null(strstr(svg, " 3</text>"));
        free(svg);
    }
}

TEST(the_users_start_up_file_is_not_run)
{
    FILE *const file = fopen(scratch_path(".gnuplot"), "w");
    assert_non_null(file);
    (void)fprintf(file, "system 'touch %s'\n", scratch_path("STARTED"));
    (void)fclose(file);
    char home[4096];
    (void)snprintf(home, sizeof home, "%s", scratch_path(""));
    const char *const was  = getenv("HOME");
    char *const       kept = strdup(was == NULL ? "" : was);
    (void)setenv("HOME", home, 1);
    free(svg_of("plain"));
    (void)setenv("HOME", kept, 1);
    free(kept);
    assert_false(scratch_exists("STARTED"));
}

TESTS_WITH(scratch_setup, scratch_teardown)
