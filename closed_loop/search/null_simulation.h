// Distribution of the test statistics under a fitted hypothesis, by simulation with refit. It
// decides what is significant and what fits.
//
// Digs are drawn about the fitted model with the table's own residuals (or normal numbers where the
// table has none), as much larger or smaller as its few packings leave open, and the sensors'
// noise, the errors common to a trajectory with the variance the fit gave them; each draw is fitted
// as the campaign was. A tail beyond the draws is that of the gamma distribution with their mean
// and variance.

#ifndef DIG_CLOSED_LOOP_SEARCH_NULL_SIMULATION_H
#define DIG_CLOSED_LOOP_SEARCH_NULL_SIMULATION_H

#include "closed_loop/fit/hypothesis.h"

#include <stdint.h>

#define DIG_RIVALS_MAX 24

/// The statistics of one batch.
struct dig_statistic {
    double misfit; // of the means: what is left after the fit
    double about;  // of the digs about their means
    double gain;   // the most that a rival takes off the misfit
    size_t best;   // which rival; the number of rivals when none takes anything off
};

struct dig_null_simulation {
    size_t draws;
    double mean[3], variance[3]; // of misfit, about, gain over the draws
};

/// What a simulation is to decide: whether a gain is rarer than the level.
struct dig_null_question {
    double gain, level;
};

/// Fits a batch by base and by base with each rival added, from the numbers given. Writes the
/// fits: fitted[0] by base, fitted[1 + i] by rival i.
void dig_null_simulation_fit(const struct dig_batch *batch, const struct dig_hypothesis *base,
                             size_t rivals, const struct dig_hypothesis rival[],
                             const double start[], enum dig_fit_care care,
                             struct dig_fitted fitted[], struct dig_statistic *statistic);

/// Draws the digs of one campaign from fitted into drawn, which is a copy of batch. error:
/// dig_hypothesis_errors() of both, which no draw changes.
void dig_null_simulation_digs(const struct dig_batch *batch, const struct dig_fitted *fitted,
                              const struct dig_common_error error[], uint64_t *seed,
                              struct dig_batch *drawn);

/// Draws from fitted and fits again, draws times. Fewer suffice where the chance is clearly above
/// or below the level asked about; asked may be NULL.
struct dig_null_simulation
dig_null_simulation_draw(const struct dig_batch *batch, const struct dig_fitted *fitted,
                         size_t rivals, const struct dig_hypothesis rival[], size_t draws,
                         const struct dig_null_question *asked, uint64_t *seed);

/// What a fit leaves of the means: a statistic's misfit.
double dig_null_simulation_left(const struct dig_batch *batch, const struct dig_fitted *fitted);

/// Chance, 0 … 1, of a statistic this large or larger (index 0 misfit, 1 about, 2 gain).
double dig_null_simulation_p(const struct dig_null_simulation *null, size_t index, double value);

#endif // DIG_CLOSED_LOOP_SEARCH_NULL_SIMULATION_H
