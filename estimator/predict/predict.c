#include "estimator/predict/predict.h"

#include "estimator/match/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

void dig_predict_points(const struct dig_curve *const curve, const double lambda,
                        struct dig_prediction *const prediction)
{
    assert(curve != NULL && prediction != NULL);
    const double lambda3 = lambda * lambda * lambda;
    const double lambda4 = lambda3 * lambda;
    for (size_t i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double share = (double)i / (DIG_PREDICTION_POINTS - 1);
        const double at    = (DIG_CURVE_POINTS - 1) *
                          (prediction->from_progress +
                           share * (prediction->to_progress - prediction->from_progress));
        prediction->moment_Nm[i]  = lambda4 * dig_curve_at(curve->mean[DIG_CHANNEL_MY_Nm], at);
        prediction->sigma_Nm[i]   = lambda4 * dig_curve_at(curve->sd[DIG_CHANNEL_MY_Nm], at);
        prediction->Fx_N[i]       = lambda3 * dig_curve_at(curve->mean[DIG_CHANNEL_FX_N], at);
        prediction->Fz_N[i]       = lambda3 * dig_curve_at(curve->mean[DIG_CHANNEL_FZ_N], at);
        prediction->sigma_Fx_N[i] = lambda3 * dig_curve_at(curve->sd[DIG_CHANNEL_FX_N], at);
        prediction->sigma_Fz_N[i] = lambda3 * dig_curve_at(curve->sd[DIG_CHANNEL_FZ_N], at);
    }
}

enum dig_status dig_predict_cells(const struct dig_curve_set *const set,
                                  const struct dig_match *const match, const size_t trajectory,
                                  struct dig_cell cell[const DIG_MATCH_SAMPLES],
                                  size_t *const   cells)
{
    assert(set != NULL && match != NULL && cell != NULL && cells != NULL);
    if (!match->valid || trajectory >= set->trajectories || match->nearest < 0 ||
        (size_t)match->nearest >= set->entries) {
        return DIG_EINVAL;
    }
    size_t found = 0;
    for (size_t s = 0; s < match->samples && s < DIG_MATCH_SAMPLES; s++) {
        if (dig_cell_find(set, &match->sample[s], trajectory, &cell[found]) == DIG_OK) {
            found++;
        }
    }
    const struct dig_gravel *const instead[] = { &match->gravel, &set->gravel[match->nearest] };
    for (size_t i = 0; found == 0 && i < sizeof instead / sizeof instead[0]; i++) {
        found = dig_cell_find(set, instead[i], trajectory, &cell[0]) == DIG_OK ? 1 : 0;
    }
    if (found == 0) {
        return DIG_ENOMATCH;
    }
    *cells = found;
    return DIG_OK;
}

enum dig_status dig_predict_curve(const struct dig_curve_set *const set,
                                  const struct dig_match *const match, const size_t trajectory,
                                  struct dig_curve *const curve)
{
    assert(set != NULL && match != NULL && curve != NULL);
    struct dig_cell       cell[DIG_MATCH_SAMPLES];
    size_t                cells  = 0;
    const enum dig_status status = dig_predict_cells(set, match, trajectory, cell, &cells);
    if (status != DIG_OK) {
        return status;
    }

    // Law of total variance: spread of one dig at each gravel, and of the means between gravels.
    const double n = (double)cells;
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            double sum     = 0.0;
            double sum2    = 0.0;
            double within2 = 0.0;
            for (size_t i = 0; i < cells; i++) {
                const double mean = dig_cell_mean(&cell[i], (enum dig_channel)c, k);
                const double sd   = dig_cell_sd(&cell[i], (enum dig_channel)c, k);
                sum += mean;
                sum2 += mean * mean;
                within2 += sd * sd * (1.0 + cell[i].inverse_packings);
            }
            const double between2 = fmax(sum2 / n - (sum / n) * (sum / n), 0.0);
            curve->mean[c][k]     = (float)(sum / n);
            curve->sd[c][k]       = (float)sqrt(within2 / n + between2);
        }
    }
    return DIG_OK;
}
