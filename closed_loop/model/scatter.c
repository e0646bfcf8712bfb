#include "closed_loop/model/scatter.h"

#include "closed_loop/model/gravel_directions.h"
#include "closed_loop/model/packings.h"
#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_FREEDOM = 12 };

static const double least_factor = 0.4;
static const double most_factor  = 2.5;

// Of neighbouring bins of a channel, where a table has too few packings to pool: what makes its
// packings likeliest, and the first where it has none.
static const double correlations[] = { 0.5, 0.7, 0.8, 0.9, 0.95, 0.98 };

double dig_scatter_factor(const struct dig_scatter *const scatter, const size_t trajectory,
                          const double strength)
{
    const double factor =
        1.0 + scatter->slope[trajectory] * (strength - scatter->strength[trajectory]);
    return fmin(fmax(factor, least_factor), most_factor);
}

// The L of S with its floor, in place.
static enum dig_status decompose(double s[DIG_FEATURES][DIG_FEATURES])
{
    dig_packings_add_floor(s);
    return dig_cholesky(DIG_FEATURES, &s[0][0]);
}

// Fits the factor: sizes of residuals over strength, weighted by their freedom.
static enum dig_status fit_factor(struct dig_scatter *const scatter, const size_t t, const size_t n,
                                  struct dig_packing packing[])
{
    double s[DIG_FEATURES][DIG_FEATURES];
    (void)dig_packings_pool(n, packing, DIG_PACKINGS_FOLDS, s);
    if (decompose(s) != DIG_OK) {
        return DIG_EINVAL;
    }
    double sum[5] = { 0.0 }; // weight, x, y, xx, xy
    for (size_t i = 0; i < n; i++) {
        const double w = packing[i].freedom;
        const double y = dig_packing_size((const double(*)[DIG_FEATURES])s, &packing[i]);
        const double x = packing[i].of->strength;
        sum[0] += w;
        sum[1] += w * x;
        sum[2] += w * y;
        sum[3] += w * x * x;
        sum[4] += w * x * y;
    }
    const double mean_x  = sum[1] / sum[0];
    const double mean_y  = sum[2] / sum[0];
    const double xx      = sum[3] / sum[0] - mean_x * mean_x;
    const double xy      = sum[4] / sum[0] - mean_x * mean_y;
    scatter->strength[t] = mean_x;
    scatter->slope[t]    = xx > 1e-6 ? xy / xx / mean_y : 0.0;
    for (size_t i = 0; i < n; i++) {
        packing[i].factor = dig_scatter_factor(scatter, t, packing[i].of->strength);
    }
    return DIG_OK;
}

// Variance of digs over that of one dig, in all directions and in those of other gravels.
struct variance {
    double all, as_gravels;
};

// Variance of the digs of folds [from, to), each over an S that its fold took no part in; of fold
// DIG_PACKINGS_FOLDS: of all digs over the S of all.
static struct variance variance_over(const struct dig_response_surface *const surface,
                                     const size_t t, const size_t n,
                                     const struct dig_packing packing[], const size_t from,
                                     const size_t to)
{
    struct variance sum     = { 0.0, 0.0 };
    double          freedom = 0.0;
    for (size_t fold = from; fold < to; fold++) {
        double s[DIG_FEATURES][DIG_FEATURES];
        if (dig_packings_pool(n, packing, fold, s) < 1.0 || decompose(s) != DIG_OK) {
            continue;
        }
        for (size_t i = 0; i < n; i++) {
            if (packing[i].fold == fold || fold == DIG_PACKINGS_FOLDS) {
                const double(*const lower)[DIG_FEATURES] = (const double(*)[DIG_FEATURES])s;
                const double weight                      = packing[i].freedom / packing[i].factor;
                sum.all += weight * dig_packing_size(lower, &packing[i]);
                sum.as_gravels += weight / packing[i].freedom *
                                  dig_gravel_directions_variance(surface, t, packing[i].of->place,
                                                                 lower, packing[i].of->value);
                freedom += packing[i].freedom;
            }
        }
    }
    return freedom > 0.0 ? (struct variance){ sum.all / freedom, sum.as_gravels / freedom }
                         : (struct variance){ 1.0, 1.0 };
}

