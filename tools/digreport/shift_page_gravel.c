#include "tools/digreport/shift_page_parts.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"
#include "closed_loop/report/report.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

// A gravel stands from its match to the next; a gap where none was known.
static void put_gravel_plot(const struct digreport_page *const page, FILE *const to, const int axis,
                            struct dig_conditions *const c)
{
    const struct digreport_shift *const shift = page->shift;
    const size_t                        n     = 3 * shift->gravels;
    double *const                       all   = calloc(4 * n, sizeof *all);
    if (all == NULL) {
        c->status = dig_error_set(c->error, DIG_ENOMEM, "out of memory");
        return;
    }
    for (size_t i = 0; i < shift->gravels; i++) {
        const struct dig_matched_gravel *const g = &shift->gravel[i].match;
        const int64_t                          end_us =
            i + 1 < shift->gravels ? shift->gravel[i + 1].time_us : shift->last_us;
        for (size_t end = 0; end < 3; end++) {
            const size_t at    = 3 * i + end;
            const bool   shown = g->known && end < 2;
            all[at]     = digreport_page_time(page, end == 0 ? shift->gravel[i].time_us : end_us);
            all[n + at] = shown ? g->gravel.value[axis] : (double)NAN;
            all[2 * n + at] = shown ? g->low.value[axis] : (double)NAN;
            all[3 * n + at] = shown ? g->high.value[axis] : (double)NAN;
        }
    }
    static const char *const label[DIG_AXES] = { "friction, no unit", "rolling friction, no unit",
                                                 "density, kg/m³" };
    const struct dig_plot    plot            = {
                      .title   = "",
                      .x_label = page->x_label,
                      .y_label = label[axis],
                      .x_to    = digreport_page_time(page, shift->last_us),
                      .height  = 280,
                      .series  = 2,
                      .s       = { { "90 % interval", DIG_PLOT_BAND, DIG_PLOT_PREDICTED, n, all, all + 2 * n,
                                     all + 3 * n },
                                   { "identified", DIG_PLOT_LINE, DIG_PLOT_PREDICTED, n, all, all + n, NULL } },
    };
    if (digreport_page_any(n, all + n)) {
        dig_plot_figure(&plot, to, c);
    }
    free(all);
}

static void put_gravel_row(FILE *const to, const struct digreport_gravel *const gravel)
{
    const struct dig_matched_gravel *const g = &gravel->match;
    (void)fputs("<tr>", to);
    digreport_page_time_cell(to, gravel->time_us);
    if (!g->known) {
        dig_html_put(to, "<td colspan=5>not known any more: %s</td></tr>\n", g->wanted);
        return;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const int d = dig_report_axis_digits(a);
        (void)fprintf(to, "<td><b>%.*f</b> (%.*f to %.*f)</td>", d, g->gravel.value[a], d,
                      g->low.value[a], d, g->high.value[a]);
    }
    (void)fprintf(to, "<td>%" PRId32 ", %s</td><td style=\"white-space:normal;text-align:left\">%s",
                  g->digs, g->forces ? "with force" : "moment alone",
                  g->outside ? "outside the table: the nearest" : "");
    if (g->untold[0] != '\0') {
        dig_html_put(to, "a family; not told: %s", g->untold_words);
    }
    (void)fputs("</td></tr>\n", to);
}

void digreport_page_gravels(const struct digreport_page *const page, FILE *const to,
                            struct dig_conditions *const c)
{
    const struct digreport_shift *const shift = page->shift;
    (void)fputs("<h2>Gravel</h2>\n", to);
    if (shift->gravels == 0) {
        (void)fputs("<p>No dig identified a gravel.</p>\n", to);
        return;
    }
    (void)fputs("<div class=grid>\n", to);
    for (int a = 0; a < DIG_AXES; a++) {
        put_gravel_plot(page, to, a, c);
    }
    (void)fputs("</div>\n<table class=wide><tr><th>time, UTC</th>", to);
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "<th>%s (90 %%)</th>", dig_report_axis(a));
    }
    (void)fputs("<th>digs</th><th></th></tr>\n", to);
    for (size_t i = 0; i < shift->gravels; i++) {
        put_gravel_row(to, &shift->gravel[i]);
    }
    (void)fputs("</table>\n", to);
}
