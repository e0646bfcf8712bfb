#include "closed_loop/fit/common_error.h"

#include "closed_loop/numeric/dense.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How far along the dig, in bins, each part's factor stays alike, and how alike it is on two
// channels.
static const double alike_bins[DIG_COMMON_ERROR_PARTS] = { 2.5, 2.5, 0.7, 2.5 };
static const double alike_channels                     = 0.7;

enum { APART = 2 * DIG_FEATURE_BINS - 1 };

// R of a part between two features of one channel and of two, by how many bins the second lies
// behind the first, from as many before it on.
struct likeness {
    double same[APART], other[APART];
};

static struct likeness likeness_of(const size_t part)
{
    struct likeness r;
    for (size_t i = 0; i < DIG_FEATURE_BINS; i++) {
        const double alike                = exp(-0.5 * pow((double)i / alike_bins[part], 2.0));
        const size_t behind               = DIG_FEATURE_BINS - 1 + i;
        r.same[behind]                    = alike;
        r.same[DIG_FEATURE_BINS - 1 - i]  = alike;
        r.other[behind]                   = alike_channels * alike;
        r.other[DIG_FEATURE_BINS - 1 - i] = alike_channels * alike;
    }
    return r;
}

// R between one feature and all. The ridge keeps it positive definite.
static void fill_likeness(const struct likeness *const r, const size_t feature,
                          double row[DIG_FEATURES])
{
    static const double ridge = 1e-6;
    const size_t        from  = DIG_FEATURE_BINS - 1 - feature % DIG_FEATURE_BINS;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        const double *const of = c == feature / DIG_FEATURE_BINS ? r->same : r->other;
        memcpy(&row[c * DIG_FEATURE_BINS], &of[from], DIG_FEATURE_BINS * sizeof row[0]);
    }
    row[feature] += ridge;
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
static inline void add_parts(const struct dig_common_error *const error,
                             double                               k[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t p = 0; p < DIG_COMMON_ERROR_PARTS; p++) {
        const double *const size = error->size[p];
        if (is_none(size)) {
            continue;
        }
        const struct likeness r = likeness_of(p);
        for (size_t a = 0; a < DIG_FEATURES; a++) {
            double row[DIG_FEATURES];
            fill_likeness(&r, a, row);
            for (size_t b = 0; b < DIG_FEATURES; b++) {
                k[a][b] += size[a] * size[b] * row[b];
            }
        }
    }
}

static inline void add_shifts(const struct dig_shifts *const shift,
                              double                         k[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t s = 0; s < shift->shifts; s++) {
        for (size_t a = 0; a < DIG_FEATURES; a++) {
            for (size_t b = 0; b < DIG_FEATURES; b++) {
                k[a][b] += shift->of[s][a] * shift->of[s][b];
            }
        }
    }
}

// Moves the group's features, which ascend, to the front.
static void pick(const struct dig_group *const group, double k[DIG_FEATURES][DIG_FEATURES])
{
    for (size_t i = 0; i < group->features && group->features < DIG_FEATURES; i++) {
        for (size_t j = 0; j < group->features; j++) {
            k[i][j] = k[group->feature[i]][group->feature[j]];
        }
    }
}

// The lower triangle of W k W', row by row; whiten[i] adds nothing to y before y[i].
static inline void whiten_both(const struct dig_group *const group,
                               const double k[DIG_FEATURES][DIG_FEATURES], double whitened[])
{
    const size_t n = group->features;
    for (size_t r = 0; r < n; r++) {
        double w[DIG_FEATURES];
        double half[DIG_FEATURES]; // of W k
        double row[DIG_FEATURES];
        for (size_t i = 0; i <= r; i++) {
            w[i] = group->whiten[i][r];
        }
        for (size_t first = 0; first <= r; first += DIG_ROWS_AT_ONCE) {
            dig_rows_add(r + 1, w, DIG_FEATURES, &k[0][first], &half[first]);
        }
        for (size_t first = 0; first <= r; first += DIG_ROWS_AT_ONCE) {
            const size_t end = first + DIG_ROWS_AT_ONCE;
            dig_rows_add(r < end ? r + 1 : end, half, DIG_FEATURES, &group->whiten[0][first],
                         &row[first]);
        }
        memcpy(whitened + r * n, row, (r + 1) * sizeof row[0]);
    }
}

DIG_VECTORS static void fill_covariance(const struct dig_group *const        group,
                                        const struct dig_common_error *const error,
                                        double                               covariance[])
{
    double k[DIG_FEATURES][DIG_FEATURES] = { { 0.0 } };
    add_parts(error, k);
    add_shifts(&error->shift, k);
    pick(group, k);
    whiten_both(group, (const double(*)[DIG_FEATURES])k, covariance);
}

// What beds differ by as other gravels do.
static void add_as_gravels(const struct dig_group *const  group,
                           const struct dig_shifts *const shift, double covariance[])
{
    const size_t n = group->features;
    for (size_t a = 0; a < DIG_AXES; a++) {
        double y[DIG_FEATURES];
        dig_batch_whiten(group, shift->as_gravels[a], y);
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j <= i; j++) {
                covariance[i * n + j] += y[i] * y[j];
            }
        }
    }
}

void dig_common_error_build(const struct dig_group *const  group,
                            struct dig_common_error *const error)
{
    assert(group != NULL && error != NULL);
    const size_t n     = group->features;
    double       trace = 0.0;
    double       covariance[DIG_FEATURES * DIG_FEATURES];
    fill_covariance(group, error, covariance);
    for (size_t i = 0; i < n; i++) {
        trace += covariance[i * n + i] / (double)n;
        covariance[i * n + i] += 1.0 / (double)group->digs + error->even;
    }
    error->noise = error->even + trace;
    add_as_gravels(group, &error->shift, covariance);
    dig_cholesky_sure(n, covariance); // by what is on its diagonal
    error->log_det = dig_lower_log_det(n, covariance);
    dig_lower_invert(n, covariance, error->inverse);
}

double dig_common_error_of_approaches(const struct dig_group *const group)
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

double dig_common_error_squares(const struct dig_group *const        group,
                                const struct dig_common_error *const error, double residual[])
{
    double sum = 0.0;
    dig_lower_multiply(group->features, error->inverse, residual);
    for (size_t k = 0; k < group->features; k++) {
        sum += residual[k] * residual[k];
    }
    return sum;
}

static void add_drawn(const double sigma[DIG_FEATURES], uint64_t *const seed,
                      double feature[DIG_FEATURES])
{
    const double by = dig_chance_normal(seed);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        feature[f] += by * sigma[f];
    }
}

void dig_common_error_draw(const struct dig_group *const        group,
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
            fill_likeness(&r, a, &lower[a * DIG_FEATURES]);
        }
        dig_cholesky_sure(DIG_FEATURES, lower);
        dig_lower_multiply(DIG_FEATURES, lower, factor);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += error->size[p][f] * factor[f];
        }
    }
    for (size_t s = 0; s < error->shift.shifts; s++) {
        add_drawn(error->shift.of[s], seed, feature);
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        if (!is_none(error->shift.as_gravels[a])) {
            add_drawn(error->shift.as_gravels[a], seed, feature);
        }
    }
    dig_batch_whiten(group, feature, y);
}
