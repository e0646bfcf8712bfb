#include "closed_loop/fit/batch_group.h"

#include "closed_loop/model/approach_change.h"
#include "closed_loop/model/soil_fit.h"
#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { LEAST_FEATURES = DIG_FEATURE_BINS / 2 };

const struct dig_measured *dig_batch_first(const struct dig_batch *const batch, const size_t group)
{
    assert(batch != NULL && group < batch->groups);
    size_t i = 0;
    while (batch->dig[i].group != group) {
        i++;
    }
    return &batch->measured[batch->dig[i].measured];
}

// The features that all digs of a group have.
static void intersect(const struct dig_batch *const batch, const size_t g, bool mask[DIG_FEATURES])
{
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        mask[f] = true;
    }
    for (size_t i = 0; i < batch->digs; i++) {
        if (batch->dig[i].group == g) {
            const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
            bool                             has[DIG_FEATURES];
            dig_features_mask(dig->measured, dig->first, dig->last, has);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                mask[f] = mask[f] && has[f];
            }
        }
    }
}

// The variance of the sensors in a bin, where their error does not average down.
static double sensor_variance(const struct dig_batch *const batch, const size_t g, const size_t f)
{
    double               sum    = 0.0;
    double               n      = 0.0;
    const struct dig_bin points = dig_feature_bin(f % DIG_FEATURE_BINS);
    for (size_t i = 0; i < batch->digs; i++) {
        if (batch->dig[i].group != g) {
            continue;
        }
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        for (size_t k = points.from; k < points.to; k++) {
            const double sigma = dig->sigma[f / DIG_FEATURE_BINS][k];
            sum += sigma * sigma;
            n += 1.0;
        }
    }
    return n > 0.0 ? sum / n : 0.0;
}

// The size of the group's mean dig times the root of the scatter's factor, which is returned, at
// the gravel it is thought to be of.
static double measure_size(const struct dig_batch *const batch, const size_t g,
                           const double feature[][DIG_FEATURES], const bool mask[DIG_FEATURES],
                           const double place[DIG_AXES], double amplitude[DIG_FORCE_CHANNELS])
{
    const struct dig_group *const group              = &batch->group[g];
    double                        mean[DIG_FEATURES] = { 0.0 };
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t f = 0; batch->dig[i].group == g && f < DIG_FEATURES; f++) {
            mean[f] += feature[i][f] / (double)group->digs;
        }
    }
    dig_features_amplitude(mean, mask, amplitude);
    if (place == NULL) {
        return 1.0;
    }
    // The whole dig's amplitude follows from the part that was measured as the table's does.
    double table[DIG_FEATURES];
    double whole[DIG_FORCE_CHANNELS];
    double part[DIG_FORCE_CHANNELS];
    dig_response_surface_features(batch->soil->surface, group->trajectory, place, table, whole);
    dig_features_amplitude(table, mask, part);
    const double strength = dig_soil_strength(batch->soil->surface, place, whole);
    const double factor   = sqrt(dig_scatter_factor(batch->scatter, group->trajectory, strength));
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        amplitude[c] *= factor * whole[c] / fmax(part[c], 1e-3 * whole[c]);
    }
    return factor;
}

// What a dig of the group does where its ground lies elsewhere, 1 sigma over the size; zeros where
// that is known. Digs of a trajectory scatter alike, so that the most open of them counts for all.
static enum dig_status open_depth(const struct dig_batch *const batch, const size_t g,
                                  const double place[DIG_AXES], double change[DIG_FEATURES])
{
    double share = 0.0;
    for (size_t i = 0; i < batch->digs; i++) {
        share = batch->dig[i].group == g
                    ? fmax(share, batch->measured[batch->dig[i].measured].depth_share)
                    : share;
    }
    memset(change, 0, DIG_FEATURES * sizeof change[0]);
    if (!(share > 0.0)) {
        return DIG_OK;
    }
    const struct dig_gravel gravel =
        dig_response_surface_gravel(batch->soil->surface, place != NULL ? place : change);
    const enum dig_status status =
        dig_depth_change(batch->soil->surface->set, batch->group[g].trajectory,
                         place != NULL ? &gravel : NULL, change);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        change[f] *= share;
    }
    return status;
}

