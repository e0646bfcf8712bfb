#include "closed_loop/model/packings.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How far S is drawn towards a covariance whose correlations depend on the distance of two bins
// alone (and are this much smaller, so that it stays positive definite). Of 0.1 ... 0.9 the
// held-out likelihood of the packings of a table with 49 degrees of freedom is best at 0.1 ... 0.3,
// and better by 0.1 to 0.2 a feature than when drawn towards the diagonal by any share.
static const double towards_even   = 0.25;
static const double even_reduction = 0.95;

size_t dig_packings_take(const size_t trajectory, const size_t residuals,
                         const struct dig_scatter_residual residual[], struct dig_packing packing[])
{
    assert(packing != NULL);
    enum { FOLDS = DIG_PACKINGS_FOLDS };
    size_t count = 0;
    for (size_t i = 0; i < residuals; i++) {
        const struct dig_scatter_residual *const r = &residual[i];
        if (r->trajectory == trajectory && r->packings > 1) {
            // Of an entry with few packings all residuals are held out together: about their mean
            // they know of each other. Those of an entry with many are held out in turn: it may be
            // most of the table.
            const size_t in_turn = r->packings >= FOLDS / 2 ? i : r->entry;
            packing[count++] =
                (struct dig_packing){ r, 1.0 - 1.0 / (double)r->packings, 1.0, in_turn % FOLDS };
        }
    }
    return count;
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

double dig_packings_pool(const size_t packings, const struct dig_packing packing[],
                         const size_t without, double s[DIG_FEATURES][DIG_FEATURES])
{
    assert(packing != NULL && s != NULL);
    memset(s, 0, DIG_FEATURES * sizeof s[0]);
    double freedom = 0.0;
    for (size_t m = 0; m < packings; m++) {
        if (packing[m].fold == without) {
            continue;
        }
        const double *const value  = packing[m].of->value;
        const double        weight = 1.0 / packing[m].factor;
        for (size_t i = 0; i < DIG_FEATURES; i++) {
            for (size_t j = 0; j < DIG_FEATURES; j++) {
                s[i][j] += weight * value[i] * value[j];
            }
        }
        freedom += packing[m].freedom;
    }
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        for (size_t j = 0; j < DIG_FEATURES; j++) {
            s[i][j] /= fmax(freedom, 1.0);
        }
    }
    draw_towards_even(s);
    return freedom;
}

void dig_packings_add_floor(double s[DIG_FEATURES][DIG_FEATURES])
{
    assert(s != NULL);
    for (size_t i = 0; i < DIG_FEATURES; i++) {
        s[i][i] += DIG_SCATTER_FLOOR * DIG_SCATTER_FLOOR;
    }
}

double dig_packing_size(const double                    lower[DIG_FEATURES][DIG_FEATURES],
                        const struct dig_packing *const packing)
{
    double whitened[DIG_FEATURES];
    memcpy(whitened, packing->of->value, sizeof whitened);
    dig_lower_solve(DIG_FEATURES, &lower[0][0], whitened);
    return dig_product(DIG_FEATURES, whitened, whitened) / DIG_FEATURES / packing->freedom;
}
