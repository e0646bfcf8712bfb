// The parts of a trace that are worked out once it is known what is missing: curves, residuals by
// part of the dig, the candidates as a report lists them, what to do next. Internal to trace.c.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_PARTS_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_PARTS_H

#include "closed_loop/search/search.h"
#include "closed_loop/verdict/trace.h"

/// What a trace is worked out from.
struct dig_tracing {
    const struct dig_curve_set        *set;
    const struct dig_response_surface *surface;
    const struct dig_scatter          *scatter;
    const struct dig_soil             *soil;
    const struct dig_trace_settings   *settings;
    size_t                             digs;
    const struct dig_measured         *measured;
    const struct dig_whitened_digs    *batch;  // of the digs that may be fitted to
    const struct dig_fitted           *before; // the plain hypothesis on the raw digs
    const struct dig_search           *search;
};

/// Numbers of a fitted effect as a model file and a report have them.
struct dig_model_effect dig_trace_effect(const struct dig_soil   *soil,
                                         const struct dig_fitted *fitted, size_t effect,
                                         double probability);

/// The same of a rock that lies elsewhere than the table's.
struct dig_model_effect dig_trace_rock(const struct dig_rock *rock, double probability);

/// The part of a dig in which a fitted effect is largest against the scatter.
enum dig_part dig_trace_seen_in(const struct dig_tracing *t, const struct dig_fitted *fitted,
                                size_t effect);

/// Curves before and after of all digs; unlisted (NULL: none) is added after.
void dig_trace_fill_curves(const struct dig_tracing *t, const struct dig_model_unlisted *unlisted,
                           struct dig_trace_curves curves[]);

/// Rms of the mean residual over what is expected, by part.
void dig_trace_fill_residuals(const struct dig_tracing *t, double residual[DIG_TRACE_PHASES]);

/// The single effects, best first.
void dig_trace_fill_candidates(const struct dig_tracing *t, struct dig_trace *trace);

/// What to do next, for people.
void dig_trace_advise(const struct dig_tracing *t, struct dig_trace *trace);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_PARTS_H
