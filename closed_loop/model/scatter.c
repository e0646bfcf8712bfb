#include "closed_loop/model/scatter.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FOLDS = 10, LEAST_FREEDOM = 12 };

// How far S is drawn towards a covariance whose correlations depend on the distance of two bins
// alone (and are this much smaller, so that it stays positive definite). Of 0.1 ... 0.9 the
// held-out likelihood of the packings of a table with 49 degrees of freedom is best at 0.1 ... 0.3,
// and better by 0.1 to 0.2 a feature than when drawn towards the diagonal by any share.
static const double towards_even   = 0.25;
static const double even_reduction = 0.95;

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

// Sums the pairs of one residual. Its share of a degree of freedom is 1 - 1 / packings.
static void add_pairs(const struct dig_scatter_residual *const r, const double weight,
                      double sum[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            sum[i][j] += weight * r->value[i] * r->value[j];
        }
    }
}

static double freedom_of(const struct dig_scatter_residual *const r)
{
    return 1.0 - 1.0 / (double)r->packings;
}

// Of an entry with few packings all residuals are held out together: about their mean they know of
// each other. Those of an entry with many are held out in turn: it may be most of the table.
static size_t fold_of(const struct dig_scatter_residual *const r, const size_t index)
{
    return (r->packings >= FOLDS / 2 ? index : r->entry) % FOLDS;
}

// Mean correlation of all pairs of bins of two channels that are lag apart.
static double mean_correlation(const double s[DIG_FEATURES][DIG_FEATURES], const size_t one,
                               const size_t other, const int lag)
{
    double sum = 0.0;
    double n   = 0.0;
    for (int b = 0; b < DIG_FEATURE_BINS; b++) {
        const int to = b + lag;
        if (to < 0 || to >= DIG_FEATURE_BINS) {
            continue;
        }
        const size_t i       = one * DIG_FEATURE_BINS + (size_t)b;
        const size_t j       = other * DIG_FEATURE_BINS + (size_t)to;
        const double product = s[i][i] * s[j][j];
        sum += product > 0.0 ? s[i][j] / sqrt(product) : 0.0;
        n += 1.0;
    }
    return sum / n;
}

// Draws S towards even correlations; variances stay.
static void draw_towards_even(double s[DIG_FEATURES][DIG_FEATURES])
{
    double drawn[DIG_FEATURES][DIG_FEATURES];
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            const int    lag  = (int)(j % DIG_FEATURE_BINS) - (int)(i % DIG_FEATURE_BINS);
            const double even = even_reduction * sqrt(s[i][i] * s[j][j]) *
                                mean_correlation((const double(*)[DIG_FEATURES])s,
                                                 i / DIG_FEATURE_BINS, j / DIG_FEATURE_BINS, lag);
            drawn[i][j] = i == j ? s[i][i] : (1.0 - towards_even) * s[i][j] + towards_even * even;
        }
    }
    memcpy(s, drawn, sizeof drawn);
}

// S of the residuals of one trajectory, without those of one fold (fold FOLDS: of all),
// each over its factor.
static double pool(const struct dig_scatter *const scatter, const size_t t, const size_t n,
                   const struct dig_scatter_residual r[], const size_t without,
                   double s[DIG_FEATURES][DIG_FEATURES])
{
    memset(s, 0, DIG_FEATURES * sizeof s[0]);
    double freedom = 0.0;
    for (size_t i = 0; i < n; i++) {
        if (r[i].trajectory == t && r[i].packings > 1 && fold_of(&r[i], i) != without) {
            add_pairs(&r[i], 1.0 / dig_scatter_factor(scatter, t, r[i].strength), s);
            freedom += freedom_of(&r[i]);
        }
    }
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            s[i][j] /= fmax(freedom, 1.0);
        }
    }
    draw_towards_even(s);
    return freedom;
}

static void add_floor(double s[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        s[i][i] += DIG_SCATTER_FLOOR * DIG_SCATTER_FLOOR;
    }
}

// Variance of a residual over that of one dig, averaged over the directions S knows.
static double size_of(const double                             lower[DIG_FEATURES][DIG_FEATURES],
                      const struct dig_scatter_residual *const r)
{
    double whitened[DIG_FEATURES];
    memcpy(whitened, r->value, sizeof whitened);
    dig_lower_solve(DIG_FEATURES, &lower[0][0], whitened);
    double sum = 0.0;
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        sum += whitened[i] * whitened[i];
    }
    return sum / DIG_FEATURES / freedom_of(r);
}

