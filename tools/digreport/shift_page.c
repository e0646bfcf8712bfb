#include "tools/digreport/shift_page.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define BAND_SIGMAS 1.645 // of 90 %
#define MEASURED    0xc0392bU
#define PREDICTED   0x1f5fa8U

static const char *const axis_title[DIG_AXES] = { "friction", "rolling friction",
                                                  "density, kg/m³" };

struct page {
    const struct digreport_shift         *shift;
    const struct digreport_shift_subject *subject;
    double                                unit_us; // of the time axis
    char                                  x_label[64];
};

static void put_time_cell(FILE *const to, const int64_t time_us)
{
    const time_t seconds = (time_t)(time_us / 1000000);
    struct tm    utc;
    char         text[32] = "";
    if (gmtime_r(&seconds, &utc) != NULL) {
        (void)strftime(text, sizeof text, "%H:%M:%S", &utc);
    }
    (void)fprintf(to, "<th>%s</th>", text);
}

// A day and a time, or nothing where there is none such.
static void format_date(const int64_t time_us, const size_t size, char text[])
{
    const time_t seconds = (time_t)(time_us / 1000000);
    struct tm    utc;
    text[0] = '\0';
    if (gmtime_r(&seconds, &utc) != NULL) {
        (void)strftime(text, size, "%Y-%m-%d %H:%M UTC", &utc);
    }
}

static void put_cell(FILE *const to, const int digits, const double value)
{
    if (isfinite(value)) {
        (void)fprintf(to, "<td>%.*f</td>", digits, value);
    } else {
        (void)fputs("<td>–</td>", to);
    }
}

// What was predicted, and half the interval that holds 90 % of digs.
static void put_predicted(FILE *const to, const int digits, const double value, const double sigma)
{
    if (isfinite(value) && isfinite(sigma)) {
        (void)fprintf(to, "<td>%.*f ± %.*f</td>", digits, value, digits, BAND_SIGMAS * sigma);
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

static double hours_of(const struct page *const page, const int64_t time_us)
{
    return (double)(time_us - page->shift->first_us) / page->unit_us;
}

static void set_dig(const struct page *const page, struct series *const s, const size_t i,
                    const double measured, const double predicted, const double sigma)
{
    const struct digreport_shift *const shift = page->shift;
    const double                        width = 0.006 * fmax(hours_of(page, shift->last_us), 1e-6);
    s->x[i]                                   = hours_of(page, shift->dig[i].time_us);
    s->y[i]                                   = measured;
    for (size_t end = 0; end < 3; end++) {
        const size_t at = 3 * i + end;
        const double y  = end < 2 ? predicted : (double)NAN;
        s->box_x[at]    = s->x[i] + (end == 0 ? -width : width);
        s->box_y[at]    = y;
        s->low[at]      = y - BAND_SIGMAS * sigma;
        s->high[at]     = y + BAND_SIGMAS * sigma;
    }
}

static bool any_finite(const size_t n, const double value[])
{
    size_t i = 0;
    while (i < n && !isfinite(value[i])) {
        i++;
    }
    return i < n;
}

static enum dig_status put_dig_plot(const struct page *const page, FILE *const to,
                                    const struct series *const s, const char *const title,
                                    const char *const y_label, const char *const predicted,
                                    const char *const band, struct dig_error *const error)
{
    const size_t    n    = 3 * s->n;
    struct dig_plot plot = {
        .title = title, .x_label = page->x_label, .y_label = y_label, .width = 480, .height = 360
    };
    if (!any_finite(s->n, s->y)) {
        return DIG_OK;
    }
    if (band != NULL && any_finite(n, s->low)) {
        plot.s[plot.series++] = (struct dig_plot_series){ band,     DIG_PLOT_BAND, PREDICTED, n,
                                                          s->box_x, s->low,        s->high };
    }
    if (any_finite(n, s->box_y)) {
        plot.s[plot.series++] = (struct dig_plot_series){ predicted, DIG_PLOT_LINE, PREDICTED, n,
                                                          s->box_x,  s->box_y,      NULL };
    }
    plot.s[plot.series++] = (struct dig_plot_series){
        predicted != NULL ? "measured" : NULL, DIG_PLOT_POINTS, MEASURED, s->n, s->x, s->y, NULL
    };
    (void)fputs("<figure>\n", to);
    const enum dig_status status = dig_plot_svg(&plot, to, error);
    (void)fputs("</figure>\n", to);
    return status;
}

static enum dig_status put_dig_plots(const struct page *const page, FILE *const to,
                                     struct dig_error *const error)
{
    const struct digreport_shift *const shift = page->shift;
    struct series                       s;
    enum dig_status                     status = make_series(shift->digs, &s);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "out of memory");
    }
    char peak_label[96];
    char energy_label[96];
    (void)snprintf(peak_label, sizeof peak_label, "peak, kN·m (1 is %.3g N·m at rig scale)",
                   1e3 * pow(shift->lambda, -4.0));
    (void)snprintf(energy_label, sizeof energy_label, "energy, kJ (1 is %.3g J at rig scale)",
                   1e3 * pow(shift->lambda, -4.0));
    (void)fputs("<div class=grid>\n", to);
    for (size_t i = 0; i < shift->digs; i++) {
        set_dig(page, &s, i, (double)i + 1.0, (double)NAN, (double)NAN);
    }
    status = put_dig_plot(page, to, &s, "Digs", "digs done", NULL, NULL, error);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 1e-3 * d->peak_Nm, 1e-3 * d->predicted_peak_Nm,
                1e-3 * d->predicted_peak_sigma_Nm);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Peak of each dig", peak_label, "predicted",
                              "90 % of digs", error);
    }
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 1e-3 * d->energy_J, 1e-3 * d->predicted_energy_J,
                1e-3 * d->predicted_energy_sigma_J);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Energy of each dig", energy_label, "predicted",
                              "90 % of digs", error);
    }
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        set_dig(page, &s, i, 100.0 * d->error, 100.0 * d->noise_floor, (double)NAN);
    }
    if (status == DIG_OK) {
        status = put_dig_plot(page, to, &s, "Error of each prediction", "error, % of the moment",
                              "noise floor", NULL, error);
    }
    (void)fputs("</div>\n", to);
    free(s.x);
    return status;
}

