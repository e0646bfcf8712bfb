#include "closed_loop/report.h"

#include "closed_loop/plot.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const axis_title[DIG_AXES] = {
    [DIG_AXIS_FRICTION]      = "friction",
    [DIG_AXIS_ROLLING]       = "rolling friction",
    [DIG_AXIS_DENSITY_kgpm3] = "density, kg/m³",
};

// Enough digits to see, no more than are known.
static int decimals(const int axis)
{
    return axis == DIG_AXIS_DENSITY_kgpm3 ? 0 : 2;
}

void dig_report_text(const struct dig_report *const report, FILE *const to)
{
    assert(report != NULL && to != NULL);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        (void)fprintf(to, "\n  %s: %s\n", run->name, run->dig);
        (void)fprintf(to, "  %-18s %9s %11s   %s\n", "", "true", "identified", "90 % interval");
        for (int a = 0; a < DIG_AXES; a++) {
            const int d = decimals(a);
            // The multi-byte ³ takes two bytes for one column.
            (void)fprintf(to, "  %-*s ", a == DIG_AXIS_DENSITY_kgpm3 ? 19 : 18, axis_title[a]);
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
                            const struct dig_gravel *const gravel, const bool known)
{
    (void)fprintf(to, "\"%s\":", name);
    if (!known) {
        (void)fprintf(to, "null");
        return;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "%s\"%s\":%.6g", a == 0 ? "{" : ",", dig_axis_name((enum dig_axis)a),
                      gravel->value[a]);
    }
    (void)fprintf(to, "}");
}

void dig_report_json(const struct dig_report *const report, FILE *const to)
{
    assert(report != NULL && to != NULL);
    (void)fprintf(to,
                  "{\"metric\":\"relative Euclidean norm of the moment, moving average "
                  "±0.16 s\",\"lambda\":%.6g,\"runs\":[",
                  report->lambda);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        (void)fprintf(to, "%s{\"name\":\"%s\",", r == 0 ? "" : ",", run->name);
        put_json_gravel(to, "truth", &run->truth, run->truth_known);
        (void)fprintf(to, ",");
        put_json_gravel(to, "identified", &run->gravel, true);
        (void)fprintf(to, ",");
        put_json_gravel(to, "low", &run->low, true);
        (void)fprintf(to, ",");
        put_json_gravel(to, "high", &run->high, true);
        (void)fprintf(to, ",");
        put_json_gravel(to, "nearest", &run->nearest, true);
        (void)fprintf(to,
                      ",\"distance\":%.6g,\"predicted\":\"%s\",\"error\":%.6g,"
                      "\"noise_floor\":%.6g}",
                      run->distance, run->real.trajectory, run->error, run->noise_floor);
    }
    (void)fprintf(to, "]}\n");
}

static void put_text(FILE *const to, const char *const text)
{
    for (const char *c = text; *c != '\0'; c++) {
        switch (*c) {
        case '<': (void)fputs("&lt;", to); break;
        case '>': (void)fputs("&gt;", to); break;
        case '&': (void)fputs("&amp;", to); break;
        default: (void)fputc(*c, to); break;
        }
    }
}

static void put_table(FILE *const to, const struct dig_report_run *const run)
{
    (void)fputs("<table><tr><th></th><th>true</th><th>identified</th><th>90 % interval</th>"
                "<th>nearest entry</th></tr>\n",
                to);
    for (int a = 0; a < DIG_AXES; a++) {
        const int d = decimals(a);
        (void)fprintf(to, "<tr><th>%s</th>", axis_title[a]);
        if (run->truth_known) {
            (void)fprintf(to, "<td>%.*f</td>", d, run->truth.value[a]);
        } else {
            (void)fputs("<td>unknown</td>", to);
        }
        (void)fprintf(to, "<td><b>%.*f</b></td><td>%.*f – %.*f</td><td>%.*f</td></tr>\n", d,
                      run->gravel.value[a], d, run->low.value[a], d, run->high.value[a], d,
                      run->nearest.value[a]);
    }
    (void)fprintf(to,
                  "</table>\n<p class=result>Error of the predicted <i>%s</i> dig: <b>%.3f</b>; "
                  "noise floor (1 σ of what it would be if the model were complete): %.3f.</p>\n",
                  run->real.trajectory, run->error, run->noise_floor);
}

