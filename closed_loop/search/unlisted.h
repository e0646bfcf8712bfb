// The residual that no effect of the catalogue explains: what it depends on, and its correction.
//
// The residual of each channel is regressed on functions of the bucket's state
// (closed_loop/search/unlisted_regression.h). The regression on those of the trajectory decides;
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
struct dig_unlisted dig_unlisted_find(const struct dig_whitened_digs *batch,
                                      const struct dig_fitted        *plain);

/// What to add to the fitted curves, as shares of the rms of the fitted plain curve of each
/// channel. Trajectories without digs in the batch get none. *share is the caller's.
void dig_unlisted_correct(const struct dig_whitened_digs *batch, const struct dig_fitted *fitted,
                          struct dig_model_unlisted *share);

#endif // DIG_CLOSED_LOOP_SEARCH_UNLISTED_H