static void put_digs(const struct digreport_shift *const shift, FILE *const to)
{
    const double to_rig = pow(shift->lambda, -4.0);
    (void)fputs(
        "<table class=digs><tr><th>time, UTC</th><th>dig</th><th>along</th><th>duration, s</th>"
        "<th>peak, kN·m</th><th>predicted ± 90 %</th><th>rig scale, N·m</th>"
        "<th>energy, kJ</th><th>predicted ± 90 %</th><th>rig scale, J</th>"
        "<th>error, %</th><th>noise floor, %</th></tr>\n",
        to);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        (void)fputs("<tr>", to);
        put_time_cell(to, d->time_us);
        (void)fprintf(to, "<td>%" PRId32 "</td><td>", d->number);
        dig_html_text(to, d->trajectory[0] != '\0' ? d->trajectory : "–");
        (void)fputs("</td>", to);
        put_cell(to, 1, d->duration_s);
        put_cell(to, 1, 1e-3 * d->peak_Nm);
        put_predicted(to, 1, 1e-3 * d->predicted_peak_Nm, 1e-3 * d->predicted_peak_sigma_Nm);
        put_cell(to, 2, to_rig * d->peak_Nm);
        put_cell(to, 1, 1e-3 * d->energy_J);
        put_predicted(to, 1, 1e-3 * d->predicted_energy_J, 1e-3 * d->predicted_energy_sigma_J);
        put_cell(to, 2, to_rig * d->energy_J);
        put_cell(to, 0, 100.0 * d->error);
        put_cell(to, 0, 100.0 * d->noise_floor);
        (void)fputs("</tr>\n", to);
    }
    (void)fputs("</table>\n", to);
}

