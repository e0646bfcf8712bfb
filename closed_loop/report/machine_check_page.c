#include "closed_loop/report/html.h"
#include "closed_loop/report/machine_check_report.h"
#include "closed_loop/report/plot.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { SENTENCE = 4000 };

// Points of a curve lie 25 ms apart; every so many are enough to see.
enum { EVERY = 4 };

static void put_row(FILE *const to, const struct dig_check_subject *const subject,
                    const struct dig_check_item *const item)
{
    struct dig_check_words words;
    const bool             loud = item->verdict >= DIG_CHECK_DOUBTFUL;
    dig_check_say(subject, item, &words);
    dig_html_put(to, loud ? "<tr><td><b>%s</b></td>" : "<tr><td>%s</td>",
                 dig_check_verdict_name(item->verdict));
    dig_html_put(to, "<td>%s</td><td>%s", words.question, words.answer);
    if (words.todo[0] != '\0') {
        dig_html_put(to, "<br>→ %s", words.todo);
    }
    if (item->or_item >= 0) {
        struct dig_check_words other;
        dig_check_say(subject, &subject->check->item[item->or_item], &other);
        dig_html_put(to, "<br>or %s: this recording cannot tell", other.question);
    }
    (void)fputs("</td></tr>\n", to);
}

static void put_list(FILE *const to, const struct dig_check_subject *const subject)
{
    (void)fputs("<h2>Checklist</h2>\n<table class=words><tr><th>verdict</th><th>question</th>"
                "<th>answer → what to do</th></tr>\n",
                to);
    // What is to be mended stands first.
    for (int verdict = DIG_CHECK_WRONG; verdict >= DIG_CHECK_OK; verdict--) {
        for (size_t i = 0; i < subject->check->items; i++) {
            if ((int)subject->check->item[i].verdict == verdict) {
                put_row(to, subject, &subject->check->item[i]);
            }
        }
    }
    (void)fputs(
        "</table>\n<p class=muted>After +-: 1 σ of the recording. Allowed: 1 σ of what file "
        "or sensor may be off without being wrong. By so many sigma: root of twice the "
        "logarithm of how much less likely the other answer makes this recording.</p>\n",
        to);
}

// What the drive of a joint pushed, and what it had to. room: of three curves.
static void put_joint(FILE *const to, const struct dig_check_curves *const curves,
                      const size_t joint, const double drive_N[], const double load_N[],
                      const char *const how, double room[], struct dig_conditions *const c)
{
    const size_t  most     = curves->points / EVERY + 1;
    double *const time_s   = room;
    double *const drive_kN = room + most;
    double *const load_kN  = room + 2 * most;
    size_t        n        = 0;
    bool          any      = false;
    for (size_t p = 0; p < curves->points; p += EVERY, n++) {
        time_s[n]   = curves->time_s[p] - curves->time_s[0];
        drive_kN[n] = 1e-3 * drive_N[DIG_JOINTS * p + joint];
        load_kN[n]  = 1e-3 * load_N[DIG_JOINTS * p + joint];
        any         = any || isfinite(drive_kN[n]);
    }
    char title[DIG_CHECK_TEXT_SIZE];
    (void)snprintf(title, sizeof title, "%s%s", dig_joint_name((enum dig_joint)joint), how);
    if (!any) {
        (void)fprintf(to, "<p>%s: no instant can be balanced.</p>\n", title);
        return;
    }
    const struct dig_plot plot = {
        .title   = title,
        .x_label = "time, s",
        .y_label = "push of the rod, kN",
        .height  = 300,
        .series  = 2,
        .s       = { { "measured", DIG_PLOT_LINE, DIG_PLOT_MEASURED, n, time_s, drive_kN, NULL },
                     { "expected", DIG_PLOT_DASHED, DIG_PLOT_PREDICTED, n, time_s, load_kN, NULL } },
    };
    dig_plot_figure(&plot, to, c);
}

// Of each joint before, and after if that is not the same.
static void put_pictures(FILE *const to, const struct dig_check_subject *const subject,
                         struct dig_conditions *const c)
{
    const struct dig_check_curves *const of = &subject->check->curves;

    const bool    mended = subject->check->verdict >= DIG_CHECK_DOUBTFUL;
    double *const room   = malloc(3 * (of->points / EVERY + 1) * sizeof *room);
    if (room == NULL) {
        c->status = dig_error_set(c->error, DIG_ENOMEM, "%zu points", of->points);
        return;
    }
    (void)fputs("<h2>Measured against expected</h2>\n<div class=grid>\n", to);
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        put_joint(to, of, j, of->drive_N, of->load_N, mended ? ", as it stands" : "", room, c);
        if (mended) {
            put_joint(to, of, j, of->mended_drive_N, of->mended_load_N,
                      ", with what is wrong taken off", room, c);
        }
    }
    (void)fputs(
        "</div>\n<p class=muted>Measured: by the two pressures of the whole drive. Expected: "
        "what weight and inertia of the file ask for at the angles recorded. In free air "
        "they are the same.</p>\n",
        to);
    free(room);
}

enum dig_status dig_machine_check_html(const struct dig_check_subject *const subject,
                                       FILE *const to, struct dig_error *const error)
{
    assert(subject != NULL && to != NULL);
    char                  title[DIG_CHECK_TEXT_SIZE];
    char                  sentence[SENTENCE];
    struct dig_conditions c = { .error = error };
    (void)snprintf(title, sizeof title, "%s in free air", subject->machine->name);
    dig_check_sentence(subject, sizeof sentence, sentence);
    dig_html_begin(to, title);
    dig_html_put(to, "<p class=result>%s</p>\n<p>File ", sentence);
    dig_html_without_folders(to, subject->file);
    (void)fputs(", recording ", to);
    dig_html_without_folders(to, subject->recording);
    (void)fprintf(to, ", %.0f s.</p>\n", subject->check->duration_s);
    put_list(to, subject);
    put_pictures(to, subject, &c);
    dig_html_end(to, "Made by digloop check.");
    return c.status;
}
