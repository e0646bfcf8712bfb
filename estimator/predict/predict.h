// Cells and points of a prediction. Machine scale follows from Froude similarity: moments and
// energy lambda^4, forces lambda^3.

#ifndef DIG_ESTIMATOR_PREDICT_PREDICT_H
#define DIG_ESTIMATOR_PREDICT_PREDICT_H

#include "core/curve.h"
#include "core/gravel_match.h"
#include "estimator/approach/interpolate.h"
#include "estimator/predict/prediction.h"

/// The cells of the match's samples for which the table has the trajectory, equally likely; without
/// any, of its gravel or nearest entry. Fails as dig_predict_curve().
DIG_MUST_CHECK enum dig_status dig_predict_cells(const struct dig_curve_set *set,
                                                 const struct dig_match *match, size_t trajectory,
                                                 struct dig_cell cell[DIG_MATCH_SAMPLES],
                                                 size_t         *cells);

/// Fills the points of *prediction between its from_progress and to_progress.
void dig_predict_points(const struct dig_curve *curve, double lambda,
                        struct dig_prediction *prediction);

#endif // DIG_ESTIMATOR_PREDICT_PREDICT_H
