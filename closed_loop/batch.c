#include "closed_loop/batch.h"

#include "closed_loop/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { LEAST_FEATURES = DIG_FEATURE_BINS / 2 };

static void features_of(const struct dig_measured *const dig, double feature[DIG_FEATURES])
{
    double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve[c][k] = dig->value[c][k] - dig->machine[c][k];
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, feature);
}

static size_t group_of(struct dig_batch *const batch, const size_t trajectory)
{
    size_t g = 0;
    while (g < batch->groups && batch->group[g].trajectory != trajectory) {
        g++;
    }
    if (g == batch->groups) {
        batch->group[g] = (struct dig_batch_group){ .trajectory = trajectory };
        batch->groups++;
    }
    return g;
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

// What effects of the machine add is known to this share of it.
static const double machine_error = 0.1;

// The variance of the sensors in a bin, where their error does not average down, and of what was
// taken off for the machine.
static double sensor_variance(const struct dig_batch *const batch, const size_t g, const size_t f)
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
            const double sigma   = dig->sigma[f / DIG_FEATURE_BINS][k];
            const double machine = machine_error * dig->machine[f / DIG_FEATURE_BINS][k];
            sum += sigma * sigma + machine * machine;
            n += 1.0;
        }
    }
    return n > 0.0 ? sum / n : 0.0;
}

// The size of the group's mean dig, and of its scatter at the gravel it is thought to be of.
static void measure_size(const struct dig_batch *const batch, const size_t g,
                         const double feature[][DIG_FEATURES], const bool mask[DIG_FEATURES],
                         const double place[DIG_AXES], double amplitude[DIG_FORCE_CHANNELS])
{
    const struct dig_batch_group *const group              = &batch->group[g];
    double                              mean[DIG_FEATURES] = { 0.0 };
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t f = 0; batch->dig[i].group == g && f < DIG_FEATURES; f++) {
            mean[f] += feature[i][f] / (double)group->digs;
        }
    }
    dig_features_amplitude(mean, mask, amplitude);
    if (place == NULL) {
        return;
    }
    // The whole dig's amplitude follows from the part that was measured as the table's does.
    const struct dig_gravel gravel = dig_surface_gravel(batch->surface, place);
    double                  table[DIG_FEATURES];
    double                  whole[DIG_FORCE_CHANNELS];
    double                  part[DIG_FORCE_CHANNELS];
    dig_surface_features(batch->surface, group->trajectory, place, table, whole);
    dig_features_amplitude(table, mask, part);
    const double strength = log(whole[DIG_CHANNEL_MY_Nm] / gravel.value[DIG_AXIS_DENSITY_kgpm3]);
    const double factor   = sqrt(dig_scatter_factor(batch->scatter, group->trajectory, strength));
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        amplitude[c] *= factor * whole[c] / fmax(part[c], 1e-3 * whole[c]);
    }
}

static enum dig_status fill_group(struct dig_batch *const batch, const size_t g,
                                  const double feature[][DIG_FEATURES],
                                  const double place[DIG_AXES])
{
    struct dig_batch_group *const group = &batch->group[g];
    bool                          mask[DIG_FEATURES];
    intersect(batch, g, mask);
    measure_size(batch, g, feature, mask, place, group->amplitude);
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
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            group->lower[i * n + j] =
                batch->scatter->covariance[group->trajectory][group->feature[i]][group->feature[j]];
        }
        const size_t f = group->feature[i];
        group->lower[i * n + i] +=
            sensor_variance(batch, g, f) / pow(group->amplitude[f / DIG_FEATURE_BINS], 2.0);
    }
    return dig_cholesky(n, group->lower) == DIG_OK ? DIG_OK : DIG_ENOMATCH;
}

void dig_batch_whiten(const struct dig_batch_group *const group, const double feature[DIG_FEATURES],
                      double y[DIG_FEATURES])
{
    for (size_t i = 0; i < group->features; i++) {
        const size_t f = group->feature[i];
        y[i]           = feature[f] / group->amplitude[f / DIG_FEATURE_BINS];
    }
    dig_lower_solve(group->features, group->lower, y);
}

void dig_batch_summarise(struct dig_batch *const batch)
{
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_batch_group *const group = &batch->group[g];
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

enum dig_status dig_batch_make(const struct dig_surface *const surface,
                               const struct dig_scatter *const scatter, const size_t digs,
                               const struct dig_measured measured[], const bool take[],
                               const double place[DIG_AXES], struct dig_batch *const batch)
{
    assert(surface != NULL && scatter != NULL && measured != NULL && batch != NULL);
    memset(batch, 0, sizeof *batch);
    batch->surface                                 = surface;
    batch->scatter                                 = scatter;
    batch->measured                                = measured;
    double feature[DIG_MEASURED_MAX][DIG_FEATURES] = { { 0.0 } };
    for (size_t i = 0; i < digs && batch->digs < DIG_MEASURED_MAX; i++) {
        const size_t t = (size_t)measured[i].trajectory;
        if (!take[i] || !surface->known[t]) {
            continue;
        }
        struct dig_batch_dig *const dig = &batch->dig[batch->digs];
        dig->group                      = group_of(batch, t);
        dig->measured                   = i;
        batch->group[dig->group].digs++;
        features_of(&measured[i], feature[batch->digs++]);
    }
    enum dig_status status = batch->digs > 0 ? DIG_OK : DIG_ENOMATCH;
    for (size_t g = 0; g < batch->groups && status == DIG_OK; g++) {
        status = fill_group(batch, g, (const double(*)[DIG_FEATURES])feature, place);
    }
    for (size_t i = 0; i < batch->digs && status == DIG_OK; i++) {
        dig_batch_whiten(&batch->group[batch->dig[i].group], feature[i], batch->dig[i].y);
    }
    if (status == DIG_OK) {
        dig_batch_summarise(batch);
    }
    return status;
}