// A residual is smaller against an S it took part in than a campaign's dig is: larger makes it one.
static enum dig_status keep_residuals(struct dig_scatter *const scatter, const size_t t,
                                      const size_t n, const struct dig_packing packing[],
                                      const double larger)
{
    scatter->residual[t] = malloc((n + 1) * sizeof *scatter->residual[t]);
    if (scatter->residual[t] == NULL) {
        return DIG_ENOMEM;
    }
    scatter->residuals[t] = n;
    for (size_t i = 0; i < n; i++) {
        const struct dig_scatter_residual *const r = packing[i].of;

        const double scale = sqrt(larger / (packing[i].freedom * packing[i].factor));
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            scatter->residual[t][i][f] = scale * r->value[f];
        }
    }
    return DIG_OK;
}

static enum dig_status pool_trajectory(const struct dig_response_surface *const surface,
                                       struct dig_scatter *const scatter, const size_t t,
                                       const size_t n, struct dig_packing packing[])
{
    enum dig_status status = fit_factor(scatter, t, n, packing);
    if (status != DIG_OK) {
        return status;
    }
    (void)dig_packings_pool(n, packing, DIG_PACKINGS_FOLDS, scatter->covariance[t]);
    const struct variance held_out = variance_over(surface, t, n, packing, 0, DIG_PACKINGS_FOLDS);
    const struct variance taken_part =
        variance_over(surface, t, n, packing, DIG_PACKINGS_FOLDS, DIG_PACKINGS_FOLDS + 1);
    scatter->widened[t]    = fmax(held_out.all, 1.0);
    scatter->as_gravels[t] = fmax(held_out.as_gravels / scatter->widened[t] - 1.0, 0.0);
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            scatter->covariance[t][i][j] *= scatter->widened[t];
        }
    }
    dig_packings_add_floor(scatter->covariance[t]);
    memcpy(scatter->lower[t], scatter->covariance[t], sizeof scatter->lower[t]);
    status = dig_cholesky(DIG_FEATURES, &scatter->lower[t][0][0]);
    if (status != DIG_OK) {
        return status;
    }
    return keep_residuals(scatter, t, n, packing,
                          fmax(held_out.all / fmax(taken_part.all, 1e-3), 1.0));
}

// Variances of the table's curves, the mean of all entries.
static void variances_of(const struct dig_response_surface *const surface, const size_t t,
                         double variance[DIG_FEATURES])
{
    const struct dig_curve_set *const set     = surface->set;
    double                            entries = 0.0;
    memset(variance, 0, DIG_FEATURES * sizeof variance[0]);
    for (size_t e = 0; e < set->entries; e++) {
        const struct dig_curve *const curve = &set->curve[e * set->trajectories + t];
        if (set->packings[e * set->trajectories + t] <= 0) {
            continue;
        }
        double place[DIG_AXES];
        double feature[DIG_FEATURES];
        double amplitude[DIG_FORCE_CHANNELS];
        dig_response_surface_place(surface, &set->gravel[e], place);
        dig_response_surface_features(surface, t, place, feature, amplitude);
        dig_features_of_table(curve->sd, feature);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            variance[f] += pow(feature[f] / amplitude[f / DIG_FEATURE_BINS], 2.0);
        }
        entries += 1.0;
    }
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        variance[f] /= fmax(entries, 1.0);
    }
}

static void correlate(const double variance[DIG_FEATURES], const double correlation,
                      double s[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            const bool   same = i / DIG_FEATURE_BINS == j / DIG_FEATURE_BINS;
            const double away = fabs((double)i - (double)j);
            s[i][j] = same ? sqrt(variance[i] * variance[j]) * pow(correlation, away) : 0.0;
        }
    }
    dig_packings_add_floor(s);
}