// What lasts of the sensors' noise, as digs of a trajectory have it on average.
static void fill_lasting(const struct dig_batch *const batch, const size_t g,
                         struct dig_group *const group)
{
    const double                      memory_s = dig_batch_first(batch, g)->lasting.memory_s;
    const struct dig_curve_set *const set      = batch->soil->surface->set;
    memset(group->lasting, 0, sizeof group->lasting);
    memset(group->lasting_sigma, 0, sizeof group->lasting_sigma);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_lasting *const one = &batch->measured[batch->dig[i].measured].lasting;
        for (size_t c = 0; batch->dig[i].group == g && c < DIG_FORCE_CHANNELS; c++) {
            group->lasting_sigma[c] =
                hypot(group->lasting_sigma[c], one->sigma[c] / sqrt((double)group->digs));
        }
    }
    if (memory_s > 0.0) {
        double edge_s[DIG_FEATURE_BINS + 1];
        for (size_t b = 0; b <= DIG_FEATURE_BINS; b++) {
            edge_s[b] = dig_trajectory_time_s(&set->trajectory[group->trajectory], set->tooth_m,
                                              (double)b / DIG_FEATURE_BINS);
        }
        dig_features_lasting(edge_s, set->smooth_half_s, memory_s, group->lasting);
    }
}

// The covariance of two features by that, over the group's amplitude.
static double lasting_covariance(const struct dig_group *const group, const size_t a,
                                 const size_t b)
{
    const size_t c     = a / DIG_FEATURE_BINS;
    const double sigma = group->lasting_sigma[c] / group->amplitude[c];
    return c == b / DIG_FEATURE_BINS
               ? sigma * sigma *
                     group->lasting[a % DIG_FEATURE_BINS * DIG_FEATURE_BINS + b % DIG_FEATURE_BINS]
               : 0.0;
}

enum dig_status dig_batch_group_fill(struct dig_batch *const batch, const size_t g,
                                     const double feature[][DIG_FEATURES],
                                     const double place[DIG_AXES])
{
    assert(batch != NULL && g < batch->groups && feature != NULL);
    struct dig_group *const group = &batch->group[g];
    bool                    mask[DIG_FEATURES];
    intersect(batch, g, mask);
    const double root = measure_size(batch, g, feature, mask, place, group->amplitude);
    double       deeper[DIG_FEATURES];
    group->features = 0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        if (mask[f]) {
            group->feature[group->features++] = f;
        }
    }
    const size_t n = group->features;
    if (n < LEAST_FEATURES) {
        return DIG_ENOMATCH;
    }
    const enum dig_status status = open_depth(batch, g, place, deeper);
    if (status != DIG_OK) {
        return status;
    }
    fill_lasting(batch, g, group);
    double lower[DIG_FEATURES * DIG_FEATURES];
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            const size_t a   = group->feature[i];
            const size_t b   = group->feature[j];
            lower[i * n + j] = batch->scatter->covariance[group->trajectory][a][b] +
                               deeper[a] * deeper[b] / (root * root) +
                               lasting_covariance(group, a, b);
        }
        const size_t f   = group->feature[i];
        group->sensor[f] = sqrt(sensor_variance(batch, g, f));
        lower[i * n + i] += pow(group->sensor[f] / group->amplitude[f / DIG_FEATURE_BINS], 2.0);
    }
    if (dig_cholesky(n, lower) != DIG_OK) {
        return DIG_ENOMATCH;
    }
    group->log_det = dig_lower_log_det(n, lower);
    for (size_t k = 0; k < n; k++) {
        group->whiten[k][k] = 1.0 / group->amplitude[group->feature[k] / DIG_FEATURE_BINS];
        dig_lower_solve(n, lower, group->whiten[k]);
    }
    return DIG_OK;
}
