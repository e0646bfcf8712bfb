#include "closed_loop/report/report.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"
#include "core/markup.h"
#include "core/text.h"

#include <assert.h>
#include <math.h>

const char *dig_report_axis(const int axis)
{
    static const char *const title[DIG_AXES] = {
        [DIG_AXIS_FRICTION]      = "friction",
        [DIG_AXIS_ROLLING]       = "rolling friction",
        [DIG_AXIS_DENSITY_kgpm3] = "density, kg/m³",
    };
    assert(axis >= 0 && axis < DIG_AXES);
    return title[axis];
}

int dig_report_axis_digits(const int axis)
{
    return axis == DIG_AXIS_DENSITY_kgpm3 ? 0 : 2;
}

const char *dig_report_chance(const double chance, const size_t size, char text[const])
{
    (void)snprintf(text, size, chance < 1e-6 ? "below 1e-6" : "%.2g", chance);
    return text;
}

void dig_report_text(const struct dig_report *const report, FILE *const to)
{
    assert(report != NULL && to != NULL);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        dig_text_print(to, "\n  %s: %s\n", run->name, run->dig);
        (void)fprintf(to, "  %-18s %9s %11s   %s\n", "", "true", "identified", "90 % interval");
        for (int a = 0; a < DIG_AXES; a++) {
            const int d = dig_report_axis_digits(a);
            // The multi-byte ³ takes two bytes for one column.
            (void)fprintf(to, "  %-*s ", a == DIG_AXIS_DENSITY_kgpm3 ? 19 : 18, dig_report_axis(a));
            if (run->truth_known) {
                (void)fprintf(to, "%9.*f ", d, run->truth.value[a]);
            } else {
                (void)fprintf(to, "%9s ", "unknown");
            }
            (void)fprintf(to, "%11.*f   %.*f to %.*f\n", d, run->gravel.value[a], d,
                          run->low.value[a], d, run->high.value[a]);
        }
        (void)fprintf(to,
                      "  error of the predicted %s dig: %.3f   (noise floor, one sigma: %.3f)\n",
                      run->real.trajectory, run->error, run->noise_floor);
    }
}

static void put_json_gravel(FILE *const to, const char *const name,
                            const struct dig_gravel *const gravel)
{
    dig_json_put(to, ",%s:", name);
    for (int a = 0; a < DIG_AXES; a++) {
        dig_json_put(to, a == 0 ? "{%s:%g" : ",%s:%g", dig_axis_name((enum dig_axis)a),
                     gravel->value[a]);
    }
    (void)fputc('}', to);
}

void dig_report_json(const struct dig_report *const report, FILE *const to)
{
    assert(report != NULL && to != NULL);
    dig_json_put(to,
                 "{\"metric\":\"relative Euclidean norm of the moment, moving average ±0.16 s\","
                 "\"lambda\":%g,\"runs\":[",
                 report->lambda);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        dig_json_put(to, r == 0 ? "{\"name\":%s" : ",{\"name\":%s", run->name);
        if (run->truth_known) {
            put_json_gravel(to, "truth", &run->truth);
        } else {
            (void)fputs(",\"truth\":null", to);
        }
        put_json_gravel(to, "identified", &run->gravel);
        put_json_gravel(to, "low", &run->low);
        put_json_gravel(to, "high", &run->high);
        put_json_gravel(to, "nearest", &run->nearest);
        dig_json_put(to, ",\"distance\":%g,\"predicted\":%s,\"error\":%g,\"noise_floor\":%g}",
                     run->distance, run->real.trajectory, run->error, run->noise_floor);
    }
    (void)fprintf(to, "]}\n");
}