// Of a trajectory's residuals, -2 log: as many independent digs as degrees of freedom.
static double misfit_of(const double s[DIG_FEATURES][DIG_FEATURES], const size_t n,
                        const struct dig_packing packing[])
{
    double lower[DIG_FEATURES][DIG_FEATURES];
    double sum = 0.0;
    memcpy(lower, s, sizeof lower);
    if (dig_cholesky(DIG_FEATURES, &lower[0][0]) != DIG_OK) {
        return INFINITY;
    }
    const double log_det = dig_lower_log_det(DIG_FEATURES, &lower[0][0]);
    for (size_t i = 0; i < n; i++) {
        sum += packing[i].freedom *
               (log_det +
                DIG_FEATURES * dig_packing_size((const double(*)[DIG_FEATURES])lower, &packing[i]));
    }
    return sum;
}

// S from the standard deviations of the table's curves, with the correlation that suits the few
// packings best.
static void assume(const struct dig_response_surface *const surface, const size_t t, const size_t n,
                   const struct dig_packing packing[], struct dig_scatter *const scatter)
{
    double variance[DIG_FEATURES];
    double best = INFINITY;
    variances_of(surface, t, variance);
    for (size_t i = 0; i < sizeof correlations / sizeof correlations[0]; i++) {
        double s[DIG_FEATURES][DIG_FEATURES];
        correlate(variance, correlations[i], s);
        const double misfit = misfit_of((const double(*)[DIG_FEATURES])s, n, packing);
        if (i == 0 || misfit < best) {
            best = misfit;
            memcpy(scatter->covariance[t], s, sizeof s);
        }
    }
    scatter->slope[t]      = 0.0;
    scatter->widened[t]    = 1.0;
    scatter->as_gravels[t] = 0.0;
}

enum dig_status dig_scatter_pool(const struct dig_response_surface *const surface,
                                 const size_t                             residuals,
                                 const struct dig_scatter_residual        residual[],
                                 struct dig_scatter **const               scatter)
{
    assert(surface != NULL && scatter != NULL);
    struct dig_scatter *const made    = calloc(1, sizeof *made);
    struct dig_packing *const packing = malloc((residuals + 1) * sizeof *packing);
    enum dig_status           status  = made != NULL && packing != NULL ? DIG_OK : DIG_ENOMEM;
    for (size_t t = 0; status != DIG_ENOMEM && t < surface->set->trajectories; t++) {
        if (!surface->known[t]) {
            continue;
        }
        const size_t n = dig_packings_take(t, residuals, residual, packing);
        for (size_t i = 0; i < n; i++) {
            made->freedom[t] += packing[i].freedom;
        }
        status = made->freedom[t] >= LEAST_FREEDOM ? pool_trajectory(surface, made, t, n, packing)
                                                   : DIG_EINVAL;
        if (status == DIG_EINVAL) {
            assume(surface, t, n, packing, made);
        }
    }
    free(packing);
    if (status == DIG_ENOMEM) {
        dig_scatter_destroy(made);
        return status;
    }
    *scatter = made;
    return DIG_OK;
}

void dig_scatter_as_gravels(const struct dig_scatter *const scatter, const size_t trajectory,
                            double of[DIG_AXES][DIG_FEATURES])
{
    assert(scatter != NULL && of != NULL);
    const double(*const lower)[DIG_FEATURES] = scatter->lower[trajectory];
    const double sigma                       = sqrt(scatter->as_gravels[trajectory]);
    if (!(sigma > 0.0)) {
        memset(of, 0, DIG_AXES * sizeof of[0]);
        return;
    }
    dig_gravel_directions_whiten(lower, of);
    for (size_t a = 0; a < DIG_AXES; a++) {
        dig_lower_multiply(DIG_FEATURES, &lower[0][0], of[a]);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            of[a][f] *= sigma;
        }
    }
}

void dig_scatter_destroy(struct dig_scatter *const scatter)
{
    if (scatter == NULL) {
        return;
    }
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        free(scatter->residual[t]);
    }
    free(scatter);
}
