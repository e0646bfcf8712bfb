// Whether digs drift from first to last as wear is taken to, by the same share from one to the
// next.
//
// Of every dig the size that it has over the gravel's without wear, f = <y, m> / <m, m>, with a
// variance of 1 / <m, m>, is fitted by a line and by a parabola in the digs' order; what the digs
// of one trajectory share counts as its own unknown. A strength that grows and comes to rest, or
// steps once, is a drift, too, but of something else than a tooth, and a line through it overshoots
// the next dig.

#include "closed_loop/numeric/dense.h"
#include "closed_loop/search/search_work.h"

#include <assert.h>
#include <math.h>

// A constant, the line's and the parabola's term, and one number for every trajectory.
enum { POLYNOMIAL = 3, UNKNOWNS = POLYNOMIAL + DIG_TRAJECTORY_MAX };

// Digs that tell a parabola from their scatter at all.
static const size_t least_digs = 5;

// A bend is free to be what it likes.
static const double wide = 1e3;

struct sizes {
    size_t digs;
    double order[DIG_MEASURED_MAX];  // 0 at the first of the batch, 1 at the last
    double factor[DIG_MEASURED_MAX]; // the dig's size over that of its gravel without wear
    double weight[DIG_MEASURED_MAX]; // 1 / variance
    size_t group[DIG_MEASURED_MAX];
    double shared[DIG_TRAJECTORY_MAX]; // variance of what a trajectory's digs have in common
};

// A dig's size over that of its group's mean dig, whose scatter is 1: a larger one scatters more.
static double worn(const struct dig_whitened_digs *const batch, const double share,
                   const struct dig_whitened_digs_dig *const dig)
{
    double mean = 0.0;
    for (size_t i = 0; i < batch->digs; i++) {
        if (batch->dig[i].group == dig->group) {
            mean += (1.0 + share * (double)batch->measured[batch->dig[i].measured].order) /
                    (double)batch->group[dig->group].digs;
        }
    }
    return (1.0 + share * (double)batch->measured[dig->measured].order) / mean;
}

static void measure(const struct dig_whitened_digs *const batch,
                    const struct dig_fitted *const fitted, const size_t wear,
                    struct sizes *const sizes)
{
    struct dig_fitted fresh      = *fitted;
    double            first      = INFINITY;
    double            last       = -INFINITY;
    fresh.number[DIG_AT_U(wear)] = 0.0;
    sizes->digs                  = batch->digs;
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_whitened_digs_dig *const   dig   = &batch->dig[i];
        const struct dig_whitened_digs_group *const group = &batch->group[dig->group];
        double                                      model[DIG_FEATURES];
        dig_fitted_whitened(batch, &fresh, dig->group, &batch->measured[dig->measured], model);
        const double own = dig_product(group->features, model, model);
        sizes->factor[i] = dig_product(group->features, dig->y, model) / own;
        sizes->weight[i] = own / pow(worn(batch, fitted->number[DIG_AT_U(wear)], dig), 2.0);
        sizes->group[i]  = dig->group;

        sizes->shared[dig->group] = fitted->noise[dig->group] / own;
        sizes->order[i]           = (double)batch->measured[dig->measured].order;
        first                     = fmin(first, sizes->order[i]);
        last                      = fmax(last, sizes->order[i]);
    }
    const double span = fmax(last - first, 1.0);
    for (size_t i = 0; i < sizes->digs; i++) {
        sizes->order[i] = (sizes->order[i] - first) / span;
    }
}

// The parabola's own term over its sigma.
static double bend(const struct sizes *const sizes, const size_t groups)
{
    const size_t n                      = POLYNOMIAL + groups;
    const size_t last                   = POLYNOMIAL - 1;
    double       a[UNKNOWNS * UNKNOWNS] = { 0.0 };
    double       b[UNKNOWNS]            = { 0.0 };
    double       one[UNKNOWNS]          = { 0.0 };
    for (size_t i = 0; i < sizes->digs; i++) {
        double row[UNKNOWNS] = { 0.0 };
        for (size_t p = 0; p < POLYNOMIAL; p++) {
            row[p] = pow(sizes->order[i], (double)p);
        }
        row[POLYNOMIAL + sizes->group[i]] = 1.0;
        for (size_t p = 0; p < n; p++) {
            b[p] += sizes->weight[i] * row[p] * sizes->factor[i];
            for (size_t q = 0; q <= p; q++) {
                a[p * n + q] += sizes->weight[i] * row[p] * row[q];
            }
        }
    }
    for (size_t p = 0; p < n; p++) {
        a[p * n + p] += p < POLYNOMIAL ? 1.0 / (wide * wide) : 1.0 / sizes->shared[p - POLYNOMIAL];
    }
    if (dig_cholesky(n, a) != DIG_OK) {
        return 0.0;
    }
    one[last] = 1.0;
    dig_cholesky_solve(n, a, b);
    dig_cholesky_solve(n, a, one);
    return b[last] / sqrt(one[last]);
}

double dig_drift_bend(const struct dig_whitened_digs *const batch,
                      const struct dig_fitted *const        fitted)
{
    assert(batch != NULL && fitted != NULL);
    const struct dig_hypothesis *const by = &fitted->hypothesis;
    const size_t wear  = dig_effect_place(by->effects, by->effect, DIG_EFFECT_WEAR);
    struct sizes sizes = { .digs = 0 };
    if (wear == by->effects || batch->digs < least_digs) {
        return 0.0;
    }
    measure(batch, fitted, wear, &sizes);
    return bend(&sizes, batch->groups);
}
