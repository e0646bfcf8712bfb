#include "closed_loop/fit/whitened_digs.h"

#include "closed_loop/fit/same_bed.h"
#include "closed_loop/model/approach_change.h"
#include "closed_loop/numeric/dense.h"
#include "closed_loop/numeric/vectors.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { LEAST_FEATURES = DIG_FEATURE_BINS / 2 };

void dig_whitened_digs_features(const struct dig_measured *const dig, double feature[DIG_FEATURES])
{
    double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve[c][k] = dig->value[c][k] - dig->machine[c][k];
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, feature);
}

static size_t group_of(struct dig_whitened_digs *const batch, const size_t trajectory)
{
    size_t g = 0;
    while (g < batch->groups && batch->group[g].trajectory != trajectory) {
        g++;
    }
    if (g == batch->groups) {
        batch->group[g] = (struct dig_whitened_digs_group){ .trajectory = trajectory };
        batch->groups++;
    }
    return g;
}

// The features that all digs of a group have.
static void intersect(const struct dig_whitened_digs *const batch, const size_t g,
                      bool mask[DIG_FEATURES])
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
static double sensor_variance(const struct dig_whitened_digs *const batch, const size_t g,
                              const size_t f)
{
    double sum = 0.0;
    double n   = 0.0;
    size_t from;
    size_t to;
    dig_feature_bin(f % DIG_FEATURE_BINS, &from, &to);
    for (size_t i = 0; i < batch->digs; i++) {
        if (batch->dig[i].group != g) {
            continue;
        }
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        for (size_t k = from; k < to; k++) {
            const double sigma = dig->sigma[f / DIG_FEATURE_BINS][k];
            sum += sigma * sigma;
            n += 1.0;
        }
    }
    return n > 0.0 ? sum / n : 0.0;
}

// The size of the group's mean dig times the root of the scatter's factor, which is returned, at
// the gravel it is thought to be of.
static double measure_size(const struct dig_whitened_digs *const batch, const size_t g,
                           const double feature[][DIG_FEATURES], const bool mask[DIG_FEATURES],
                           const double place[DIG_AXES], double amplitude[DIG_FORCE_CHANNELS])
{
    const struct dig_whitened_digs_group *const group              = &batch->group[g];
    double                                      mean[DIG_FEATURES] = { 0.0 };
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
    const struct dig_gravel gravel = dig_response_surface_gravel(batch->soil->surface, place);
    double                  table[DIG_FEATURES];
    double                  whole[DIG_FORCE_CHANNELS];
    double                  part[DIG_FORCE_CHANNELS];
    dig_response_surface_features(batch->soil->surface, group->trajectory, place, table, whole);
    dig_features_amplitude(table, mask, part);
    const double strength = log(whole[DIG_CHANNEL_MY_Nm] / gravel.value[DIG_AXIS_DENSITY_kgpm3]);
    const double factor   = sqrt(dig_scatter_factor(batch->scatter, group->trajectory, strength));
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        amplitude[c] *= factor * whole[c] / fmax(part[c], 1e-3 * whole[c]);
    }
    return factor;
}

