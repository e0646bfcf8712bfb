// A trace in progress, which the sources of this room work on together. Internal to them.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H

#include "closed_loop/fit/steps.h"
#include "closed_loop/machine/machine_side.h"
#include "closed_loop/search/search.h"
#include "closed_loop/verdict/trace.h"

/// Probability that is left to an effect too small for the digs to confirm it.
#define DIG_TRACE_UNCONFIRMED 0.5

/// The machine's effects about their values, as far as free air leaves them open.
struct dig_trace_open {
    struct dig_machine_answer answer; // of no numbers: nothing is open
    struct dig_steps          steps;
};

struct dig_trace_work {
    // Of the caller: see dig_trace_run().
    const struct dig_curve_set      *set;
    const char                      *table;
    const struct dig_entry_set      *effects;
    const struct dig_trace_settings *settings;
    struct dig_machine_side         *machine;
    size_t                           digs;
    struct dig_measured             *measured;

    struct dig_response_surface *surface;
    struct dig_scatter          *scatter;
    struct dig_soil             *soil;
    struct dig_batch            *batch; // of the digs that may be fitted to
    struct dig_search           *search;
    struct dig_machine_finding  *air;
    struct dig_trace_open       *open;
    struct dig_fitted            before; // the plain hypothesis on the raw digs
    bool                         fit[DIG_MEASURED_MAX], holdout[DIG_MEASURED_MAX];
    double                       size[DIG_MODEL_EFFECTS_MAX]; // of air's effects, in the soil
    bool                         confirmed; // what was chosen may be applied: see below
};

/// Leaves in w->measured[].machine what these effects and what the file has wrong add to every dig;
/// fails as dig_machine_side_apply(), and leaves it as it was then.
DIG_MUST_CHECK enum dig_status dig_trace_apply(const struct dig_trace_work *w, size_t effects,
                                               const struct dig_model_effect effect[],
                                               const double                  file[DIG_FILE_ERRORS]);

/// The batch of the digs to fit to, its scatter that of the gravel it turns out to be (*plain).
DIG_MUST_CHECK enum dig_status dig_trace_batch(const struct dig_trace_work *w,
                                               struct dig_fitted *plain, struct dig_error *error);

/// The same of what the answer's values add, and in *steps what its steps from there add to the
/// mean dig of each of the batch's trajectories. DIG_ENOMATCH besides: it leaves nothing open. Some
/// milliseconds a parameter.
DIG_MUST_CHECK enum dig_status dig_machine_steps_make(const struct dig_trace_work     *w,
                                                      const struct dig_machine_answer *answer,
                                                      struct dig_steps                *steps);

/// Adds to the steps of an answer, as many as there is room for, what its others add to the mean
/// digs.
DIG_MUST_CHECK enum dig_status dig_machine_others_make(const struct dig_trace_work     *w,
                                                       const struct dig_machine_answer *answer,
                                                       struct dig_steps                *steps);

/// Writes values and 90 % intervals of the answer's parameters: at z, whose covariance is
/// [numbers * numbers] (NULL: the values alone).
void dig_machine_steps_values(const double z[], const double covariance[],
                              struct dig_machine_answer *answer);

/// Finds what is missing of the machine, by free air and the digs together, and takes it off the
/// digs: leaves measured[].machine and the batch with it, what is open of it as the batch's steps,
/// each effect's size in the digs in size[], and its probability weighed by that. w->before: the
/// plain fit of the batch of the raw digs.
DIG_MUST_CHECK enum dig_status dig_trace_machine(struct dig_trace_work *w, struct dig_error *error);

/// Leaves the machine's effects, their intervals (by the covariance of z of the batch's steps) and
/// measured[].machine as what the search chose has them. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_trace_settle_machine(struct dig_trace_work *w,
                                                        const double           covariance[]);

/// Leaves in measured[].lasting the noise along a bin that makes the digs likeliest, and the batch
/// whitened and *plain fitted with it; where that is none, both as they were. Some 300 ms.
DIG_MUST_CHECK enum dig_status dig_trace_tell_noise(const struct dig_trace_work *w,
                                                    struct dig_fitted           *plain);

/// Writes confirmed: whether what the search chose may change the prediction. It may where there is
/// free air, or no machine was recorded; else only where left-out digs are predicted better.
void dig_trace_confirm_without_air(struct dig_trace_work *w);

/// Gives up the names of what the soil shows while free air shows a machine that no effect
/// explains: it may be the machine's.
void dig_trace_doubt_soil(struct dig_trace_work *w);

/// Fills effects (the machine's first), where each is seen, the sets that cannot be told apart and
/// what is added to the prediction for an effect without a name: nothing where free air shows a
/// machine that no effect explains, because it may do otherwise to the next dig. Probabilities
/// without free air are even at most. trace->residual says where what has no name is seen.
void dig_trace_fill_verdict(const struct dig_trace_work *w, struct dig_trace *trace);

/// Curves before and after of all digs, zeroed; unlisted is added after.
void dig_trace_fill_curves(const struct dig_trace_work     *w,
                           const struct dig_model_unlisted *unlisted,
                           struct dig_trace_curves          curves[]);

/// Rms of the mean residual over what is expected, by part.
void dig_trace_fill_residuals(const struct dig_trace_work *w, double residual[DIG_TRACE_PHASES]);

/// The single effects, best first.
void dig_trace_fill_candidates(const struct dig_trace_work *w, struct dig_trace *trace);

/// Fills tells for every pair of every set of a trace, as many as there is room for: which dig or
/// which motion in free air would tell apart what a campaign's digs cannot, by how far the
/// candidates as they were fitted differ along each, in units of its noise. Effects of the soil,
/// and forces that are late, are compared along the table's trajectories, dug as they are, at twice
/// the pace, where one was dug before and by a tooth that has dug ten more; effects of the machine
/// (w->machine not NULL) in motions in free air (closed_loop/verdict/air_motion.h) and in the
/// digs that were recorded. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_tell_apart(const struct dig_trace_work *w,
                                              struct dig_trace            *trace);

/// For people, after all else: what to do next, and the ground that effects are explained in. Opens
/// the table. DIG_ENOMEM; fails as dig_table_scene().
DIG_MUST_CHECK enum dig_status dig_trace_explain(const struct dig_trace_work *w,
                                                 struct dig_trace *trace, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_WORK_H