// Fits the factor: sizes of residuals over strength, weighted by their freedom.
static enum dig_status fit_factor(struct dig_scatter *const scatter, const size_t t, const size_t n,
                                  const struct dig_scatter_residual r[])
{
    double s[DIG_FEATURES][DIG_FEATURES];
    (void)pool(scatter, t, n, r, FOLDS, s);
    add_floor(s);
    if (dig_cholesky(DIG_FEATURES, &s[0][0]) != DIG_OK) {
        return DIG_EINVAL;
    }
    double sum[5] = { 0.0 }; // weight, x, y, xx, xy
    for (size_t i = 0; i < n; i++) {
        if (r[i].trajectory == t && r[i].packings > 1) {
            const double w = freedom_of(&r[i]);
            const double y = size_of((const double(*)[DIG_FEATURES])s, &r[i]);
            const double x = r[i].strength;
            sum[0] += w;
            sum[1] += w * x;
            sum[2] += w * y;
            sum[3] += w * x * x;
            sum[4] += w * x * y;
        }
    }
    const double mean_x  = sum[1] / sum[0];
    const double mean_y  = sum[2] / sum[0];
    const double xx      = sum[3] / sum[0] - mean_x * mean_x;
    const double xy      = sum[4] / sum[0] - mean_x * mean_y;
    scatter->strength[t] = mean_x;
    scatter->slope[t]    = xx > 1e-6 ? xy / xx / mean_y : 0.0;
    return DIG_OK;
}

// Variance of digs over an S they took part in.
static double taken_part(const struct dig_scatter *const scatter, const size_t t, const size_t n,
                         const struct dig_scatter_residual r[])
{
    double s[DIG_FEATURES][DIG_FEATURES];
    double sum     = 0.0;
    double freedom = 0.0;
    (void)pool(scatter, t, n, r, FOLDS, s);
    add_floor(s);
    if (dig_cholesky(DIG_FEATURES, &s[0][0]) != DIG_OK) {
        return 1.0;
    }
    for (size_t i = 0; i < n; i++) {
        if (r[i].trajectory == t && r[i].packings > 1) {
            sum += freedom_of(&r[i]) * size_of((const double(*)[DIG_FEATURES])s, &r[i]) /
                   dig_scatter_factor(scatter, t, r[i].strength);
            freedom += freedom_of(&r[i]);
        }
    }
    return freedom > 0.0 ? sum / freedom : 1.0;
}

// Variance of digs over an S they took no part in, averaged over folds.
static double held_out(const struct dig_scatter *const scatter, const size_t t, const size_t n,
                       const struct dig_scatter_residual r[])
{
    double sum     = 0.0;
    double freedom = 0.0;
    for (size_t fold = 0; fold < FOLDS; fold++) {
        double s[DIG_FEATURES][DIG_FEATURES];
        if (pool(scatter, t, n, r, fold, s) < 1.0) {
            continue;
        }
        add_floor(s);
        if (dig_cholesky(DIG_FEATURES, &s[0][0]) != DIG_OK) {
            continue;
        }
        for (size_t i = 0; i < n; i++) {
            if (r[i].trajectory == t && r[i].packings > 1 && fold_of(&r[i], i) == fold) {
                sum += freedom_of(&r[i]) * size_of((const double(*)[DIG_FEATURES])s, &r[i]) /
                       dig_scatter_factor(scatter, t, r[i].strength);
                freedom += freedom_of(&r[i]);
            }
        }
    }
    return freedom > 0.0 ? sum / freedom : 1.0;
}

// A residual is smaller against an S it took part in than a campaign's dig is: larger makes it one.
static enum dig_status keep_residuals(struct dig_scatter *const scatter, const size_t t,
                                      const size_t n, const struct dig_scatter_residual r[],
                                      const double larger)
{
    scatter->residual[t] = malloc((n + 1) * sizeof *scatter->residual[t]);
    if (scatter->residual[t] == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        if (r[i].trajectory != t || r[i].packings < 2) {
            continue;
        }
        const double scale =
            sqrt(larger / (freedom_of(&r[i]) * dig_scatter_factor(scatter, t, r[i].strength)));
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            scatter->residual[t][scatter->residuals[t]][f] = scale * r[i].value[f];
        }
        scatter->residuals[t]++;
    }
    return DIG_OK;
}

