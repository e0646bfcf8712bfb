// A trace (closed_loop/verdict/trace.h) as people and programs read it: one JSON object, some lines
// for a terminal, one self-contained HTML page. Keys and units: docs/formats/trace.md.

#ifndef DIG_CLOSED_LOOP_REPORT_TRACE_REPORT_H
#define DIG_CLOSED_LOOP_REPORT_TRACE_REPORT_H

#include "closed_loop/verdict/trace.h"
#include "core/error.h"

#include <stdio.h>

/// What the page names and draws beside the trace itself.
struct dig_trace_subject {
    const char *campaign; // folder or title, for people
    const char *table;    // file
    double      lambda;   // size of what dug over the table's; 0: not known
};

/// One JSON object and a line feed. No effect is the verdict ["none"]. Numbers that are not known
/// (no holdout, a part that no dig shows) are null.
void dig_trace_json(const struct dig_trace *trace, FILE *to);

/// The verdict as one sentence of at most size - 1 characters, no line feed at its end.
void dig_trace_sentence(const struct dig_trace *trace, size_t size, char text[]);

/// What the numbers of one of its effects mean in the ground found, without a line feed; "": they
/// say it themselves.
void dig_trace_meaning(const struct dig_trace *trace, size_t effect, size_t size, char text[]);

/// "named, not applied: …" of a trace whose effects are not in its prediction, without a line feed;
/// "" of another.
void dig_trace_not_applied(const struct dig_trace *trace, size_t size, char text[]);

/// The verdict, the errors and what to do next, for a terminal.
void dig_trace_text(const struct dig_trace *trace, FILE *to);

/// The page: needs gnuplot, some tens of milliseconds a dig; DIG_EIO with *error without it.
DIG_MUST_CHECK enum dig_status dig_trace_html(const struct dig_trace         *trace,
                                              const struct dig_trace_subject *subject, FILE *to,
                                              struct dig_error *error);

#endif // DIG_CLOSED_LOOP_REPORT_TRACE_REPORT_H
