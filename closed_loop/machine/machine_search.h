// What the rooms of the search in free air work on together. Internal to machine_trace.c,
// machine_select.c and machine_answers.c.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H

#include "closed_loop/machine/machine_drift.h"
#include "closed_loop/machine/machine_fit.h"
#include "closed_loop/machine/machine_side.h"

/// Air that leaves more than this of a row's variance is not understood.
#define DIG_MACHINE_UNCLEAR_REST2 1.2

/// Two sets of effects whose log evidence differs by less cannot be told apart.
#define DIG_MACHINE_TIE 5.0

struct dig_machine_search {
    struct dig_air           air;
    struct dig_fit           fit;
    unsigned                 set;
    double                   noise2;     // variance that rows may have without being unclear
    double                   least;      // log evidence that an effect must bring
    double                   rest2_none; // without any effect, not linear
    double                   rest2; // with the set, not linear, rows as far as they are trusted
    double                   slow;  // of it, in the means of segments: chi-squared
    double                   none_of[DIG_MEASURED_MAX]; // rms of rest dig by dig without any effect
    struct dig_machine_drift drift;                     // that explains as much as the set, or none
};

/// Chooses the set that explains the air, from equations with nothing explained yet, and leaves out
/// what slewing pulls. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_machine_select(struct dig_machine_search *s);

/// Whether what is left of the rows is more than their noise, or the set is makeshift.
bool dig_machine_is_unclear(const struct dig_machine_search *s);

/// Every effect as it competed, by itself; best first. inclusion: by effect.
void dig_machine_write_candidates(struct dig_machine_search *s, const double inclusion[],
                                  struct dig_machine_finding *finding);

/// What each dig carried beyond what the digs have in common, by the air before it.
void dig_machine_write_own_payload(struct dig_machine_search *s, double own_kg[DIG_MEASURED_MAX]);

/// The effects of the set, most certain first.
void dig_machine_write_effects(struct dig_machine_search *s, const double inclusion[],
                               struct dig_machine_finding *finding);

/// Effects that would do in the place of one of the set.
void dig_machine_write_sets(const struct dig_machine_search *s,
                            struct dig_machine_finding      *finding);

/// No effect, with what the file may have wrong.
void dig_machine_write_none(struct dig_machine_search *s, struct dig_machine_finding *finding);

/// The set found, where it is of several, and every candidate alone, with what free air leaves
/// open.
void dig_machine_write_answers(struct dig_machine_search *s, struct dig_machine_finding *finding);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SEARCH_H
