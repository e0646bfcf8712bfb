#include "closed_loop/report/html.h"
#include "closed_loop/report/machine_check_report.h"
#include "closed_loop/report/plot.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SENTENCE = 4000 };

// Points of a curve lie 25 ms apart; every so many are enough to see.
enum { EVERY = 4 };

static void put_row(FILE *const to, const struct dig_check_subject *const subject,
                    const struct dig_check_item *const item)
{
    struct dig_check_words words;
    const bool             loud = item->verdict >= DIG_CHECK_DOUBTFUL;
    dig_check_say(subject, item, &words);
    (void)fprintf(to, "<tr><td>%s%s%s</td><td>", loud ? "<b>" : "",
                  dig_check_verdict_name(item->verdict), loud ? "</b>" : "");
    dig_html_text(to, words.question);
    (void)fputs("</td><td>", to);
    dig_html_text(to, words.answer);
    if (words.todo[0] != '\0') {
        (void)fputs("<br>→ ", to);
        dig_html_text(to, words.todo);
    }
    if (item->or_item >= 0) {
        struct dig_check_words other;
        dig_check_say(subject, &subject->check->item[item->or_item], &other);
        (void)fputs("<br>or ", to);
        dig_html_text(to, other.question);
        (void)fputs(": this recording cannot tell", to);
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

// One picture: what a drive pushed, and what it had to.
static enum dig_status put_plot(FILE *const to, const char *const title, const size_t n,
                                const double time_s[], const double drive_kN[],
                                const double load_kN[], struct dig_error *const error)
{
    const struct dig_plot plot = {
        .title   = title,
        .x_label = "time, s",
        .y_label = "push of the rod, kN",
        .width   = 480,
        .height  = 300,
        .series  = 2,
        .s       = { { "measured", DIG_PLOT_LINE, DIG_PLOT_MEASURED, n, time_s, drive_kN, NULL },
                     { "expected", DIG_PLOT_DASHED, DIG_PLOT_PREDICTED, n, time_s, load_kN, NULL } },
    };
    return dig_plot_figure(&plot, to, error);
}

// Every so many points of one joint, in kN.
static size_t thin(const struct dig_check_curves *const curves, const double N[],
                   const size_t joint, double kN[])
{
    size_t n = 0;
    for (size_t p = 0; p < curves->points; p += EVERY) {
        kN[n++] = 1e-3 * N[DIG_JOINTS * p + joint];
    }
    return n;
}

static bool any(const size_t n, const double value[])
{
    bool there = false;
    for (size_t i = 0; i < n; i++) {
        there = there || isfinite(value[i]);
    }
    return there;
}

// Before, and after if that is not the same.
static enum dig_status put_joint(FILE *const to, const struct dig_check_curves *const curves,
                                 const size_t joint, const bool mended, double room[],
                                 struct dig_error *const error)
{
    const size_t  most  = curves->points / EVERY + 1;
    double *const time  = room;
    double *const drive = room + most;
    double *const load  = room + 2 * most;
    size_t        n     = 0;
    for (size_t p = 0; p < curves->points; p += EVERY) {
        time[n++] = curves->time_s[p] - curves->time_s[0];
    }
    char            title[DIG_CHECK_TEXT_SIZE];
    enum dig_status status = DIG_OK;
    for (int after = 0; after <= (mended ? 1 : 0) && status == DIG_OK; after++) {
        (void)thin(curves, after > 0 ? curves->mended_drive_N : curves->drive_N, joint, drive);
        (void)thin(curves, after > 0 ? curves->mended_load_N : curves->load_N, joint, load);
        (void)snprintf(title, sizeof title, "%s%s", dig_joint_name((enum dig_joint)joint),
                       !mended     ? ""
                       : after > 0 ? ", with what is wrong taken off"
                                   : ", as it stands");
        if (any(n, drive)) {
            status = put_plot(to, title, n, time, drive, load, error);
        } else {
            (void)fprintf(to, "<p>%s: no instant can be balanced.</p>\n", title);
        }
    }
    return status;
}

static enum dig_status put_pictures(FILE *const to, const struct dig_check_subject *const subject,
                                    struct dig_error *const error)
{
    const struct dig_check_curves *const curves = &subject->check->curves;

    const bool      mended = subject->check->verdict >= DIG_CHECK_DOUBTFUL;
    double *const   room   = malloc(3 * (curves->points / EVERY + 1) * sizeof *room);
    enum dig_status status = DIG_OK;
    if (room == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%zu points", curves->points);
    }
    (void)fputs("<h2>Measured against expected</h2>\n<div class=grid>\n", to);
    for (size_t j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = put_joint(to, curves, j, mended, room, error);
    }
    (void)fputs(
        "</div>\n<p class=muted>Measured: by the two pressures of the whole drive. Expected: "
        "what weight and inertia of the file ask for at the angles recorded. In free air "
        "they are the same.</p>\n",
        to);
    free(room);
    return status;
}

enum dig_status dig_machine_check_html(const struct dig_check_subject *const subject,
                                       FILE *const to, struct dig_error *const error)
{
    assert(subject != NULL && to != NULL);
    char title[DIG_CHECK_TEXT_SIZE];
    char sentence[SENTENCE];
    (void)snprintf(title, sizeof title, "%s in free air", subject->machine->name);
    dig_check_sentence(subject, sizeof sentence, sentence);
    dig_html_begin(to, title);
    (void)fputs("<p class=result>", to);
    dig_html_text(to, sentence);
    (void)fputs("</p>\n<p>File ", to);
    dig_html_without_folders(to, subject->file);
    (void)fputs(", recording ", to);
    dig_html_without_folders(to, subject->recording);
    (void)fprintf(to, ", %.0f s.</p>\n", subject->check->duration_s);
    put_list(to, subject);
    const enum dig_status status = put_pictures(to, subject, error);
    dig_html_end(to, "Made by digloop check.");
    return status;
}
