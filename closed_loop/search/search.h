// Searches for what is missing: compares all hypotheses on one batch.
//
// Whether anything is missing: the plain hypothesis' misfit, and the most that any one effect
// reduces it, each against its distribution by simulation (closed_loop/search/null_simulation.h);
// the smaller chance of the two counts, for two tries. Which effect: - BIC / 2 over the plain
// hypothesis of each effect, of pairs, of a gravel outside the grid, and of a residual without a
// name.

#ifndef DIG_CLOSED_LOOP_SEARCH_SEARCH_H
#define DIG_CLOSED_LOOP_SEARCH_SEARCH_H

#include "closed_loop/model/candidate.h"
#include "closed_loop/search/null_simulation.h"
#include "closed_loop/search/rock.h"
#include "closed_loop/search/unlisted.h"

/// A single effect, as it competed.
struct dig_rival {
    struct dig_fitted fitted;
    double            log_evidence, p_fit, inclusion; // of struct dig_candidate
};

struct dig_search {
    bool              significant;
    double            p_complete;
    double            spread;   // of the digs about their means over what the table leads to expect
    bool              outside;  // explained by a gravel beyond the grid
    bool              unlisted; // by nothing that has a name
    struct dig_fitted plain, beyond, chosen; // beyond: gravel outside the grid; chosen: in the end
    struct dig_fitted nameless;              // a gravel and something that has no name
    double            confirmed;             // dig_cross_validation_gain() of chosen, 0: not asked
    struct dig_unlisted without_name;
    double              unnamed; // share that its probability keeps: 1 until it is weighed
    bool                is_rock; // unlisted, but for a rock where the table has none
    struct dig_rock     rock;

    size_t           rivals; // best first
    struct dig_rival rival[DIG_RIVALS_MAX];
    double           probability[DIG_HYPOTHESIS_EFFECTS]; // of chosen's effects

    // What the digs cannot tell from the one effect of chosen, which comes first; empty: nothing.
    struct dig_candidate_set alike;
};

/// Lists the single effects that the digs can tell; how many.
size_t dig_search_rivals(const struct dig_batch *batch,
                         struct dig_hypothesis   single[DIG_RIVALS_MAX]);

/// Searches. The batch's amplitudes grow by spread when the campaign's digs scatter more than the
/// table's. Some seconds.
void dig_search_run(struct dig_batch *batch, double false_alarm, size_t draws, uint64_t seed,
                    struct dig_search *search);

#endif // DIG_CLOSED_LOOP_SEARCH_SEARCH_H
