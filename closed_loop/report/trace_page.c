#include "closed_loop/report/html.h"
#include "closed_loop/report/plot.h"
#include "closed_loop/report/report.h"
#include "closed_loop/report/residual_report.h"
#include "closed_loop/report/trace_report.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define CANDIDATES_SHOWN 12

// Of another size than the rig, and that is known.
static bool is_scaled(const double lambda)
{
    return lambda > 0.0 && fabs(lambda - 1.0) > 1e-6;
}

static void put_bar(FILE *const to, const double px)
{
    (void)fprintf(to,
                  "<td style=\"text-align:left\"><span class=bar style=\"width:%.0fpx\"></span>"
                  "</td></tr>\n",
                  px);
}

static void put_error_row(FILE *const to, const char *const title, const double most,
                          const struct dig_error_range *const range)
{
    (void)fprintf(to, "<tr><th>%s</th><td><b>%.3f</b></td>", title, range->value);
    if (isfinite(range->low) && range->high > range->low) {
        (void)fprintf(to, "<td>%.3f to %.3f</td>", range->low, range->high);
    } else {
        (void)fputs("<td></td>", to);
    }
    put_bar(to, 150.0 * range->value / most);
}

static void put_errors(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs("<h2>How wrong the prediction was, before and after</h2>\n", to);
    if (!isfinite(trace->before.value) || !isfinite(trace->after.value)) {
        (void)fputs("<p>No dig was held out, so nothing says how wrong the next dig will be. Mark "
                    "one with <code>role: holdout</code>.</p>\n",
                    to);
        return;
    }
    const double floor = trace->noise_floor;
    const double most =
        fmax(fmax(trace->before.value, trace->after.value), isfinite(floor) ? floor : 1e-9);
    (void)fputs("<table><tr><th></th><th>error</th><th>90 % interval</th><th></th></tr>\n", to);
    put_error_row(to, "before", most, &trace->before);
    put_error_row(to, "after", most, &trace->after);
    if (isfinite(floor)) {
        const struct dig_error_range range = { .value = floor };
        put_error_row(to, "noise floor", most, &range);
    }
    (void)fprintf(to,
                  "</table>\n<p class=muted>On %zu dig%s that took no part in the fit%s. The "
                  "floor is 1 σ of what the error would be if "
                  "the model were complete. Both use the gravel refitted on the same digs.</p>\n",
                  trace->holdouts, trace->holdouts == 1 ? "" : "s",
                  trace->holdouts == 1 ? " (one dig: no interval)"
                                       : ", with 90 % intervals over recordings");
}

static void put_found(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs("<h2>What was found</h2>\n<table><tr><th></th><th>value</th><th>90 % "
                "interval</th><th>without it</th></tr>\n",
                to);
    for (size_t e = 0; e < trace->effects; e++) {
        const struct dig_model_effect *const effect = &trace->effect[e];
        for (size_t p = 0; p < effect->parameters; p++) {
            const struct dig_model_parameter *const q = &effect->parameter[p];
            dig_html_put(to,
                         "<tr><th>%s: %s</th><td><b>%.4g</b></td><td>%.4g to %.4g</td><td></td>"
                         "</tr>\n",
                         dig_effect_name(effect->effect), q->name, q->value, q->low, q->high);
        }
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const int digits = dig_report_axis_digits(a);
        (void)fprintf(to,
                      "<tr><th>gravel: %s</th><td><b>%.*f</b></td><td>%.*f to %.*f</td>"
                      "<td>%.*f</td></tr>\n",
                      dig_report_axis(a), digits, trace->gravel.value[a], digits,
                      trace->low.value[a], digits, trace->high.value[a], digits,
                      trace->gravel_before.value[a]);
    }
    (void)fputs("</table>\n", to);
    for (size_t e = 0; e < trace->effects; e++) {
        char text[256];
        dig_trace_meaning(trace, e, sizeof text, text);
        if (text[0] != '\0') {
            dig_html_put(to, "<p>%s.</p>\n", text);
        }
    }
}

static void put_sets(FILE *const to, const struct dig_trace *const trace)
{
    for (size_t s = 0; s < trace->sets; s++) {
        (void)fputs("<p>These digs cannot tell apart: <b>", to);
        for (size_t e = 0; e < trace->set[s].effects; e++) {
            (void)fprintf(to, "%s%s", e == 0 ? "" : ", ", dig_effect_name(trace->set[s].effect[e]));
        }
        (void)fputs("</b>.</p>\n", to);
    }
}

