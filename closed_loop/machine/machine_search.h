// State of the machine side: its recordings, and the search in free air that machine_search.c,
// machine_select.c and machine_answers.c share.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H

#include "closed_loop/machine/machine_doubt.h"
#include "closed_loop/machine/machine_fit.h"
#include "closed_loop/machine/machine_noise.h"
#include "closed_loop/machine/machine_side.h"
#include "closed_loop/machine/machine_slew.h"
#include "closed_loop/machine_digs/machine_dig.h"

/// Air whose residual is more than this many times a row's variance is unexplained.
#define DIG_MACHINE_UNCLEAR_REST2 1.2

/// Two sets of effects whose log evidence differs by less cannot be told apart.
#define DIG_MACHINE_TIE 5.0

struct dig_machine_search {
    struct dig_air           air;
    struct dig_fit           fit;
    struct dig_slew_rows     all, kept; // rows of the air: all; and as the search had come to them
    struct dig_machine_noise noise;
    unsigned                 set;
    double                   noise2; // variance that rows may have without being unclear
    double                   level;  // false alarms
    double                   least;  // log evidence that an effect must bring
    // Left without any effect over what is expected, rms, of all air and dig by dig; NaN: no air.
    double                    residual, residual_of[DIG_MEASURED_MAX];
    double                    rest2;  // with the set, not linear, rows as far as they are trusted
    double                    slow;   // of it, in the means of segments: chi-squared
    struct dig_machine_drift  drift;  // that explains as much as the set, or none
    struct dig_machine_unlike unlike; // what of the file does, or none
};

struct dig_machine_side {
    struct dig_machine          machine;
    const struct dig_curve_set *set;
    size_t                      digs;
    struct dig_machine_dig      dig[DIG_MEASURED_MAX];
    bool                        used[DIG_MEASURED_MAX];           // to trace in
    double                      own_payload_kg[DIG_MEASURED_MAX]; // beyond the digs' common one
    bool                        begun;
    struct dig_machine_search   search; // in what was begun
};

/// Leaves out rows in which the machine slewed, and tells the noise of the others.
void dig_machine_begin(struct dig_machine_search *s);

/// Chooses the set that explains the air so begun, beginning without effects.
void dig_machine_select(struct dig_machine_search *s);

void dig_machine_search_finish(struct dig_machine_search *s);

/// Whether the rows' residual is more than their noise, or the set is makeshift: more than
/// DIG_MACHINE_AT_ONCE effects, or a negative payload.
bool dig_machine_is_unclear(const struct dig_machine_search *s);

/// An effect with its parameters as last solved.
struct dig_model_effect dig_machine_effect(const struct dig_machine_search *s,
                                           enum dig_effect_id id, double probability);

/// The answer without an effect, with the errors of the file; one that is larger than the file
/// allows has a prior of DIG_UNLIKE_WIDTH.
void dig_machine_write_none(struct dig_machine_search *s, struct dig_machine_finding *finding);

/// The set found, where it is of several effects, and every candidate alone, each with the
/// covariance that free air leaves of its numbers.
void dig_machine_write_answers(struct dig_machine_search *s, struct dig_machine_finding *finding);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H
