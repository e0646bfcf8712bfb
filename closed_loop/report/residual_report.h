// Residuals of digs (closed_loop/verdict/residuals.h) in a trace's reports: docs/formats/trace.md.

#ifndef DIG_CLOSED_LOOP_REPORT_RESIDUAL_REPORT_H
#define DIG_CLOSED_LOOP_REPORT_RESIDUAL_REPORT_H

#include "closed_loop/verdict/residuals.h"
#include "closed_loop/verdict/trace.h"
#include "core/error.h"

#include <stdio.h>

/// "identify", "fit", "holdout".
const char *dig_residuals_use_name(enum dig_use use);

/// "depth 1.15, attack -5 deg" behind a ", ", to a hundredth and a tenth of a degree; "" where that
/// is the plain one.
void dig_residuals_approach_text(const struct dig_approach *taken_off,
                                 char                       text[DIG_APPROACH_TEXT_SIZE]);

/// The members "residuals" and "residual_against" of the object, each with a comma and a line feed.
/// Not worked out: empty lists.
void dig_residuals_json(const struct dig_trace *trace, FILE *to);

/// A table dig by dig, one of the slopes, pictures over path and depth. Nothing where they were not
/// worked out. DIG_EIO as dig_plot_figure().
void dig_residuals_html(const struct dig_trace *trace, FILE *to, struct dig_conditions *c);

#endif // DIG_CLOSED_LOOP_REPORT_RESIDUAL_REPORT_H
