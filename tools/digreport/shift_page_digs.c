#include "tools/digreport/shift_page_parts.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"
#include "closed_loop/report/report.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

// What was predicted, and half the interval that holds 90 % of digs.
static void put_predicted(FILE *const to, const int digits, const double value, const double sigma)
{
    if (isfinite(value) && isfinite(sigma)) {
        (void)fprintf(to, "<td>%.*f ± %.*f</td>", digits, value, digits,
                      DIG_REPORT_BAND_SIGMAS * sigma);
    } else {
        (void)fputs("<td>–</td>", to);
    }
}

// One number of each dig over time: measured points, and the predicted as a short line in the box
// that holds 90 % of digs. A picture without any number is left out.
struct series {
    size_t  n;
    double *x, *y, *box_x, *box_y, *low, *high; // boxes: two ends and a gap a dig
};

static enum dig_status make_series(const size_t digs, struct series *const s)
{
    double *const all = calloc(14 * digs + 1, sizeof *all);
    *s                = (struct series){ .n     = digs,
                                         .x     = all,
                                         .y     = all + digs,
                                         .box_x = all + 2 * digs,
                                         .box_y = all + 5 * digs,
                                         .low   = all + 8 * digs,
                                         .high  = all + 11 * digs };
    return all != NULL ? DIG_OK : DIG_ENOMEM;
}

static void set_dig(const struct digreport_page *const page, struct series *const s, const size_t i,
                    const double measured, const double predicted, const double sigma)
{
    const struct digreport_shift *const shift = page->shift;
    const double width = 0.012 * fmax(digreport_page_time(page, shift->last_us), 1e-6);
    s->x[i]            = digreport_page_time(page, shift->dig[i].time_us);
    s->y[i]            = measured;
    for (size_t end = 0; end < 3; end++) {
        const size_t at = 3 * i + end;
        const double y  = end < 2 ? predicted : (double)NAN;
        s->box_x[at]    = s->x[i] + (end == 0 ? -width : width);
        s->box_y[at]    = y;
        s->low[at]      = y - DIG_REPORT_BAND_SIGMAS * sigma;
        s->high[at]     = y + DIG_REPORT_BAND_SIGMAS * sigma;
    }
}

static enum dig_status put_dig_plot(const struct digreport_page *const page, FILE *const to,
                                    const struct series *const s, const char *const title,
                                    const char *const y_label, const char *const right_label,
                                    const char *const predicted, const char *const band,
                                    struct dig_error *const error)
{
    const size_t    n    = 3 * s->n;
    struct dig_plot plot = {
        .title     = title,
        .x_label   = page->x_label,
        .y_label   = y_label,
        .x_to      = digreport_page_time(page, page->shift->last_us),
        .from_zero = true,
        .width     = 480,
        .height    = 340,
    };
    if (right_label != NULL && page->shift->lambda > 0.0) {
        plot.right_label  = right_label;
        plot.right_factor = 1e3 * pow(page->shift->lambda, -4.0);
    }
    if (!digreport_page_any(s->n, s->y)) {
        return DIG_OK;
    }
    if (band != NULL && digreport_page_any(n, s->low)) {
        plot.s[plot.series++] =
            (struct dig_plot_series){ band,   DIG_PLOT_BAND, DIG_PLOT_PREDICTED, n, s->box_x,
                                      s->low, s->high };
    }
    if (digreport_page_any(n, s->box_y)) {
        plot.s[plot.series++] =
            (struct dig_plot_series){ predicted, DIG_PLOT_LINE, DIG_PLOT_PREDICTED, n, s->box_x,
                                      s->box_y,  NULL };
    }
    plot.s[plot.series++] = (struct dig_plot_series){ predicted != NULL ? "measured" : NULL,
                                                      DIG_PLOT_POINTS,
                                                      DIG_PLOT_MEASURED,
                                                      s->n,
                                                      s->x,
                                                      s->y,
                                                      NULL };
    return dig_plot_figure(&plot, to, error);
}