// What a dig of the group does where its ground lies elsewhere, 1 sigma over the size; zeros where
// that is known. Digs of a trajectory scatter alike, so that the most open of them counts for all.
static enum dig_status open_depth(const struct dig_whitened_digs *const batch, const size_t g,
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

// What lasts of the sensors' noise.
static void fill_lasting(const struct dig_whitened_digs *const batch, const size_t g,
                         struct dig_whitened_digs_group *const group)
{
    const struct dig_lasting *const   noise = &dig_whitened_digs_first(batch, g)->lasting;
    const struct dig_curve_set *const set   = batch->soil->surface->set;
    memset(group->lasting, 0, sizeof group->lasting);
    memcpy(group->lasting_sigma, noise->sigma, sizeof group->lasting_sigma);
    if (noise->memory_s > 0.0) {
        double edge_s[DIG_FEATURE_BINS + 1];
        for (size_t b = 0; b <= DIG_FEATURE_BINS; b++) {
            edge_s[b] = dig_trajectory_time_s(&set->trajectory[group->trajectory], set->tooth_m,
                                              (double)b / DIG_FEATURE_BINS);
        }
        dig_features_lasting(edge_s, set->smooth_half_s, noise->memory_s, group->lasting);
    }
}

// The covariance of two features by that, over the group's amplitude.
static double lasting_covariance(const struct dig_whitened_digs_group *const group, const size_t a,
                                 const size_t b)
{
    const size_t c     = a / DIG_FEATURE_BINS;
    const double sigma = group->lasting_sigma[c] / group->amplitude[c];
    return c == b / DIG_FEATURE_BINS
               ? sigma * sigma *
                     group->lasting[a % DIG_FEATURE_BINS * DIG_FEATURE_BINS + b % DIG_FEATURE_BINS]
               : 0.0;
}

static enum dig_status fill_group(struct dig_whitened_digs *const batch, const size_t g,
                                  const double feature[][DIG_FEATURES],
                                  const double place[DIG_AXES])
{
    struct dig_whitened_digs_group *const group = &batch->group[g];
    bool                                  mask[DIG_FEATURES];
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

_Static_assert(DIG_FEATURES % DIG_ROWS_AT_ONCE == 0, "no rest");

// whiten[k] adds nothing to y before y[k].
DIG_VECTORS void dig_whitened_digs_whiten(const struct dig_whitened_digs_group *const group,
                                          const double feature[DIG_FEATURES],
                                          double       y[DIG_FEATURES])
{
    double x[DIG_FEATURES];
    for (size_t k = 0; k < group->features; k++) {
        x[k] = feature[group->feature[k]];
    }
    for (size_t first = 0; first < DIG_FEATURES; first += DIG_ROWS_AT_ONCE) {
        const size_t end = first + DIG_ROWS_AT_ONCE;
        dig_rows_add(group->features < end ? group->features : end, x, DIG_FEATURES,
                     &group->whiten[0][first], &y[first]);
    }
}

void dig_whitened_digs_spread(struct dig_whitened_digs *const batch, const double spread)
{
    assert(batch != NULL && spread > 0.0);
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_whitened_digs_group *const group = &batch->group[g];
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            group->amplitude[c] *= spread;
            group->lasting_sigma[c] *= spread;
        }
        for (size_t k = 0; k < group->features; k++) {
            group->sensor[group->feature[k]] *= spread;
            for (size_t i = 0; i < group->features; i++) {
                group->whiten[k][i] /= spread;
            }
        }
    }
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t k = 0; k < DIG_FEATURES; k++) {
            batch->dig[i].y[k] /= spread;
        }
    }
    dig_whitened_digs_summarise(batch);
}

const struct dig_measured *dig_whitened_digs_first(const struct dig_whitened_digs *const batch,
                                                   const size_t                          group)
{
    assert(batch != NULL && group < batch->groups);
    size_t i = 0;
    while (batch->dig[i].group != group) {
        i++;
    }
    return &batch->measured[batch->dig[i].measured];
}

void dig_whitened_digs_summarise(struct dig_whitened_digs *const batch)
{
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_whitened_digs_group *const group = &batch->group[g];
        memset(group->mean, 0, sizeof group->mean);
        group->about = 0.0;
        for (size_t i = 0; i < batch->digs; i++) {
            for (size_t k = 0; batch->dig[i].group == g && k < group->features; k++) {
                group->mean[k] += batch->dig[i].y[k] / (double)group->digs;
            }
        }
        for (size_t i = 0; i < batch->digs; i++) {
            for (size_t k = 0; batch->dig[i].group == g && k < group->features; k++) {
                group->about += pow(batch->dig[i].y[k] - group->mean[k], 2.0);
            }
        }
    }
}

// What the digs' number does not average out.
static void fill_shared(struct dig_whitened_digs *const batch)
{
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_whitened_digs_group *const group = &batch->group[g];
        double                                sigma = 0.0;
        memset(group->added_error, 0, sizeof group->added_error);
        for (size_t i = 0; i < batch->digs; i++) {
            const struct dig_added *const added = &batch->measured[batch->dig[i].measured].added;
            double                        feature[DIG_FEATURES];
            if (batch->dig[i].group != g || !(added->noise > 0.0)) {
                continue;
            }
            sigma += sqrt(added->noise) / (double)group->digs;
            dig_features_of((const double(*)[DIG_CURVE_POINTS])added->error, feature);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                group->added_error[f] += feature[f] / (double)group->digs;
            }
        }
        group->added_noise = sigma * sigma;
        group->repeats     = 1.0 / (double)dig_same_bed_count(batch, g) - 1.0 / (double)group->digs;
    }
}

