// The residual that no effect of the catalogue explains: what it depends on, and its correction.
//
// The residual of each channel is regressed on functions of the bucket's state
// (closed_loop/search/unlisted_regression.c). The regression on those of the trajectory decides;
// one that adds acceleration, pass and pitch, dig by dig, says what the residual depends on. The
// correction is the mean residual of each trajectory, shrunk towards zero by its noise.

#ifndef DIG_CLOSED_LOOP_SEARCH_UNLISTED_H
#define DIG_CLOSED_LOOP_SEARCH_UNLISTED_H

#include "closed_loop/fit/hypothesis.h"
#include "core/model.h"

struct dig_unlisted {
    double log_evidence;    // - BIC / 2 less that of the plain hypothesis; 0: nothing was chosen
    char   depends_on[128]; // for people; "": nothing that was tried
};

/// Regresses what a fitted plain hypothesis leaves.
struct dig_unlisted dig_unlisted_find(const struct dig_batch  *batch,
                                      const struct dig_fitted *plain);

/// What to add to the fitted curves, as shares of the rms of the fitted plain curve of each
/// channel. Trajectories without digs in the batch get none. *share is the caller's.
void dig_unlisted_correct(const struct dig_batch *batch, const struct dig_fitted *fitted,
                          struct dig_model_unlisted *share);

// Of the residual over each dig's amplitude on functions of its state and of how the machine stood,
// all without dimension: coefficients shared by all trajectories, one for each channel, functions
// chosen one after the other by BIC, the gravel refitted with them to first order.

/// Regressors of a residual. Those before DIG_BASIS_ACCELERATION follow from the trajectory and the
/// pace.
enum dig_basis {
    DIG_BASIS_AMPLITUDE, // 1
    DIG_BASIS_DEPTH,     // over the tooth's length
    DIG_BASIS_DEPTH_SQUARED,
    DIG_BASIS_FILL,         // area swept / tooth^2
    DIG_BASIS_PATH,         // progress
    DIG_BASIS_SPEED,        // over the mean of the table's dig
    DIG_BASIS_TURNING,      // share of the tooth's speed
    DIG_BASIS_LIFTING,      // 1 where the bucket goes up faster than along
    DIG_BASIS_ACCELERATION, // of the tooth, over mean speed^2 / path of the table's dig
    DIG_BASIS_PASS,         // how often the place was dug before
    DIG_BASIS_PITCH,        // of the machine, mean over the dig, rad
    DIG_BASES
};

/// "amplitude", "depth", …, for people.
const char *dig_basis_name(enum dig_basis basis);

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
struct dig_regressed dig_regress(const struct dig_batch *batch, const struct dig_fitted *plain,
                                 bool each);

#endif // DIG_CLOSED_LOOP_SEARCH_UNLISTED_H
