#include "closed_loop/fit/common_error.h"

#include "closed_loop/numeric/dense.h"
#include "closed_loop/numeric/vectors.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How far along the dig, in bins, each part's factor stays alike, and how alike it is on two
// channels.
static const double alike_bins[DIG_COMMON_ERROR_PARTS] = { 2.5, 2.5, 0.7, 2.5 };
static const double alike_channels                     = 0.7;

// R of a part between two features that lie so many bins apart on one channel. The ridge keeps it
// positive definite.
struct likeness {
    double along[DIG_FEATURE_BINS];
};

static struct likeness likeness_of(const size_t part)
{
    struct likeness r;
    for (size_t apart = 0; apart < DIG_FEATURE_BINS; apart++) {
        r.along[apart] = exp(-0.5 * pow((double)apart / alike_bins[part], 2.0));
    }
    return r;
}

static double likeness(const struct likeness *const r, const size_t a, const size_t b)
{
    static const double ridge = 1e-6;
    const size_t        i     = a % DIG_FEATURE_BINS;
    const size_t        j     = b % DIG_FEATURE_BINS;
    const bool          same  = a / DIG_FEATURE_BINS == b / DIG_FEATURE_BINS;
    return (same ? 1.0 : alike_channels) * r->along[i > j ? i - j : j - i] + (a == b ? ridge : 0.0);
}

// True where a part has no size at all: what has no name in a hypothesis of effects, say.
static bool is_none(const double size[DIG_FEATURES])
{
    bool none = true;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        none = none && fabs(size[f]) <= 0.0;
    }
    return none;
}

// The smooth part's covariance, units of the table.
static void smooth_part(const struct dig_whitened_digs_group *const group,
                        const struct dig_common_error *const error, double k[])
{
    const size_t n = group->features;
    memset(k, 0, n * n * sizeof k[0]);
    for (size_t p = 0; p < DIG_COMMON_ERROR_PARTS; p++) {
        const struct likeness r = likeness_of(p);
        for (size_t i = 0; i < n && !is_none(error->size[p]); i++) {
            for (size_t j = 0; j <= i; j++) {
                const size_t a = group->feature[i];
                const size_t b = group->feature[j];
                k[i * n + j] += error->size[p][a] * error->size[p][b] * likeness(&r, a, b);
                k[j * n + i] = k[i * n + j];
            }
        }
    }
}

static void add_shifts(const struct dig_whitened_digs_group *const group,
                       const struct dig_common_error *const error, double k[])
{
    const size_t n = group->features;
    for (size_t s = 0; s < error->shift.shifts; s++) {
        const double *const shift = error->shift.of[s];
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                k[i * n + j] += shift[group->feature[i]] * shift[group->feature[j]];
            }
        }
    }
}

// Overwrites the lower triangle of k with that of W k W'; whiten[i] adds nothing to y before y[i].
DIG_VECTORS static void whiten_both(const struct dig_whitened_digs_group *const group, double k[])
{
    const size_t n = group->features;
    double       half[DIG_FEATURES * DIG_FEATURES]; // W k
    memset(half, 0, n * n * sizeof half[0]);
    for (size_t i = 0; i < n; i++) {
        for (size_t r = i; r < n; r++) {
            for (size_t j = 0; j < n; j++) {
                half[r * n + j] += group->whiten[i][r] * k[i * n + j];
            }
        }
    }
    memset(k, 0, n * n * sizeof k[0]);
    for (size_t j = 0; j < n; j++) {
        for (size_t r = j; r < n; r++) {
            for (size_t c = j; c <= r; c++) {
                k[r * n + c] += half[r * n + j] * group->whiten[j][c];
            }
        }
    }
}

void dig_common_error_build(const struct dig_whitened_digs_group *const group,
                            struct dig_common_error *const              error)
{
    assert(group != NULL && error != NULL);
    const size_t n     = group->features;
    double       trace = 0.0;
    double       covariance[DIG_FEATURES * DIG_FEATURES];
    smooth_part(group, error, covariance);
    add_shifts(group, error, covariance);
    whiten_both(group, covariance);
    for (size_t i = 0; i < n; i++) {
        trace += covariance[i * n + i] / (double)n;
        covariance[i * n + i] += 1.0 / (double)group->digs + error->even;
    }
    error->noise = error->even + trace;
    // Positive definite by what is on its diagonal.
    const enum dig_status status = dig_cholesky(n, covariance);
    assert(status == DIG_OK);
    (void)status;
    error->log_det = dig_lower_log_det(n, covariance);
    dig_lower_invert(n, covariance, error->inverse);
}

double dig_common_error_of_approaches(const struct dig_whitened_digs_group *const group)
{
    struct dig_common_error only = { .even = group->added_noise };
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        only.size[3][f] = group->added_error[f];
    }
    if (!(group->added_noise > 0.0)) {
        return 0.0;
    }
    dig_common_error_build(group, &only);
    return only.noise;
}

double dig_common_error_squares(const struct dig_whitened_digs_group *const group,
                                const struct dig_common_error *const error, double residual[])
{
    double sum = 0.0;
    dig_lower_multiply(group->features, error->inverse, residual);
    for (size_t k = 0; k < group->features; k++) {
        sum += residual[k] * residual[k];
    }
    return sum;
}

void dig_common_error_draw(const struct dig_whitened_digs_group *const group,
                           const struct dig_common_error *const error, uint64_t *const seed,
                           double y[DIG_FEATURES])
{
    double feature[DIG_FEATURES] = { 0.0 };
    for (size_t p = 0; p < DIG_COMMON_ERROR_PARTS; p++) {
        double                lower[DIG_FEATURES * DIG_FEATURES];
        double                factor[DIG_FEATURES];
        const struct likeness r = likeness_of(p);
        if (is_none(error->size[p])) {
            continue;
        }
        for (size_t a = 0; a < DIG_FEATURES; a++) {
            factor[a] = dig_chance_normal(seed);
            for (size_t b = 0; b <= a; b++) {
                lower[a * DIG_FEATURES + b] = likeness(&r, a, b);
            }
        }
        const enum dig_status status = dig_cholesky(DIG_FEATURES, lower);
        assert(status == DIG_OK);
        (void)status;
        dig_lower_multiply(DIG_FEATURES, lower, factor);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += error->size[p][f] * factor[f];
        }
    }
    for (size_t s = 0; s < error->shift.shifts; s++) {
        const double by = dig_chance_normal(seed);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += by * error->shift.of[s][f];
        }
    }
    dig_whitened_digs_whiten(group, feature, y);
}
