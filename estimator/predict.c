#include "estimator/predict.h"

#include "estimator/interpolate.h"
#include "estimator/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

double dig_predict_peak_Nm(const struct dig_curve *const curve)
{
    assert(curve != NULL);
    double peak_Nm = (double)curve->mean[DIG_CHANNEL_MY_Nm][0];
    for (size_t k = 1; k < DIG_CURVE_POINTS; k++) {
        peak_Nm = fmax(peak_Nm, (double)curve->mean[DIG_CHANNEL_MY_Nm][k]);
    }
    return peak_Nm;
}

double dig_predict_energy_J(const struct dig_trajectory *const trajectory, const double tooth_m,
                            const struct dig_curve *const curve)
{
    assert(trajectory != NULL && curve != NULL);
    double          energy_J = 0.0;
    struct dig_pose before   = dig_trajectory_pose(trajectory, 0.0);
    for (size_t k = 1; k < DIG_CURVE_POINTS; k++) {
        const double          progress = (double)k / (DIG_CURVE_POINTS - 1);
        const double          time_s   = dig_trajectory_time_s(trajectory, tooth_m, progress);
        const struct dig_pose pose     = dig_trajectory_pose(trajectory, time_s);

        double mean[DIG_FORCE_CHANNELS];
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            mean[c] = 0.5 * ((double)curve->mean[c][k - 1] + (double)curve->mean[c][k]);
        }
        energy_J += mean[DIG_CHANNEL_MY_Nm] * (pose.theta_rad - before.theta_rad) -
                    mean[DIG_CHANNEL_FX_N] * (pose.x_m - before.x_m) -
                    mean[DIG_CHANNEL_FZ_N] * (pose.z_m - before.z_m);
        before = pose;
    }
    return energy_J;
}

static double read_off(const float curve[DIG_CURVE_POINTS], const double progress)
{
    const double at = fmin(fmax(progress, 0.0), 1.0) * (DIG_CURVE_POINTS - 1);
    const size_t k  = (size_t)fmin(floor(at), DIG_CURVE_POINTS - 2);
    const double f  = at - (double)k;
    return (1.0 - f) * (double)curve[k] + f * (double)curve[k + 1];
}

void dig_predict_points(const struct dig_curve *const curve, const double lambda,
                        struct dig_prediction *const prediction)
{
    assert(curve != NULL && prediction != NULL);
    const double lambda3 = lambda * lambda * lambda;
    const double lambda4 = lambda3 * lambda;
    for (size_t i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double share = (double)i / (DIG_PREDICTION_POINTS - 1);
        const double at    = prediction->from_progress +
                          share * (prediction->to_progress - prediction->from_progress);
        prediction->moment_Nm[i] = lambda4 * read_off(curve->mean[DIG_CHANNEL_MY_Nm], at);
        prediction->sigma_Nm[i]  = lambda4 * read_off(curve->sd[DIG_CHANNEL_MY_Nm], at);
        prediction->Fx_N[i]      = lambda3 * read_off(curve->mean[DIG_CHANNEL_FX_N], at);
        prediction->Fz_N[i]      = lambda3 * read_off(curve->mean[DIG_CHANNEL_FZ_N], at);
    }
}

// The gravels that stand for the match and for which the table has the trajectory.
static size_t find_cells(const struct dig_curve_set *const set, const struct dig_match *const match,
                         const size_t trajectory, struct dig_cell cell[DIG_MATCH_SAMPLES])
{
    size_t cells = 0;
    for (size_t s = 0; s < match->samples && s < DIG_MATCH_SAMPLES; s++) {
        if (dig_cell_find(set, &match->sample[s], trajectory, &cell[cells]) == DIG_OK) {
            cells++;
        }
    }
    if (cells == 0 && dig_cell_find(set, &match->gravel, trajectory, &cell[0]) == DIG_OK) {
        cells = 1;
    }
    if (cells == 0 &&
        dig_cell_find(set, &set->gravel[match->nearest], trajectory, &cell[0]) == DIG_OK) {
        cells = 1;
    }
    return cells;
}

enum dig_status dig_predict_curve(const struct dig_curve_set *const set,
                                  const struct dig_match *const match, const size_t trajectory,
                                  struct dig_curve *const curve)
{
    assert(set != NULL && match != NULL && curve != NULL);
    if (!match->valid || trajectory >= set->trajectories || match->nearest < 0 ||
        (size_t)match->nearest >= set->entries) {
        return DIG_EINVAL;
    }
    struct dig_cell cell[DIG_MATCH_SAMPLES];
    const size_t    cells = find_cells(set, match, trajectory, cell);
    if (cells == 0) {
        return DIG_ENOMATCH;
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
