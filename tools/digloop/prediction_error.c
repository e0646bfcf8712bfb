#include "tools/digloop/prediction_error.h"

#include "core/markup.h"
#include "estimator/predict/peak_energy.h"
#include "tools/digloop/as_dug.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

// Peak and energy of a measured dig. The energy needs the forces.
static void add_peak_energy(const struct dig_trajectory *const t, const double tooth_m,
                            const struct dig_observation *const    dig,
                            struct digloop_prediction_error *const errors)
{
    struct dig_channels weight;
    dig_peak_energy_weights(t, tooth_m, &weight);
    double peak_Nm  = -INFINITY;
    double energy_J = dig->forces ? 0.0 : (double)NAN;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at >= dig->first && at <= dig->last) {
            peak_Nm = fmax(peak_Nm, dig->moment_Nm[k]);
            energy_J += weight.of[0][k] * dig->moment_Nm[k] + weight.of[1][k] * dig->force_N[0][k] +
                        weight.of[2][k] * dig->force_N[1][k];
        }
    }
    if (errors->digs < DIGLOOP_PREDICTION_ERROR_DIGS) {
        errors->peak_Nm[errors->digs]  = peak_Nm;
        errors->energy_J[errors->digs] = energy_J;
        errors->digs++;
    }
}

// Error of the prediction of one dig at its own approach.
static enum dig_status score_dig(const struct dig_curve_set *const      set,
                                 const struct dig_match *const          match,
                                 const struct dig_observation *const    dig,
                                 struct digloop_prediction_error *const errors,
                                 struct dig_error *const                error)
{
    struct digloop_as_dug table = { .set = NULL };
    struct dig_curve      curve;
    size_t                at = 0;
    enum dig_status       status =
        digloop_as_dug_at(set, (size_t)dig->trajectory, &dig->approach, &table, &at, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_predict_curve(table.set, match, at, &curve);
    if (status == DIG_OK) {
        const struct dig_trajectory *const t = &table.set->trajectory[at];
        double                             predicted_Nm[DIG_CURVE_POINTS];
        double                             sigma_Nm[DIG_CURVE_POINTS];
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            predicted_Nm[k] = (double)curve.mean[DIG_CHANNEL_MY_Nm][k];
            sigma_Nm[k]     = (double)curve.sd[DIG_CHANNEL_MY_Nm][k];
        }
        dig_score_add(&errors->score, t, set->tooth_m, dig->first, dig->last, dig->moment_Nm,
                      predicted_Nm, sigma_Nm);
        dig_coverage_add(&errors->coverage, dig, &curve);
        add_peak_energy(t, set->tooth_m, dig, errors);
    } else {
        (void)dig_error_set(error, status, "%s", dig_status_str(status));
    }
    digloop_as_dug_finish(&table);
    return status;
}

enum dig_status digloop_prediction_error_measure(const struct digloop_job *const job, const int t,
                                                 const struct dig_match *const          match,
                                                 struct digloop_prediction_error *const errors,
                                                 struct dig_error *const                error)
{
    struct dig_observed_digs seen = { .digs = 0 };
    enum dig_status status        = digloop_read_digs(job, job->options->measured, t, &seen, error);
    for (size_t i = 0; status == DIG_OK && i < seen.digs; i++) {
        status = score_dig(job->set, match, &seen.dig[i], errors, error);
    }
    dig_observed_digs_finish(&seen);
    return status;
}

static void put_list(const char *const name, const size_t n, const double value[])
{
    dig_json_put(stdout, ", %s: [", name);
    for (size_t i = 0; i < n; i++) {
        dig_json_put(stdout, i == 0 ? "%g" : ", %g", value[i]);
    }
    (void)fputs("]", stdout);
}

void digloop_prediction_error_put(const struct digloop_prediction_error *const errors)
{
    dig_json_put(stdout, ", \"error\": %g, \"noise_floor\": %g", dig_score_error(&errors->score),
                 dig_score_noise_floor(&errors->score));
    double inside[DIG_FORCE_CHANNELS];
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        inside[c] = dig_coverage_share(&errors->coverage, (enum dig_channel)c);
    }
    put_list("inside_90", DIG_FORCE_CHANNELS, inside);
    put_list("measured_peak_Nm", errors->digs, errors->peak_Nm);
    put_list("measured_energy_J", errors->digs, errors->energy_J);
}
