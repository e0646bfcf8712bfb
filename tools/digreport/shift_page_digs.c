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
                      DIG_PLOT_BAND_SIGMAS * sigma);
    } else {
        (void)fputs("<td>–</td>", to);
    }
}

// A picture: a number of each dig over time. Measured points, and the predicted as a short line in
// the box that holds 90 % of digs.
struct picture {
    const char *title, *y_label;
    const char *right_label;      // NULL: no second scale
    const char *predicted, *band; // in the key; NULL: there is none
};

enum { DIGS, PEAK, ENERGY, ERROR, PICTURES };

static const struct picture pictures[PICTURES] = {
    [DIGS]   = { "Digs", "digs done", NULL, NULL, NULL },
    [PEAK]   = { "Peak of each dig", "peak moment, kN·m", "at rig scale, N·m", "predicted",
                 "90 % of digs" },
    [ENERGY] = { "Energy of each dig", "energy, kJ", "at rig scale, J", "predicted",
                 "90 % of digs" },
    [ERROR]  = { "Error of each prediction", "error, % of the moment", NULL, "noise floor", NULL },
};

// What a picture shows of a dig; NaN: nothing.
struct number {
    double measured, predicted, sigma;
};

static struct number number_of(const struct digreport_shift *const shift, const int picture,
                               const size_t i)
{
    const struct digreport_dig *const d = &shift->dig[i];
    switch (picture) {
    case PEAK:
        return (struct number){ 1e-3 * d->peak_Nm, 1e-3 * d->predicted_peak_Nm,
                                1e-3 * d->predicted_peak_sigma_Nm };
    case ENERGY:
        return (struct number){ 1e-3 * d->energy_J, 1e-3 * d->predicted_energy_J,
                                1e-3 * d->predicted_energy_sigma_J };
    case ERROR: return (struct number){ 100.0 * d->error, 100.0 * d->noise_floor, (double)NAN };
    default: return (struct number){ (double)i + 1.0, (double)NAN, (double)NAN };
    }
}

// A picture without any number is left out. room: of six curves of three points a dig.
static void put_picture(const struct digreport_page *const page, FILE *const to, const int picture,
                        double room[], struct dig_conditions *const c)
{
    const struct digreport_shift *const shift = page->shift;
    const struct picture *const         p     = &pictures[picture];
    const size_t                        n     = 3 * shift->digs; // boxes: two ends and a gap a dig
    double *const                       x     = room;
    double *const                       y     = room + n;
    double *const                       box_x = room + 2 * n;
    double *const                       box_y = room + 3 * n;
    double *const                       low   = room + 4 * n;
    double *const                       high  = room + 5 * n;
    const double                        x_to  = digreport_page_time(page, shift->last_us);
    const double                        width = 0.012 * fmax(x_to, 1e-6);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct number number = number_of(shift, picture, i);
        x[i]                       = digreport_page_time(page, shift->dig[i].time_us);
        y[i]                       = number.measured;
        for (size_t end = 0; end < 3; end++) {
            const size_t at   = 3 * i + end;
            const double half = DIG_PLOT_BAND_SIGMAS * number.sigma;
            box_x[at]         = x[i] + (end == 0 ? -width : width);
            box_y[at]         = end < 2 ? number.predicted : (double)NAN;
            low[at]           = box_y[at] - half;
            high[at]          = box_y[at] + half;
        }
    }
    if (!digreport_page_any(shift->digs, y)) {
        return;
    }
    struct dig_plot plot = {
        .title     = p->title,
        .x_label   = page->x_label,
        .y_label   = p->y_label,
        .x_to      = x_to,
        .from_zero = true,
        .counts    = picture == DIGS,
        .height    = 340,
    };
    if (p->right_label != NULL && shift->lambda > 0.0) {
        plot.right_label  = p->right_label;
        plot.right_factor = 1e3 * pow(shift->lambda, -4.0);
    }
    if (p->band != NULL && digreport_page_any(n, low)) {
        plot.s[plot.series++] =
            (struct dig_plot_series){ p->band, DIG_PLOT_BAND, DIG_PLOT_PREDICTED, n, box_x,
                                      low,     high };
    }
    if (digreport_page_any(n, box_y)) {
        plot.s[plot.series++] =
            (struct dig_plot_series){ p->predicted, DIG_PLOT_LINE, DIG_PLOT_PREDICTED, n, box_x,
                                      box_y,        NULL };
    }
    plot.s[plot.series++] = (struct dig_plot_series){ p->predicted != NULL ? "measured" : NULL,
                                                      DIG_PLOT_POINTS,
                                                      DIG_PLOT_MEASURED,
                                                      shift->digs,
                                                      x,
                                                      y,
                                                      NULL };
    dig_plot_figure(&plot, to, c);
}

static void put_pictures(const struct digreport_page *const page, FILE *const to,
                         struct dig_conditions *const c)
{
    double *const room = calloc(18 * page->shift->digs, sizeof *room);
    if (room == NULL) {
        c->status = dig_error_set(c->error, DIG_ENOMEM, "out of memory");
        return;
    }
    (void)fputs("<div class=grid>\n", to);
    for (int p = 0; p < PICTURES; p++) {
        put_picture(page, to, p, room, c);
    }
    (void)fputs("</div>\n", to);
    free(room);
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
        dig_html_put(to, "<td>%" PRId32 "</td><td>%s</td><td>%s</td><td>%.1f</td><td>%.1f</td>",
                     d->number, d->trajectory[0] != '\0' ? d->trajectory : "–",
                     ended[0] != '\0' ? ended : "–", d->duration_s, 1e-3 * d->peak_Nm);
        put_predicted(to, 1, 1e-3 * d->predicted_peak_Nm, 1e-3 * d->predicted_peak_sigma_Nm);
        if (scaled) {
            dig_html_put(to, "<td>%.2f</td>", to_rig * d->peak_Nm);
        }
        dig_html_put(to, "<td>%.1f</td>", 1e-3 * d->energy_J);
        put_predicted(to, 1, 1e-3 * d->predicted_energy_J, 1e-3 * d->predicted_energy_sigma_J);
        if (scaled) {
            dig_html_put(to, "<td>%.2f</td>", to_rig * d->energy_J);
        }
        dig_html_put(to, "<td>%.0f</td><td>%.0f</td></tr>\n", 100.0 * d->error,
                     100.0 * d->noise_floor);
    }
    (void)fputs("</table>\n", to);
}

void digreport_page_digs(const struct digreport_page *const page, FILE *const to,
                         struct dig_conditions *const c)
{
    assert(page != NULL && to != NULL);
    (void)fputs("<h2>Digs</h2>\n", to);
    if (page->shift->digs == 0) {
        (void)fputs("<p>No dig was finished.</p>\n", to);
        return;
    }
    put_pictures(page, to, c);
    put_digs(page->shift, to);
}