// A gravel stands from its match to the next; a gap where none was known.
static enum dig_status put_gravel_plot(const struct page *const page, FILE *const to,
                                       const int axis, struct dig_error *const error)
{
    const struct digreport_shift *const shift = page->shift;
    const size_t                        n     = 3 * shift->gravels;
    double *const                       all   = calloc(4 * n, sizeof *all);
    if (all == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    for (size_t i = 0; i < shift->gravels; i++) {
        const struct digreport_gravel *const g = &shift->gravel[i];
        const int64_t                        end_us =
            i + 1 < shift->gravels ? shift->gravel[i + 1].time_us : shift->last_us;
        for (size_t end = 0; end < 3; end++) {
            const size_t at    = 3 * i + end;
            const bool   shown = g->known && end < 2;
            all[at]            = hours_of(page, end == 0 ? g->time_us : end_us);
            all[n + at]        = shown ? g->gravel.value[axis] : (double)NAN;
            all[2 * n + at]    = shown ? g->low.value[axis] : (double)NAN;
            all[3 * n + at]    = shown ? g->high.value[axis] : (double)NAN;
        }
    }
    const struct dig_plot plot = {
        .title   = "",
        .x_label = page->x_label,
        .y_label = axis_title[axis],
        .width   = 480,
        .height  = 280,
        .series  = 2,
        .s = { { "90 % interval", DIG_PLOT_BAND, PREDICTED, n, all, all + 2 * n, all + 3 * n },
               { "identified", DIG_PLOT_LINE, PREDICTED, n, all, all + n, NULL } },
    };
    enum dig_status status = DIG_OK;
    if (any_finite(n, all + n)) {
        (void)fputs("<figure>\n", to);
        status = dig_plot_svg(&plot, to, error);
        (void)fputs("</figure>\n", to);
    }
    free(all);
    return status;
}

static void put_gravel_row(FILE *const to, const struct digreport_gravel *const g)
{
    (void)fputs("<tr>", to);
    put_time_cell(to, g->time_us);
    if (!g->known) {
        (void)fputs("<td colspan=5>not known any more: ", to);
        dig_html_text(to, g->wanted);
        (void)fputs("</td></tr>\n", to);
        return;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const int d = a == DIG_AXIS_DENSITY_kgpm3 ? 0 : 2;
        (void)fprintf(to, "<td><b>%.*f</b> (%.*f to %.*f)</td>", d, g->gravel.value[a], d,
                      g->low.value[a], d, g->high.value[a]);
    }
    (void)fprintf(to, "<td>%" PRId32 ", %s</td><td>%s", g->digs,
                  g->forces ? "with force" : "moment alone",
                  g->outside ? "outside the table: the nearest" : "");
    if (g->untold[0] != '\0') {
        (void)fputs("a family; not told: ", to);
        dig_html_text(to, g->untold);
    }
    (void)fputs("</td></tr>\n", to);
}

static enum dig_status put_gravels(const struct page *const page, FILE *const to,
                                   struct dig_error *const error)
{
    const struct digreport_shift *const shift = page->shift;
    (void)fputs("<h2>Gravel</h2>\n", to);
    if (shift->gravels == 0) {
        (void)fputs("<p>No dig identified a gravel.</p>\n", to);
        return DIG_OK;
    }
    enum dig_status status = DIG_OK;
    (void)fputs("<div class=grid>\n", to);
    for (int a = 0; a < DIG_AXES && status == DIG_OK; a++) {
        status = put_gravel_plot(page, to, a, error);
    }
    (void)fputs("</div>\n<table><tr><th>time, UTC</th>", to);
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "<th>%s (90 %%)</th>", axis_title[a]);
    }
    (void)fputs("<th>digs</th><th></th></tr>\n", to);
    for (size_t i = 0; i < shift->gravels; i++) {
        put_gravel_row(to, &shift->gravel[i]);
    }
    (void)fputs("</table>\n", to);
    return status;
}

static void put_effects(const struct dig_model *const model, FILE *const to)
{
    (void)fputs("<h2>Effects in the model</h2>\n", to);
    if (model == NULL) {
        (void)fputs("<p>No model file was given (<code>--model</code>).</p>\n", to);
        return;
    }
    if (model->effects == 0 && model->unlisted == NULL) {
        (void)fputs("<p>The model has no effect.</p>\n", to);
        return;
    }
    (void)fputs("<table><tr><th>effect</th><th>parameter</th><th>value</th><th>90 % interval</th>"
                "</tr>\n",
                to);
    for (size_t e = 0; e < model->effects; e++) {
        const struct dig_model_effect *const effect = &model->effect[e];
        for (size_t p = 0; p < effect->parameters; p++) {
            const struct dig_model_parameter *const q = &effect->parameter[p];
            (void)fprintf(to, "<tr><th>%s</th><td>", dig_effect_name(effect->effect));
            dig_html_text(to, q->name);
            (void)fprintf(to, "</td><td>%.4g</td><td>%.4g to %.4g</td></tr>\n", q->value, q->low,
                          q->high);
        }
    }
    if (model->unlisted != NULL) {
        (void)fputs("<tr><th>unlisted</th><td>depends on ", to);
        dig_html_text(to, model->unlisted->depends_on);
        (void)fputs("</td><td></td><td></td></tr>\n", to);
    }
    (void)fputs("</table>\n", to);
}

// A replay's note may name a file: its folders are somebody's machine.
static void put_without_folders(FILE *const to, const char *const said)
{
    char   text[DIGREPORT_TEXT];
    size_t n    = 0;
    size_t word = 0;
    for (const char *c = said; *c != '\0'; c++) {
        if (*c == '/' && n > word) {
            n = word;
        } else if (*c != '/') {
            text[n++] = *c;
        }
        word = *c == ' ' ? n : word;
    }
    text[n] = '\0';
    dig_html_text(to, text);
}