enum dig_status dig_whitened_digs_make(const struct dig_soil *const    soil,
                                       const struct dig_scatter *const scatter, const size_t digs,
                                       const struct dig_measured measured[], const bool take[],
                                       const double                    place[DIG_AXES],
                                       struct dig_whitened_digs *const batch)
{
    assert(soil != NULL && scatter != NULL && measured != NULL && batch != NULL);
    memset(batch, 0, sizeof *batch);
    batch->soil                                    = soil;
    batch->scatter                                 = scatter;
    batch->measured                                = measured;
    double feature[DIG_MEASURED_MAX][DIG_FEATURES] = { { 0.0 } };
    for (size_t i = 0; i < digs && batch->digs < DIG_MEASURED_MAX; i++) {
        const size_t t = (size_t)measured[i].trajectory;
        if (!take[i] || !soil->surface->known[t]) {
            continue;
        }
        struct dig_whitened_digs_dig *const dig = &batch->dig[batch->digs];
        dig->group                              = group_of(batch, t);
        dig->measured                           = i;
        batch->group[dig->group].digs++;
        dig_whitened_digs_features(&measured[i], feature[batch->digs++]);
    }
    enum dig_status status = batch->digs > 0 ? DIG_OK : DIG_ENOMATCH;
    for (size_t g = 0; g < batch->groups && status == DIG_OK; g++) {
        status = fill_group(batch, g, (const double(*)[DIG_FEATURES])feature, place);
    }
    for (size_t i = 0; i < batch->digs && status == DIG_OK; i++) {
        dig_whitened_digs_whiten(&batch->group[batch->dig[i].group], feature[i], batch->dig[i].y);
    }
    if (status == DIG_OK) {
        dig_whitened_digs_summarise(batch);
        fill_shared(batch);
    }
    return status;
}

double dig_whitened_digs_misfit(const struct dig_whitened_digs *const batch, const double squares)
{
    double numbers = 0.0;
    double known   = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_whitened_digs_group *const group = &batch->group[g];
        const double freedom = batch->scatter->freedom[group->trajectory];
        numbers += (double)(group->features * group->digs);
        known += (double)group->features * (freedom > 0.0 ? freedom : (double)INFINITY);
    }
    return isinf(known) ? squares : (known + numbers) * log1p(squares / known);
}

double dig_whitened_digs_misfit_of_means(const struct dig_whitened_digs *const batch,
                                         const double                          squares)
{
    const double about = dig_whitened_digs_about(batch);
    return dig_whitened_digs_misfit(batch, squares + about) -
           dig_whitened_digs_misfit(batch, about);
}

double dig_whitened_digs_about(const struct dig_whitened_digs *const batch)
{
    double about = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        about += batch->group[g].about;
    }
    return about;
}

void dig_whitened_digs_leave_out(const struct dig_whitened_digs *const batch, const size_t dig,
                                 struct dig_whitened_digs *const others)
{
    assert(batch != NULL && others != NULL && dig < batch->digs && batch->digs > 1);
    const size_t group = batch->dig[dig].group;
    const bool   alone = batch->group[group].digs == 1;
    *others            = *batch;
    others->digs--;
    memmove(&others->dig[dig], &others->dig[dig + 1], (others->digs - dig) * sizeof others->dig[0]);
    others->group[group].digs--;
    if (alone) {
        others->groups--;
        memmove(&others->group[group], &others->group[group + 1],
                (others->groups - group) * sizeof others->group[0]);
        for (size_t i = 0; i < others->digs; i++) {
            others->dig[i].group -= others->dig[i].group > group ? 1 : 0;
        }
    }
    dig_whitened_digs_summarise(others);
    fill_shared(others);
}