static void put_table(FILE *const to, const struct dig_report_run *const run)
{
    (void)fputs("<table><tr><th></th><th>true</th><th>identified</th><th>90 % interval</th>"
                "<th>nearest entry</th></tr>\n",
                to);
    for (int a = 0; a < DIG_AXES; a++) {
        const int d = dig_report_axis_digits(a);
        (void)fprintf(to, "<tr><th>%s</th>", dig_report_axis(a));
        if (run->truth_known) {
            (void)fprintf(to, "<td>%.*f</td>", d, run->truth.value[a]);
        } else {
            (void)fputs("<td>unknown</td>", to);
        }
        dig_html_put(to, "<td><b>%.*f</b></td><td>%.*f to %.*f</td><td>%.*f</td></tr>\n", d,
                     run->gravel.value[a], d, run->low.value[a], d, run->high.value[a], d,
                     run->nearest.value[a]);
    }
    dig_html_put(to,
                 "</table>\n<p>Error of the predicted <i>%s</i> dig: <b>%.3f</b>; "
                 "noise floor (1 σ of what it would be if the model were complete): %.3f.</p>\n",
                 run->real.trajectory, run->error, run->noise_floor);
}

// Measured against the model along one dig; what lies outside the measured range is a gap.
static void put_plot(FILE *const to, const struct dig_report_dig *const dig, const double lambda,
                     const char *const title, const char *const model,
                     struct dig_conditions *const c)
{
    struct dig_plot_dig p;
    double              fed[DIG_CURVE_POINTS];
    const double        kNm = 1e-3 * pow(lambda, 4.0); // at machine scale, of a rig's N·m
    dig_plot_of_dig(kNm, dig->measured_Nm, dig->first, dig->last, dig->model_Nm, dig->sigma_Nm, &p);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        fed[k] = kNm * dig->recording_Nm[k];
    }
    const size_t          n    = DIG_CURVE_POINTS;
    const struct dig_plot plot = {
        .title        = title,
        .x_label      = "path of the dig done, %",
        .y_label      = "moment about the bucket pin, kN·m",
        .right_label  = "at rig scale, N·m",
        .right_factor = 1.0 / kNm,
        .from_zero    = true,
        .height       = 370,
        .series       = 4,
        .s = { { "90 % of digs", DIG_PLOT_BAND, DIG_PLOT_PREDICTED, n, p.x, p.low, p.high },
               { "recording fed to the rig", DIG_PLOT_DOTTED, DIG_PLOT_FED, n, p.x, fed, NULL },
               { model, DIG_PLOT_DASHED, DIG_PLOT_PREDICTED, n, p.x, p.model, NULL },
               { "measured through pressures", DIG_PLOT_LINE, DIG_PLOT_MEASURED, n, p.x, p.measured,
                 NULL } },
    };
    dig_plot_figure(&plot, to, c);
}

static void put_sentence(FILE *const to, const struct dig_report *const report)
{
    (void)fputs("<p class=result>What was predicted from one simple dig was off by ", to);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        dig_html_put(to, "%s%.0f %% (noise floor %.0f %%) in the run %s", r == 0 ? "" : ", by ",
                     100.0 * run->error, 100.0 * run->noise_floor, run->name);
    }
    (void)fputs(".</p>\n", to);
}

enum dig_status dig_report_html(const struct dig_report *const report, FILE *const to,
                                struct dig_error *const error)
{
    assert(report != NULL && to != NULL);
    struct dig_conditions c = { .error = error };
    dig_html_begin(to, report->title);
    put_sentence(to, report);
    (void)fputs("<p>Table: ", to);
    dig_html_without_folders(to, report->table);
    (void)fprintf(to,
                  ". The machine is %.3g times the rig, which makes a moment %.0f times as large."
                  "</p>\n",
                  report->lambda, pow(report->lambda, 4.0));
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        dig_html_put(to, "<h2>%s</h2>\n<p>%s</p>\n", run->name, run->dig);
        put_table(to, run);
        (void)fputs("<div class=grid>\n", to);
        put_plot(to, &run->simple, report->lambda, "The simple dig that identified the gravel",
                 "identified gravel", &c);
        put_plot(to, &run->real, report->lambda, "The actual dig, predicted before it was dug",
                 "predicted", &c);
        (void)fputs("</div>\n", to);
    }
    dig_html_end(to, DIG_REPORT_ERROR_NOTE);
    return c.status;
}
