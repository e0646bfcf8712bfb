#include "tools/digreport/shift_page_parts.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/report.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>

static void put_effects(const struct dig_model *const model, FILE *const to)
{
    (void)fputs("<h2>Effects in the model</h2>\n", to);
    if (model == NULL) {
        (void)fputs("<p>No model file was given (<code>--model</code>).</p>\n", to);
        return;
    }
    if (model->effects == 0 && !model->unlisted.any) {
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
            dig_html_put(to, "<tr><th>%s</th><td>%s</td><td>%.4g</td><td>%.4g to %.4g</td></tr>\n",
                         dig_effect_name(effect->effect), q->name, q->value, q->low, q->high);
        }
    }
    if (model->unlisted.any) {
        dig_html_put(to, "<tr><th>unlisted</th><td>depends on %s</td><td></td><td></td></tr>\n",
                     model->unlisted.depends_on);
    }
    (void)fputs("</table>\n", to);
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
        digreport_page_time_cell(to, e->from_us);
        digreport_page_time_cell(to, e->to_us);
        (void)fputs("<td>", to);
        if (e->text != NULL) {
            dig_html_text(to, e->text->what);
        } else {
            dig_html_without_folders(to, e->said);
        }
        (void)fputs("</td><td>", to);
        if (e->count > 0) {
            (void)fprintf(to, "%" PRId64, e->count);
        }
        dig_html_put(to, "</td><td>%s</td></tr>\n", e->text != NULL ? e->text->todo : "");
    }
    (void)fputs("</table>\n", to);
}

static void put_subject(const struct digreport_page *const page, FILE *const to)
{
    const struct digreport_shift *const shift = page->shift;
    char                                from[DIGREPORT_TIME];
    char                                until[DIGREPORT_TIME];
    digreport_time(shift->first_us, from);
    digreport_time(shift->last_us, until);
    (void)fputs("<p class=result>", to);
    digreport_shift_sentence(shift, to);
    (void)fprintf(to, "</p>\n<p>%s to %s, from %zu log%s. ", from, until, page->subject->logs,
                  page->subject->logs == 1 ? "" : "s");
    if (shift->lambda > 0.0) {
        dig_html_put(to, "Machine %s, table of scene %s; the machine is %.3g times the rig. ",
                     page->subject->machine, page->subject->scene, shift->lambda);
    } else {
        (void)fputs("All at machine scale; <code>--table</code> and <code>--machine</code> add the "
                    "rig's. ",
                    to);
    }
    (void)fprintf(to,
                  "Digs by the daemon's counts: %" PRId64 " dug to their end, %" PRId64
                  " aborted, %" PRId64 " unknown; of others it is not told.</p>\n",
                  shift->ended[DIGREPORT_WHOLE], shift->ended[DIGREPORT_ABORTED],
                  shift->ended[DIGREPORT_UNKNOWN]);
    if (shift->left_out > 0) {
        (void)fprintf(to,
                      "<p>%" PRId64 " digs, matches or troubles are left out: only the first ten "
                      "thousand of each are shown.</p>\n",
                      shift->left_out);
    }
}

enum dig_status digreport_shift_html(const struct digreport_shift *const         shift,
                                     const struct digreport_shift_subject *const subject,
                                     FILE *const to, struct dig_error *const error)
{
    assert(shift != NULL && subject != NULL && to != NULL);
    const double          minutes = (double)(shift->last_us - shift->first_us) / 6e7;
    struct digreport_page page    = { shift, subject, minutes > 180.0 ? 3.6e9 : 6e7, "" };
    char                  clock[DIGREPORT_TIME];
    digreport_time(shift->first_us, clock);
    (void)snprintf(page.x_label, sizeof page.x_label, "time since %s, %s", clock,
                   minutes > 180.0 ? "h" : "min");

    struct dig_conditions c = { .error = error };
    dig_html_begin(to, subject->title);
    put_subject(&page, to);
    digreport_page_digs(&page, to, &c);
    digreport_page_gravels(&page, to, &c);
    put_effects(subject->model, to);
    put_events(shift, to);
    dig_html_end(
        to, DIG_REPORT_ERROR_NOTE
        " Of the first prediction made in the dig, from there on; of a machine of unknown size the "
        "average is ±0.5 s. Predicted: expected of one dig, with the interval that holds 90 % of "
        "digs. Energy: work of the bucket on the soil, where forces are measured. Ended: whole, "
        "dug to the end of its trajectory; aborted, left it before; unknown, along none, too short "
        "or with samples missing.");
    return c.status;
}
