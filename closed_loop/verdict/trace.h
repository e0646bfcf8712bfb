// Traces the residual of a campaign to missing effects: the result, and the call that makes it.
// Order and reasons: docs/numerics/closed_loop.md.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_H

#include "closed_loop/accuracy/judge.h"
#include "closed_loop/model/candidate.h"
#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/effect.h"
#include "core/entry_set.h"
#include "core/error.h"
#include "core/model.h"
#include "estimator/effects/effect.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_TRACE_TELLS_MAX 24

/// What would tell two of them apart, of all that was tried.
struct dig_tell_apart {
    enum dig_effect_id effect[2];
    bool               in_air;  // a motion in free air; else a dig
    char               how[96]; // which, for people; "": nothing tells them apart
    double             sigmas;  // of the sensors in one such motion, or of one dig's scatter, rms
    double             repeats; // so many of them make it three sigmas
};

/// "A and B differ most …" as a sentence without its stop, of at most size - 1 characters.
void dig_tell_apart_say(const struct dig_tell_apart *tell, size_t size, char text[]);

struct dig_residuals; // closed_loop/verdict/residuals.h

struct dig_trace {
    bool   significant;
    double p_complete;                 // chance of residuals this large if nothing were missing
    double false_alarm;                // level it was decided at
    double noise_floor;                // 1 sigma of error_after if the model were complete
    double residual[DIG_TRACE_PHASES]; // rms over the rms expected, by enum dig_part; NaN: no data

    bool no_air; // in the recordings of a machine: its effects cannot be told from the soil's

    // No effect of the soil: a gravel beyond the table's grid explains the digs, and is what gravel
    // is.
    bool beyond;

    // The prediction was changed by what was found. False: nothing was found, or the change is not
    // worth making; then after is before, and a model of it is the gravel refitted alone.
    bool applied;

    size_t                    effects; // of the verdict; 0: none
    struct dig_model_effect   effect[DIG_MODEL_EFFECTS_MAX];
    enum dig_part             seen_in[DIG_MODEL_EFFECTS_MAX];
    struct dig_model_unlisted unlisted; // when one of the effects is

    size_t                   candidates;
    struct dig_candidate     candidate[DIG_TRACE_CANDIDATES_MAX]; // best first
    size_t                   sets;
    struct dig_candidate_set set[DIG_TRACE_SETS_MAX]; // indistinguishable
    size_t                   tells;
    struct dig_tell_apart    tell[DIG_TRACE_TELLS_MAX]; // of each set every pair, in its order

    struct dig_gravel        gravel_before, low_before, high_before; // refitted without the effects
    struct dig_gravel        gravel, low, high;                      // and with them
    struct dig_effect_ground ground;        // what effects are explained in
    struct dig_error_range   before, after; // on the holdout digs
    size_t                   holdouts;

    struct dig_judged     judged;      // the digs, in the campaign's order; curves are malloc'ed
    struct dig_residuals *residuals;   // dig by dig; malloc'ed; NULL: not worked out
    char                  advice[512]; // which dig or table would tell more, for people
    char command[4096]; // shell lines that make that table: of who knows its files; "": none
};

void dig_trace_finish(struct dig_trace *trace);

struct dig_machine_side; // closed_loop/machine/machine_side.h

struct dig_trace_settings {
    double   false_alarm; // 0.01
    uint64_t seed;        // of the bootstrap: the same campaign gives the same answer
    size_t   bootstraps;  // 200; at least 4
};

struct dig_trace_settings dig_trace_settings_default(void);

/// Traces. table is the file set was loaded from: its runs tell how one dig scatters; NULL: the
/// curves' standard deviations do. effects may be NULL: only effects with a reduced form compete
/// then. machine may be NULL: the digs were measured by a force sensor. measured[].machine is
/// filled when an effect of the machine was found; of a dig at another depth that its path tells,
/// value becomes that of the plain dig; they and the set must outlive the trace. Seconds of one
/// core, 1.3 MB of stack. DIG_EINVAL: fewer
/// than two fit or identify digs, a trajectory that the set lacks; *error says so. DIG_ENOMEM.
/// Writes *trace on success only.
DIG_MUST_CHECK enum dig_status dig_trace_run(const struct dig_curve_set *set, const char *table,
                                             const struct dig_entry_set      *effects,
                                             const struct dig_trace_settings *settings,
                                             struct dig_machine_side *machine, size_t digs,
                                             struct dig_measured measured[],
                                             struct dig_trace *trace, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_H
