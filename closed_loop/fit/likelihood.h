// Misfit of a hypothesis at given numbers to a batch: -2 log likelihood.
//
//   sum over trajectories [ |L^-1 (mean y - mean model)|^2 + log det L L'
//                           + sum over digs |(y - mean y) - (model - mean model)|^2 ]
//
// L L' is the covariance of a trajectory's mean: closed_loop/fit/common_error.h. Where the batch
// has steps, z is fitted along, exactly, and integrated out: mean model grows by D z, and
// |z - middle|^2 + log det (1 + sum D' C^-1 D) is added. What has no name is an effect of unknown
// form: a factor on the plain dig, with a wide prior, that changes along it. It has no numbers to
// fit; it is part of the covariance.

#ifndef DIG_CLOSED_LOOP_FIT_LIKELIHOOD_H
#define DIG_CLOSED_LOOP_FIT_LIKELIHOOD_H

#include "closed_loop/fit/common_error.h"
#include "closed_loop/fit/forward.h"
#include "closed_loop/fit/steps.h"

#define DIG_LIKELIHOOD_RESIDUALS                                                                   \
    ((DIG_TRAJECTORY_MAX + DIG_MEASURED_MAX) * DIG_FEATURES + DIG_STEPS_MAX)

/// The same numbers are asked about again and again: what was worked out of the last ones is kept.
struct dig_likelihood {
    const struct dig_batch      *batch;      // not owned
    const struct dig_hypothesis *hypothesis; // not owned
    size_t                       numbers;    // of the hypothesis
    size_t                       residuals;
    size_t                       means;   // of the residuals, those of the means, which come first
    bool                         differs; // from dig to dig of a trajectory

    double           place[DIG_AXES]; // of which plain is
    struct dig_plain plain[DIG_TRAJECTORY_MAX];

    double at[DIG_HYPOTHESIS_NUMBERS];             // of which these are
    double mean[DIG_TRAJECTORY_MAX][DIG_FEATURES]; // y of the model, over a group's digs
    double y[DIG_MEASURED_MAX][DIG_FEATURES];      // of each dig, where they differ

    double                  weighed_at[DIG_HYPOTHESIS_NUMBERS]; // of which this is
    struct dig_common_error error[DIG_TRAJECTORY_MAX];

    // Of the batch's steps, by that covariance: L^-1 D, step by step and feature by feature, and
    // the lower triangle of 1 + sum D' C^-1 D.
    size_t steps;
    double step[DIG_STEPS_MAX][DIG_TRAJECTORY_MAX][DIG_FEATURES];
    double by_feature[DIG_TRAJECTORY_MAX][DIG_FEATURES][DIG_STEPS_MAX];
    double step_lower[DIG_STEPS_MAX * DIG_STEPS_MAX];
    double step_log_det;
};

void dig_likelihood_init(struct dig_likelihood *l, const struct dig_batch *batch,
                         const struct dig_hypothesis *hypothesis);

/// Takes the covariance at the numbers x for all that follows.
void dig_likelihood_weigh(struct dig_likelihood *l, const double x[]);

/// The whitened residuals r of the means, of the digs about them, and z - middle, at x; context:
/// the likelihood.
void dig_likelihood_residual(void *context, const double x[], double r[]);

/// The misfit of residuals so long; *squares: of it, what is not a logarithm.
double dig_likelihood_misfit(const struct dig_likelihood *l, const double residual[],
                             double *squares);

#endif // DIG_CLOSED_LOOP_FIT_LIKELIHOOD_H
