#include "closed_loop/report/residual_report.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"

#include <assert.h>
#include <math.h>

static const char *const of_channel[DIG_FORCE_CHANNELS] = { "moment", "Fx", "Fz" };

// One line a dig and channel: sigmas by part, and the share of the whole dig before and after.
static void put_lines(FILE *const to, const struct dig_measured *const m,
                      const struct dig_residuals_dig *const dig)
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        const struct dig_residual *const soil   = &dig->before[DIG_PART_SOIL][c];
        const struct dig_residual *const lifted = &dig->before[DIG_PART_LIFTED][c];
        if (!isfinite(soil->rms) && !isfinite(lifted->rms)) {
            continue;
        }
        (void)fputs("<tr><th>", to);
        if (c == DIG_CHANNEL_MY_Nm) {
            dig_html_without_folders(to, m->name);
            (void)fprintf(to, "<br><span class=muted>%s</span>", dig_residuals_use_name(m->use));
        }
        dig_html_put(to,
                     "</th><td>%s</td><td>%.1f</td><td>%.1f</td><td>%.1f</td><td>%.3f</td>"
                     "<td>%.3f</td></tr>\n",
                     of_channel[c], c == DIG_CHANNEL_MY_Nm ? dig->air_sigmas : (double)NAN,
                     soil->sigmas, lifted->sigmas,
                     hypot(fmax(soil->relative, 0.0), fmax(lifted->relative, 0.0)),
                     hypot(fmax(dig->after[DIG_PART_SOIL][c].relative, 0.0),
                           fmax(dig->after[DIG_PART_LIFTED][c].relative, 0.0)));
    }
}

static void put_digs(FILE *const to, const struct dig_trace *const trace)
{
    const struct dig_residuals *const residuals = trace->residuals;
    (void)fputs("<h2>Residual dig by dig</h2>\n<table><tr><th>dig</th><th>of</th>"
                "<th>air, σ</th><th>soil, σ</th><th>lifted, σ</th><th>before</th><th>after</th>"
                "</tr>\n",
                to);
    for (size_t i = 0; i < trace->judged.digs; i++) {
        put_lines(to, &trace->judged.measured[i], &residuals->dig[i]);
    }
    (void)fputs(
        "</table>\n<p class=muted>Measured minus predicted by the gravel alone, rms over "
        "1 σ of one dig, and over the dig's own size before and after what was found.</p>\n",
        to);
}

static void put_plot(FILE *const to, const struct dig_trend *const trend, const char *const x_label,
                     const double scale, struct dig_conditions *const c)
{
    double x[DIG_TREND_BINS];
    double y[DIG_TREND_BINS];
    double low[DIG_TREND_BINS];
    double high[DIG_TREND_BINS];
    double zero[DIG_TREND_BINS] = { 0.0 };
    for (size_t b = 0; b < trend->bins; b++) {
        const struct dig_trend_bin *const bin = &trend->bin[b];
        x[b]                                  = scale * bin->at;
        y[b]                                  = 100.0 * bin->mean;
        low[b]                                = 100.0 * (bin->mean - bin->standard_error);
        high[b]                               = 100.0 * (bin->mean + bin->standard_error);
    }
    const struct dig_plot plot = {
        .title   = "",
        .x_label = x_label,
        .y_label = "residual, % of the dig",
        .height  = 300,
        .series  = 4,
        .s = { { "1 σ of the mean over digs", DIG_PLOT_BAND, DIG_PLOT_BEFORE, trend->bins, x, low,
                 high },
               { NULL, DIG_PLOT_LINE, DIG_PLOT_FED, trend->bins, x, zero, NULL },
               { "mean", DIG_PLOT_LINE, DIG_PLOT_BEFORE, trend->bins, x, y, NULL },
               { NULL, DIG_PLOT_POINTS, DIG_PLOT_BEFORE, trend->bins, x, y, NULL } },
    };
    dig_plot_figure(&plot, to, c);
}

static void put_slopes(FILE *const to, const struct dig_residuals *const residuals)
{
    (void)fputs("<table><tr><th>against</th>", to);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        if (residuals->known[c]) {
            (void)fprintf(to, "<th>%s: r</th>", of_channel[c]);
        }
    }
    (void)fputs("</tr>\n", to);
    for (int s = 0; s < DIG_REGRESSORS; s++) {
        static const char *const name[DIG_REGRESSORS] = { "path",         "depth", "speed",
                                                          "acceleration", "fill",  "pass" };
        (void)fprintf(to, "<tr><th>%s</th>", name[s]);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            if (residuals->known[c]) {
                dig_html_put(to, "<td>%.2f</td>", residuals->trend[c][s].correlation);
            }
        }
        (void)fputs("</tr>\n", to);
    }
    (void)fputs("</table>\n<p class=muted>r: correlation of the residual with the state of the "
                "dig, over the digs fitted to. An error of the table is in all digs alike, and "
                "shows here, too.</p>\n",
                to);
}

void dig_residuals_html(const struct dig_trace *const trace, FILE *const to,
                        struct dig_conditions *const c)
{
    assert(trace != NULL && to != NULL);
    const struct dig_residuals *const residuals = trace->residuals;
    if (residuals == NULL) {
        return;
    }
    put_digs(to, trace);
    if (!residuals->known[DIG_CHANNEL_MY_Nm]) {
        return;
    }
    const struct dig_trend *const moment = residuals->trend[DIG_CHANNEL_MY_Nm];
    (void)fputs("<h2>What the residual goes with</h2>\n<div class=grid>\n", to);
    put_plot(to, &moment[DIG_REGRESSOR_PATH], "path of the dig done, %", 100.0, c);
    put_plot(to, &moment[DIG_STATE_DEPTH_m], "depth of the tooth at rig scale, mm", 1e3, c);
    (void)fputs("</div>\n", to);
    put_slopes(to, residuals);
}