static void put_events(const struct digreport_shift *const shift, FILE *const to)
{
    (void)fputs("<h2>Health</h2>\n", to);
    if (shift->misread > 0) {
        (void)fprintf(to,
                      "<p>%" PRId64 " messages on the daemon's channels were not understood: they "
                      "are of another version, or of another sender.</p>\n",
                      shift->misread);
    }
    if (shift->events == 0) {
        (void)fputs("<p>Nothing was wrong.</p>\n", to);
        return;
    }
    (void)fputs("<table class=words><tr><th>from, UTC</th><th>to</th><th>what</th><th>times</th>"
                "<th>what to do</th></tr>\n",
                to);
    for (size_t i = 0; i < shift->events; i++) {
        const struct digreport_event *const e = &shift->event[i];
        (void)fputs("<tr>", to);
        put_time_cell(to, e->from_us);
        put_time_cell(to, e->to_us);
        (void)fputs("<td>", to);
        if (e->text != NULL) {
            dig_html_text(to, e->text->what);
        } else {
            put_without_folders(to, e->said);
        }
        if (e->count > 0) {
            (void)fprintf(to, "</td><td>%" PRId64 "</td><td>", e->count);
        } else {
            (void)fputs("</td><td></td><td>", to);
        }
        dig_html_text(to, e->text != NULL ? e->text->todo : "");
        (void)fputs("</td></tr>\n", to);
    }
    (void)fputs("</table>\n", to);
}

static void put_subject(const struct page *const page, FILE *const to)
{
    const struct digreport_shift *const shift = page->shift;
    char                                from[48];
    char                                until[48];
    format_date(shift->first_us, sizeof from, from);
    format_date(shift->last_us, sizeof until, until);
    (void)fputs("<p class=result><b>", to);
    digreport_shift_sentence(shift, to);
    (void)fprintf(to, "</b></p>\n<p>%s to %s, from %zu log%s. Machine ", from, until,
                  page->subject->logs, page->subject->logs == 1 ? "" : "s");
    dig_html_text(to, page->subject->machine);
    (void)fputs(", table of scene ", to);
    dig_html_text(to, page->subject->scene);
    (void)fprintf(to, "; the machine is %.3g times the rig. ", shift->lambda);
    (void)fprintf(to,
                  "By the daemon's counts %" PRId32 " digs were dug to their end, %" PRId32
                  " were aborted.</p>\n",
                  shift->whole, shift->aborted);
}

static enum dig_status put_page(void *const context, FILE *const to, struct dig_error *const error)
{
    const struct page *const page = context;
    dig_html_begin(to, page->subject->title);
    (void)fputs("<style>.words td,.words tr:first-child th{text-align:left}.digs "
                "tr+tr>*{white-space:nowrap}"
                ".digs td,.digs th{padding:.25em .4em}</style>\n",
                to);
    put_subject(page, to);
    (void)fputs("<h2>Digs</h2>\n", to);
    enum dig_status status = DIG_OK;
    if (page->shift->digs > 0) {
        status = put_dig_plots(page, to, error);
        put_digs(page->shift, to);
    } else {
        (void)fputs("<p>No dig was finished.</p>\n", to);
    }
    if (status == DIG_OK) {
        status = put_gravels(page, to, error);
    }
    put_effects(page->subject->model, to);
    put_events(page->shift, to);
    (void)fputs("<footer>Error: relative Euclidean norm of the moment, measured minus the first "
                "prediction made in the dig, over time from there to exit, moving average ±0.16 s "
                "of rig time. Noise floor: 1 σ of what it would be if the model were complete. "
                "Predicted: expected of one dig, with the interval that holds 90 % of digs. "
                "Energy: work of the bucket on the soil, where forces are measured. Predictions "
                "are advice, not a safety function.</footer>\n",
                to);
    dig_html_end(to);
    return status;
}

enum dig_status digreport_shift_html(const struct digreport_shift *const         shift,
                                     const struct digreport_shift_subject *const subject,
                                     const char *const path, struct dig_error *const error)
{
    assert(shift != NULL && subject != NULL && path != NULL);
    const double minutes = (double)(shift->last_us - shift->first_us) / 6e7;
    struct page  page    = { shift, subject, minutes > 180.0 ? 3.6e9 : 6e7, "" };
    char         clock[32];
    format_date(shift->first_us, sizeof clock, clock);
    (void)snprintf(page.x_label, sizeof page.x_label, "time since %s, %s", clock,
                   minutes > 180.0 ? "h" : "min");
    return dig_html_save(path, put_page, &page, error);
}