static enum dig_status put_dig_plots(const struct digreport_page *const page, FILE *const to,
                                     struct dig_error *const error)
{
    const struct digreport_shift *const shift = page->shift;
    struct series                       s;
    enum dig_status                     status = make_series(shift->digs, &s);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "out of memory");
    }
    (void)fputs("<div class=grid>\n", to);
    for (size_t i = 0; i < shift->digs; i++) {
        set_dig(page, &s, i, (double)i + 1.0, (double)NAN, (double)NAN);
    }
    status = put_dig_plot(page, to, &s, "Digs", "digs done", NULL, NULL, NULL, error);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 1e-3 * d->peak_Nm, 1e-3 * d->predicted_peak_Nm,
                1e-3 * d->predicted_peak_sigma_Nm);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Peak of each dig", "peak moment, kN·m",
                              "at rig scale, N·m", "predicted", "90 % of digs", error);
    }
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 1e-3 * d->energy_J, 1e-3 * d->predicted_energy_J,
                1e-3 * d->predicted_energy_sigma_J);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Energy of each dig", "energy, kJ", "at rig scale, J",
                              "predicted", "90 % of digs", error);
    }
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 100.0 * d->error, 100.0 * d->noise_floor, (double)NAN);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Error of each prediction", "error, % of the moment",
                              NULL, "noise floor", NULL, error);
    }
    (void)fputs("</div>\n", to);
    free(s.x);
    return status;
}

static void put_digs(const struct digreport_shift *const shift, FILE *const to)
{
    const bool   scaled = shift->lambda > 0.0;
    const double to_rig = pow(shift->lambda, -4.0);
    (void)fprintf(to,
                  "<table class=wide><tr><th>time, UTC</th><th>dig</th><th>along</th><th>ended</th>"
                  "<th>duration, s</th><th>peak, kN·m</th><th>predicted ± 90 %%</th>%s"
                  "<th>energy, kJ</th><th>predicted ± 90 %%</th>%s<th>error, %%</th>"
                  "<th>noise floor, %%</th></tr>\n",
                  scaled ? "<th>rig scale, N·m</th>" : "", scaled ? "<th>rig scale, J</th>" : "");
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d     = &shift->dig[i];
        const char *const                 ended = digreport_ending_name(d->ended);
        (void)fputs("<tr>", to);
        digreport_page_time_cell(to, d->time_us);
        (void)fprintf(to, "<td>%" PRId32 "</td><td>", d->number);
        dig_html_text(to, d->trajectory[0] != '\0' ? d->trajectory : "–");
        (void)fprintf(to, "</td><td>%s</td>", ended[0] != '\0' ? ended : "–");
        dig_html_cell(to, 1, d->duration_s);
        dig_html_cell(to, 1, 1e-3 * d->peak_Nm);
        put_predicted(to, 1, 1e-3 * d->predicted_peak_Nm, 1e-3 * d->predicted_peak_sigma_Nm);
        if (scaled) {
            dig_html_cell(to, 2, to_rig * d->peak_Nm);
        }
        dig_html_cell(to, 1, 1e-3 * d->energy_J);
        put_predicted(to, 1, 1e-3 * d->predicted_energy_J, 1e-3 * d->predicted_energy_sigma_J);
        if (scaled) {
            dig_html_cell(to, 2, to_rig * d->energy_J);
        }
        dig_html_cell(to, 0, 100.0 * d->error);
        dig_html_cell(to, 0, 100.0 * d->noise_floor);
        (void)fputs("</tr>\n", to);
    }
    (void)fputs("</table>\n", to);
}

enum dig_status digreport_page_digs(const struct digreport_page *const page, FILE *const to,
                                    struct dig_error *const error)
{
    assert(page != NULL && to != NULL);
    (void)fputs("<h2>Digs</h2>\n", to);
    if (page->shift->digs == 0) {
        (void)fputs("<p>No dig was finished.</p>\n", to);
        return DIG_OK;
    }
    const enum dig_status status = put_dig_plots(page, to, error);
    put_digs(page->shift, to);
    return status;
}
