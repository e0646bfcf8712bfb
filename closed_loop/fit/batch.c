#include "closed_loop/fit/batch.h"

#include "closed_loop/fit/batch_group.h"
#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Of a normal distribution, exceeded once in a million.
static const double sigmas = 4.75;

// Chi-squared of so many degrees that is undercut once in a million (Wilson and Hilferty 1931).
static double least_chi2(const double degrees)
{
    const double spread = 2.0 / (9.0 * degrees);
    return degrees * pow(fmax(1.0 - spread - sigmas * sqrt(spread), 0.0), 3.0);
}

static bool are_one(const struct dig_batch *const batch, const struct dig_batch_dig *const a,
                    const struct dig_batch_dig *const b)
{
    const size_t features = batch->group[a->group].features;
    double       apart2   = 0.0;
    for (size_t k = 0; k < features; k++) {
        apart2 += pow(a->y[k] - b->y[k], 2.0);
    }
    return a->group == b->group && 0.5 * apart2 < least_chi2((double)features);
}

size_t dig_same_bed_count(const struct dig_batch *const batch, const size_t group)
{
    assert(batch != NULL && group < batch->groups);
    size_t beds = 0;
    for (size_t i = 0; i < batch->digs; i++) {
        bool is_new = batch->dig[i].group == group;
        for (size_t j = 0; j < i; j++) {
            is_new = is_new && !are_one(batch, &batch->dig[i], &batch->dig[j]);
        }
        beds += is_new ? 1 : 0;
    }
    return beds;
}

void dig_batch_features(const struct dig_measured *const dig, double feature[DIG_FEATURES])
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
        batch->group[g] = (struct dig_group){ .trajectory = trajectory };
        batch->groups++;
    }
    return g;
}

_Static_assert(DIG_FEATURES % DIG_ROWS_AT_ONCE == 0, "no rest");

// whiten[k] adds nothing to y before y[k].
DIG_VECTORS void dig_batch_whiten(const struct dig_group *const group,
                                  const double feature[DIG_FEATURES], double y[DIG_FEATURES])
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

void dig_batch_spread(struct dig_batch *const batch, const double spread)
{
    assert(batch != NULL && spread > 0.0);
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_group *const group = &batch->group[g];
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
    dig_batch_summarise(batch);
}

void dig_batch_summarise(struct dig_batch *const batch)
{
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_group *const group = &batch->group[g];
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
static void fill_shared(struct dig_batch *const batch)
{
    for (size_t g = 0; g < batch->groups; g++) {
        struct dig_group *const group = &batch->group[g];
        double                  sigma = 0.0;
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

enum dig_status dig_batch_make(const struct dig_soil *const    soil,
                               const struct dig_scatter *const scatter, const size_t digs,
                               const struct dig_measured measured[], const bool take[],
                               const double place[DIG_AXES], struct dig_batch *const batch)
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
        struct dig_batch_dig *const dig = &batch->dig[batch->digs];
        dig->group                      = group_of(batch, t);
        dig->measured                   = i;
        batch->group[dig->group].digs++;
        dig_batch_features(&measured[i], feature[batch->digs++]);
    }
    enum dig_status status = batch->digs > 0 ? DIG_OK : DIG_ENOMATCH;
    for (size_t g = 0; g < batch->groups && status == DIG_OK; g++) {
        status = dig_batch_group_fill(batch, g, (const double(*)[DIG_FEATURES])feature, place);
    }
    for (size_t i = 0; i < batch->digs && status == DIG_OK; i++) {
        dig_batch_whiten(&batch->group[batch->dig[i].group], feature[i], batch->dig[i].y);
    }
    if (status == DIG_OK) {
        dig_batch_summarise(batch);
        fill_shared(batch);
    }
    return status;
}

double dig_batch_misfit(const struct dig_batch *const batch, const double squares)
{
    double numbers = 0.0;
    double known   = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_group *const group   = &batch->group[g];
        const double                  freedom = batch->scatter->freedom[group->trajectory];
        numbers += (double)(group->features * group->digs);
        known += (double)group->features * (freedom > 0.0 ? freedom : (double)INFINITY);
    }
    return isinf(known) ? squares : (known + numbers) * log1p(squares / known);
}

double dig_batch_misfit_of_means(const struct dig_batch *const batch, const double squares)
{
    const double about = dig_batch_about(batch);
    return dig_batch_misfit(batch, squares + about) - dig_batch_misfit(batch, about);
}

double dig_batch_about(const struct dig_batch *const batch)
{
    double about = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        about += batch->group[g].about;
    }
    return about;
}

void dig_batch_leave_out(const struct dig_batch *const batch, const size_t dig,
                         struct dig_batch *const others)
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
    dig_batch_summarise(others);
    fill_shared(others);
}