static enum dig_status pool_trajectory(struct dig_scatter *const scatter, const size_t t,
                                       const size_t n, const struct dig_scatter_residual r[])
{
    enum dig_status status = fit_factor(scatter, t, n, r);
    if (status != DIG_OK) {
        return status;
    }
    (void)pool(scatter, t, n, r, FOLDS, scatter->covariance[t]);
    const double held_out_size = held_out(scatter, t, n, r);
    const double larger = fmax(held_out_size / fmax(taken_part(scatter, t, n, r), 1e-3), 1.0);
    scatter->widened[t] = fmax(held_out_size, 1.0);
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            scatter->covariance[t][i][j] *= scatter->widened[t];
        }
    }
    add_floor(scatter->covariance[t]);
    return keep_residuals(scatter, t, n, r, larger);
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
        double sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double feature[DIG_FEATURES];
        double amplitude[DIG_FORCE_CHANNELS];
        dig_response_surface_place(surface, &set->gravel[e], place);
        dig_response_surface_features(surface, t, place, feature, amplitude);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                sd[c][k] = (double)curve->sd[c][k];
            }
        }
        dig_features_of((const double(*)[DIG_CURVE_POINTS])sd, feature);
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
    add_floor(s);
}

// Of the residuals of one trajectory, -2 log: as many independent digs as degrees of freedom.
static double misfit_of(const double s[DIG_FEATURES][DIG_FEATURES], const size_t t, const size_t n,
                        const struct dig_scatter_residual r[])
{
    double lower[DIG_FEATURES][DIG_FEATURES];
    double sum = 0.0;
    memcpy(lower, s, sizeof lower);
    if (dig_cholesky(DIG_FEATURES, &lower[0][0]) != DIG_OK) {
        return INFINITY;
    }
    const double log_det = dig_lower_log_det(DIG_FEATURES, &lower[0][0]);
    for (size_t i = 0; i < n; i++) {
        if (r[i].trajectory == t && r[i].packings > 1) {
            sum += freedom_of(&r[i]) *
                   (log_det + DIG_FEATURES * size_of((const double(*)[DIG_FEATURES])lower, &r[i]));
        }
    }
    return sum;
}

// S from the standard deviations of the table's curves, with the correlation that suits the few
// packings best.
static void assume(const struct dig_response_surface *const surface, const size_t t, const size_t n,
                   const struct dig_scatter_residual r[], struct dig_scatter *const scatter)
{
    double variance[DIG_FEATURES];
    double best = INFINITY;
    variances_of(surface, t, variance);
    for (size_t i = 0; i < sizeof correlations / sizeof correlations[0]; i++) {
        double s[DIG_FEATURES][DIG_FEATURES];
        correlate(variance, correlations[i], s);
        const double misfit = misfit_of((const double(*)[DIG_FEATURES])s, t, n, r);
        if (i == 0 || misfit < best) {
            best = misfit;
            memcpy(scatter->covariance[t], s, sizeof s);
        }
    }
    scatter->slope[t]   = 0.0;
    scatter->widened[t] = 1.0;
}

static double freedom_along(const size_t t, const size_t n, const struct dig_scatter_residual r[])
{
    double freedom = 0.0;
    for (size_t i = 0; i < n; i++) {
        freedom += r[i].trajectory == t && r[i].packings > 1 ? freedom_of(&r[i]) : 0.0;
    }
    return freedom;
}

enum dig_status dig_scatter_pool(const struct dig_response_surface *const surface,
                                 const size_t                             residuals,
                                 const struct dig_scatter_residual        residual[],
                                 struct dig_scatter **const               scatter)
{
    assert(surface != NULL && scatter != NULL);
    struct dig_scatter *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t t = 0; t < surface->set->trajectories; t++) {
        if (!surface->known[t]) {
            continue;
        }
        enum dig_status status = DIG_EINVAL;
        made->freedom[t]       = freedom_along(t, residuals, residual);
        if (made->freedom[t] >= LEAST_FREEDOM) {
            status = pool_trajectory(made, t, residuals, residual);
        }
        if (status == DIG_ENOMEM) {
            dig_scatter_destroy(made);
            return status;
        }
        if (status != DIG_OK) {
            assume(surface, t, residuals, residual, made);
        }
    }
    *scatter = made;
    return DIG_OK;
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
