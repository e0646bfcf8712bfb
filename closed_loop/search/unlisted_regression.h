// The residual of a batch, over each dig's amplitude, regressed on functions of its state
// (closed_loop/search/unlisted_basis.h): coefficients shared by all trajectories, one for each
// channel, functions chosen one after the other by BIC, the gravel refitted with them to first
// order.

#ifndef DIG_CLOSED_LOOP_SEARCH_UNLISTED_REGRESSION_H
#define DIG_CLOSED_LOOP_SEARCH_UNLISTED_REGRESSION_H

#include "closed_loop/fit/hypothesis.h"
#include "closed_loop/search/unlisted_basis.h"

#define DIG_UNLISTED_MOST 3 // functions in one answer

struct dig_regressed {
    double         log_evidence; // - BIC / 2 less that of the gravel alone
    size_t         functions;
    enum dig_basis function[DIG_UNLISTED_MOST];
};

/// Regresses what a fitted plain hypothesis leaves of the trajectories' means on the functions that
/// the trajectory tells. each: and of how the digs of a trajectory differ from each other, on all
/// functions, at the paces they were dug with; on pitch where all digs have it. With more functions
/// to choose from each must bring more evidence, by the log of their number over that of those of
/// the trajectory: chance finds a function no more often.
struct dig_regressed dig_regress(const struct dig_whitened_digs *batch,
                                 const struct dig_fitted *plain, bool each);

#endif // DIG_CLOSED_LOOP_SEARCH_UNLISTED_REGRESSION_H