// Measured against the model along one dig; what lies outside the measured range is a gap.
static enum dig_status put_plot(FILE *const to, const struct dig_report_dig *const dig,
                                const char *const title, const char *const model,
                                struct dig_error *const error)
{
    double x[DIG_CURVE_POINTS];
    double low[DIG_CURVE_POINTS];
    double high[DIG_CURVE_POINTS];
    double measured[DIG_CURVE_POINTS];
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        x[k]        = 100.0 * k / (DIG_CURVE_POINTS - 1);
        low[k]      = dig->model_Nm[k] - dig->sigma_Nm[k];
        high[k]     = dig->model_Nm[k] + dig->sigma_Nm[k];
        measured[k] = x[k] >= 100.0 * dig->first && x[k] <= 100.0 * dig->last ? dig->measured_Nm[k]
                                                                              : (double)NAN;
    }
    const size_t          n    = DIG_CURVE_POINTS;
    const struct dig_plot plot = {
        .title   = title,
        .x_label = "path of the dig done, %",
        .y_label = "moment about the bucket pin, N·m at rig scale",
        .series  = 4,
        .s       = { { "1 σ of one dig", DIG_PLOT_BAND, "#1f5fa8", n, x, low, high },
                     { "recording fed to the rig", DIG_PLOT_DASHED, "#888888", n, x, dig->recording_Nm,
                       NULL },
                     { model, DIG_PLOT_LINE, "#1f5fa8", n, x, dig->model_Nm, NULL },
                     { "measured through pressures", DIG_PLOT_LINE, "#c0392b", n, x, measured, NULL } },
    };
    (void)fputs("<figure>\n", to);
    const enum dig_status status = dig_plot_svg(&plot, to, error);
    (void)fputs("</figure>\n", to);
    return status;
}

static const char style[] =
    "<style>body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:960px;margin:0 auto;"
    "padding:1em}h1{font-size:1.5em}h2{font-size:1.2em;margin-top:2em;border-top:1px solid #ddd;"
    "padding-top:1em}table{border-collapse:collapse;display:block;overflow-x:auto}"
    "td,th{padding:.25em .8em;text-align:right;border-bottom:1px solid #eee;font-weight:normal}"
    "th:first-child{text-align:left}tr:first-child th{color:#666}figure{margin:1em 0}"
    "svg{width:100%;height:auto;max-width:900px}.result{background:#f4f7fb;padding:.6em 1em}"
    "footer{color:#666;font-size:.9em;margin-top:2em}</style>\n";

static enum dig_status put_page(FILE *const to, const struct dig_report *const report,
                                struct dig_error *const error)
{
    (void)fputs("<!doctype html>\n<html lang=en><head><meta charset=utf-8>\n"
                "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n<title>",
                to);
    put_text(to, report->title);
    (void)fprintf(to, "</title>\n%s</head><body>\n<h1>", style);
    put_text(to, report->title);
    (void)fputs("</h1>\n<p>Table: ", to);
    put_text(to, report->table);
    (void)fprintf(to,
                  ". The machine is %.3g times the rig; everything below is at rig scale.</p>\n",
                  report->lambda);
    for (size_t r = 0; r < report->runs; r++) {
        const struct dig_report_run *const run = &report->run[r];
        (void)fputs("<h2>", to);
        put_text(to, run->name);
        (void)fputs("</h2>\n<p>", to);
        put_text(to, run->dig);
        (void)fputs("</p>\n", to);
        put_table(to, run);
        enum dig_status status =
            put_plot(to, &run->simple, "The simple dig that identified the gravel",
                     "identified gravel", error);
        if (status == DIG_OK) {
            status = put_plot(to, &run->real, "The real dig, predicted before it was dug",
                              "predicted", error);
        }
        if (status != DIG_OK) {
            return status;
        }
    }
    (void)fputs(
        "<footer>Error: relative Euclidean norm of the moment over rig time from contact to "
        "exit, moving average ±0.16 s. Predictions are advice, not a safety "
        "function.</footer>\n</body></html>\n",
        to);
    return DIG_OK;
}

enum dig_status dig_report_html(const struct dig_report *const report, const char *const path,
                                struct dig_error *const error)
{
    assert(report != NULL && path != NULL);
    const size_t size = strlen(path) + sizeof ".part";
    char *const  part = malloc(size);
    if (part == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    (void)snprintf(part, size, "%s.part", path);

    enum dig_status status = DIG_EIO;
    FILE *const     to     = fopen(part, "w");
    if (to == NULL) {
        (void)dig_error_set(error, DIG_EIO, "%s: %s", part, strerror(errno));
        goto done;
    }
    status             = put_page(to, report, error);
    const bool written = ferror(to) == 0;
    if ((fclose(to) != 0 || !written) && status == DIG_OK) {
        status = dig_error_set(error, DIG_EIO, "%s: %s", part, strerror(errno));
    }
    if (status == DIG_OK && rename(part, path) != 0) {
        status = dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
    }
    if (status != DIG_OK) {
        (void)remove(part);
    }
done:
    free(part);
    return status;
}
