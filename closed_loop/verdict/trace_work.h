// What trace.c and machine_choice.c work on together. Internal to them.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H

#include "closed_loop/machine/machine_side.h"
#include "closed_loop/search/search.h"
#include "closed_loop/verdict/machine_steps.h"
#include "closed_loop/verdict/trace.h"

/// Probability that is left to an effect too small for the digs to confirm it.
#define DIG_TRACE_UNCONFIRMED 0.5

/// The machine's effects about their values, as far as free air leaves them open.
struct dig_trace_open {
    struct dig_machine_answer answer; // of no numbers: nothing is open
    struct dig_steps          steps;
};

/// Everything that a trace needs memory for.
struct dig_trace_work {
    struct dig_response_surface *surface;
    struct dig_scatter          *scatter;
    struct dig_soil             *soil;
    struct dig_whitened_digs    *batch;
    struct dig_search           *search;
    struct dig_machine_finding  *air;
    struct dig_trace_open       *open;
    struct dig_fitted            before;
    bool                         fit[DIG_MEASURED_MAX], holdout[DIG_MEASURED_MAX];
    double                       size[DIG_MODEL_EFFECTS_MAX]; // of air's effects, in the soil
    bool                         confirmed; // what was chosen may be applied: see below
};

/// The batch of the digs to fit to, its scatter that of the gravel it turns out to be (*plain).
DIG_MUST_CHECK enum dig_status dig_trace_batch(const struct dig_trace_work *w, size_t digs,
                                               const struct dig_measured measured[],
                                               struct dig_fitted *plain, struct dig_error *error);

/// Finds what is missing of the machine, by free air and the digs together, and takes it off the
/// digs: leaves measured[].machine, the batch and *plain with it, what is open of it as the batch's
/// steps, each effect's size in the digs in size[], and its probability weighed by that. w->before:
/// the plain fit of the batch of the raw digs.
DIG_MUST_CHECK enum dig_status dig_trace_machine(struct dig_machine_side         *machine,
                                                 const struct dig_trace_settings *settings,
                                                 size_t digs, struct dig_measured measured[],
                                                 struct dig_trace_work *w, struct dig_fitted *plain,
                                                 struct dig_error *error);

/// Leaves the machine's effects, their intervals (by the covariance of z of the batch's steps) and
/// measured[].machine as what the search chose has them. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_trace_settle_machine(const struct dig_machine_side *machine,
                                                        const double                   covariance[],
                                                        struct dig_measured            measured[],
                                                        struct dig_trace_work         *w);

/// Leaves in confirmed whether what the search chose may change the prediction: always where free
/// air tells of the machine, or no machine was recorded; without, where digs left out are predicted
/// better. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_trace_confirm_without_air(struct dig_trace_work *w);

/// Says first that the recordings hold no free air, where they do not.
void dig_trace_advise_on_air(const struct dig_trace_work *w, struct dig_trace *trace);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H
