// The check of a machine file in free air (closed_loop/check/machine_check.h) as people and
// programs read it: a checklist for a terminal, one JSON object, one self-contained HTML page. Keys
// and units: docs/formats/trace.md.

#ifndef DIG_CLOSED_LOOP_REPORT_MACHINE_CHECK_REPORT_H
#define DIG_CLOSED_LOOP_REPORT_MACHINE_CHECK_REPORT_H

#include "closed_loop/check/machine_check.h"
#include "core/error.h"

#include <stdio.h>

/// What is reported.
struct dig_check_subject {
    const struct dig_machine           *machine;
    const char                         *file, *recording; // for people; a page leaves folders out
    const struct dig_machine_air_check *check;
};

#define DIG_CHECK_TEXT_SIZE 200

/// One line in words: the question, its answer with figures, and what to do, "" where nothing is.
struct dig_check_words {
    char question[DIG_CHECK_TEXT_SIZE], answer[DIG_CHECK_TEXT_SIZE], todo[DIG_CHECK_TEXT_SIZE];
};

void dig_check_say(const struct dig_check_subject *subject, const struct dig_check_item *item,
                   struct dig_check_words *words);

/// "ok", "not told", "doubtful", "wrong".
const char *dig_check_verdict_name(enum dig_check_verdict verdict);

/// "times", "missing", …, for programs.
const char *dig_check_question_name(enum dig_check_question question);

/// The joint or the signal that a line is of, or "all".
const char *dig_check_of_name(const struct dig_check_item *item);

/// The whole in one sentence of at most size - 1 characters.
void dig_check_sentence(const struct dig_check_subject *subject, size_t size, char text[]);

/// A line a question, in 80 columns.
void dig_machine_check_text(const struct dig_check_subject *subject, FILE *to);

/// One JSON object and a line feed; what is not known is null.
void dig_machine_check_json(const struct dig_check_subject *subject, FILE *to);

/// The page: needs gnuplot; DIG_EIO with *error without it.
DIG_MUST_CHECK enum dig_status dig_machine_check_html(const struct dig_check_subject *subject,
                                                      FILE *to, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_REPORT_MACHINE_CHECK_REPORT_H