static void put_residuals(FILE *const to, const struct dig_trace *const trace)
{
    static const char *const title[DIG_TRACE_PHASES] = {
        [DIG_PART_AIR]    = "in the air, before",
        [DIG_PART_SOIL]   = "in the soil",
        [DIG_PART_LIFTED] = "lifted out",
    };
    char   chance[32];
    double most = 2.0;
    for (int p = 0; p < DIG_TRACE_PHASES; p++) {
        most = isfinite(trace->residual[p]) ? fmax(most, trace->residual[p]) : most;
    }
    (void)fputs(
        "<h2>Where the residual shows</h2>\n<table><tr><th></th><th>rms</th><th></th></tr>\n", to);
    for (int p = 0; p < DIG_TRACE_PHASES; p++) {
        dig_html_put(to, "<tr><th>%s</th><td>%.2f</td>", title[p], trace->residual[p]);
        put_bar(to, isfinite(trace->residual[p]) ? 150.0 * trace->residual[p] / most : 0.0);
    }
    (void)fprintf(
        to,
        "</table>\n<p class=muted>Measured minus predicted without any effect, rms over "
        "the rms expected: 1 is what noise makes. Effects of the machine show in the air, "
        "those of the soil do not. The chance of residuals this large if nothing were "
        "missing is %s; it was decided at %.2g.</p>\n",
        dig_report_chance(trace->p_complete, sizeof chance, chance), trace->false_alarm);
}

static void put_candidates(FILE *const to, const struct dig_trace *const trace)
{
    if (trace->candidates == 0) {
        return;
    }
    (void)fputs("<h2>What competed</h2>\n<table><tr><th>effect</th><th>log evidence</th>"
                "<th>fits</th><th>chosen</th><th>error</th><th>parameters</th></tr>\n",
                to);
    for (size_t i = 0; i < trace->candidates && i < CANDIDATES_SHOWN; i++) {
        const struct dig_candidate *const c = &trace->candidate[i];
        dig_html_put(to,
                     "<tr><th>%s</th><td>%.1f</td><td>%.3f</td><td>%.2f</td><td>%.3f</td>"
                     "<td style=\"text-align:left;min-width:15em\">",
                     dig_effect_name(c->as.effect), c->log_evidence, c->p_fit, c->as.probability,
                     c->error);
        for (size_t p = 0; p < c->as.parameters; p++) {
            dig_html_put(to, p == 0 ? "%s %.3g" : ", %s %.3g", c->as.parameter[p].name,
                         c->as.parameter[p].value);
        }
        (void)fputs("</td></tr>\n", to);
    }
    (void)fputs(
        "</table>\n<p class=muted>Each refitted jointly with the gravel. Log evidence: −BIC / "
        "2 less that of no effect. Fits: the chance of a residual this large if it were the "
        "whole truth. Chosen: in this share of resampled sets of digs. Error: of the "
        "digs fitted.</p>\n",
        to);
}

static void put_channel(FILE *const to, const struct dig_trace_curves *const curves,
                        const struct dig_measured *const dig, const char *const trajectory,
                        const double lambda, const size_t channel, struct dig_conditions *const c)
{
    static const char *const label[2][DIG_FORCE_CHANNELS] = {
        { "moment, N·m at rig scale", "Fx, N at rig scale", "Fz, N at rig scale" },
        { "moment, kN·m", "Fx, kN", "Fz, kN" },
    };
    static const char *const right[DIG_FORCE_CHANNELS] = { "at rig scale, N·m", "at rig scale, N",
                                                           "at rig scale, N" };
    static const char *const of[DIG_FORCE_CHANNELS]    = { "", ", Fx", ", Fz" };

    struct dig_plot_dig p;
    double              before[DIG_CURVE_POINTS];
    char                title[224];
    char                way[DIG_APPROACH_TEXT_SIZE];
    const size_t        n      = DIG_CURVE_POINTS;
    const bool          scaled = is_scaled(lambda);
    const double        power  = channel == DIG_CHANNEL_MY_Nm ? 4.0 : 3.0;
    const double        unit   = scaled ? 1e-3 * pow(lambda, power) : 1.0;
    dig_plot_of_dig(unit, dig->value[channel], dig->first, dig->last, curves->after.value[channel],
                    curves->after.sd[channel], &p);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        before[k] = unit * curves->before.value[channel][k];
    }
    dig_residuals_approach_text(&dig->taken_off, way);
    (void)snprintf(title, sizeof title, "%s: %s, %s%s%s%s%s", dig->name, trajectory,
                   dig_residuals_use_name(dig->use), dig->pass > 1 ? ", dug before" : "", way,
                   way[0] != '\0' ? " taken off" : "", of[channel]);
    // Where nothing was changed before is after, and is drawn once.
    const bool same =
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c)
        memcmp(curves->before.value[channel], curves->after.value[channel],
               sizeof curves->after.value[channel]) == 0;
    struct dig_plot plot = {
        .title        = title,
        .x_label      = "path of the dig done, %",
        .y_label      = label[scaled ? 1 : 0][channel],
        .right_label  = scaled ? right[channel] : NULL,
        .right_factor = 1.0 / unit,
        .height       = 370,
        .series       = 3,
        .s = { { "90 % of digs", DIG_PLOT_BAND, DIG_PLOT_PREDICTED, n, p.x, p.low, p.high },
               { same ? "before and after" : "after", DIG_PLOT_DASHED, DIG_PLOT_PREDICTED, n, p.x,
                 p.model, NULL },
               { "measured", DIG_PLOT_LINE, DIG_PLOT_MEASURED, n, p.x, p.measured, NULL } },
    };
    if (!same) {
        plot.s[plot.series++] =
            (struct dig_plot_series){ "before", DIG_PLOT_DOTTED, DIG_PLOT_BEFORE, n, p.x, before,
                                      NULL };
    }
    dig_plot_figure(&plot, to, c);
}

static void put_digs(FILE *const to, const struct dig_trace *const trace, const double lambda,
                     struct dig_conditions *const c)
{
    const struct dig_judged *const judged = &trace->judged;
    (void)fputs("<h2>Dig by dig</h2>\n<div class=grid>\n", to);
    for (size_t d = 0; d < judged->digs; d++) {
        const struct dig_measured *const dig = &judged->measured[d];
        for (size_t channel = 0; channel < DIG_FORCE_CHANNELS; channel++) {
            if (dig->measured[channel]) {
                put_channel(to, &judged->curves[d], dig,
                            judged->set->trajectory[dig->trajectory].name, lambda, channel, c);
            }
        }
    }
    (void)fputs("</div>\n<p class=muted>Before: the table with the gravel alone refitted. After: "
                "with what was found, and the band that holds 90 % of digs. Forces are drawn where "
                "every sensor for them was there.</p>\n",
                to);
}

static void put_tells(FILE *const to, const struct dig_trace *const trace)
{
    if (trace->tells == 0) {
        return;
    }
    (void)fputs("<table><tr><th>to tell apart</th><th style=\"text-align:left\">do</th>"
                "<th>sigmas</th><th>times</th></tr>\n",
                to);
    for (size_t i = 0; i < trace->tells; i++) {
        const struct dig_tell_apart *const tell = &trace->tell[i];
        const bool                         told = tell->how[0] != '\0';
        dig_html_put(to,
                     "<tr><th>%s<br>%s</th><td style=\"text-align:left;min-width:7em\">%s</td>"
                     "<td>%.2f</td><td>%.0f</td></tr>\n",
                     dig_effect_name(tell->effect[0]), dig_effect_name(tell->effect[1]),
                     told ? tell->how : "nothing that was tried", told ? tell->sigmas : (double)NAN,
                     told ? tell->repeats : (double)NAN);
    }
    (void)fputs("</table>\n<p class=muted>What these digs cannot tell apart, as fitted: where they "
                "differ most, in sigmas of the sensors for a motion in free air, in scatters of "
                "one dig (rms) for a dig. Times: how many make three.</p>\n",
                to);
}

static void put_next(FILE *const to, const struct dig_trace *const trace)
{
    if (trace->advice[0] == '\0' && trace->command[0] == '\0' && trace->tells == 0) {
        return;
    }
    (void)fputs("<h2>What to do next</h2>\n", to);
    if (trace->advice[0] != '\0') {
        dig_html_put(to, "<p>%s</p>\n", trace->advice);
    }
    put_tells(to, trace);
    if (trace->command[0] != '\0') {
        (void)fputs("<p>A table with it in its beds:</p>\n<pre>", to);
        dig_html_without_folders(to, trace->command);
        (void)fputs("</pre>\n", to);
    }
}

enum dig_status dig_trace_html(const struct dig_trace *const         trace,
                               const struct dig_trace_subject *const subject, FILE *const to,
                               struct dig_error *const error)
{
    assert(trace != NULL && subject != NULL && to != NULL);
    assert(subject->campaign != NULL && subject->table != NULL);
    struct dig_conditions c = { .error = error };
    char                  sentence[1024];
    char                  title[256];
    const char *const     campaign = subject->campaign;
    size_t                ends     = strlen(campaign);
    while (ends > 1 && campaign[ends - 1] == '/') {
        ends--;
    }
    size_t begins = ends;
    while (begins > 0 && campaign[begins - 1] != '/') {
        begins--;
    }
    dig_trace_sentence(trace, sizeof sentence, sentence);
    (void)snprintf(title, sizeof title, "What the model lacks: %.*s", (int)(ends - begins),
                   campaign + begins);
    dig_html_begin(to, title);
    dig_html_put(to, "<p class=result>%s</p>\n<p>%zu digs against ", sentence, trace->judged.digs);
    dig_html_without_folders(to, subject->table);
    if (is_scaled(subject->lambda)) {
        (void)fprintf(to,
                      "; what dug is %.3g times the rig, which makes a moment %.0f times as large",
                      subject->lambda, pow(subject->lambda, 4.0));
    }
    (void)fputs(".</p>\n", to);
    dig_trace_not_applied(trace, sizeof sentence, sentence);
    if (sentence[0] != '\0') {
        dig_html_put(to, "<p>%s.</p>\n", sentence);
    }
    put_sets(to, trace);
    put_errors(to, trace);
    put_found(to, trace);
    put_digs(to, trace, subject->lambda, &c);
    put_residuals(to, trace);
    dig_residuals_html(trace, to, &c);
    put_candidates(to, trace);
    put_next(to, trace);
    dig_html_end(to, DIG_REPORT_ERROR_NOTE);
    return c.status;
}
