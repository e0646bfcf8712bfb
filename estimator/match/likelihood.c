#include "estimator/match/likelihood.h"

#include "estimator/match/entry_scatter.h"

#include <assert.h>
#include <math.h>

// Loops over points go by strides of this length, counted from 0 and over arrays that are restrict:
// then compilers work on several points at once.
enum { STRIDE = 16 };
enum { COARSE = 9, COARSE_DENSITY = 7 }; // points of an axis
enum { ALL_COARSE = COARSE * COARSE * COARSE_DENSITY };
_Static_assert(DIG_CURVE_POINTS % STRIDE == 0, "whole strides");

// Weight of the pooled spread against an entry's own, in packings.
static const double pooled_weight = 4.0;

// Lower bound of a point's spread, as a share of the table's pooled spread: less is chance.
static const double least_spread = 0.25;

// Keeps variances apart from 0, and products of six of them from the end of the numbers.
static const double least_d = 1e-40;

static const double ln_2 = 0.69314718055994530942;

// Mean and variance of one dig, point by point, of one channel at one gravel.
struct channel_curve {
    double mean[DIG_CURVE_POINTS];
    double spread2[DIG_CURVE_POINTS];
};

static void make_curve(const struct dig_likelihood *const restrict l,
                       const struct dig_cell *const cell, const size_t channel,
                       struct channel_curve *const restrict curve)
{
    const double own    = fmax(1.0 / cell->inverse_packings - 1.0, 0.0);
    const double shared = pooled_weight / (pooled_weight + own);
    dig_cell_blend(cell, (enum dig_channel)channel, curve->mean, curve->spread2);

    double mean2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k += 4) {
        double four[4];
        for (size_t i = 0; i < 4; i++) {
            four[i] = l->measured[k + i] * curve->mean[k + i] * curve->mean[k + i];
        }
        mean2 += (four[0] + four[1]) + (four[2] + four[3]);
    }
    const double relative2 = l->relative2[channel] + cell->error2[channel];
    const double floor2    = least_spread * least_spread * relative2 * mean2 / l->measured_count;
    for (size_t from = 0; from < DIG_CURVE_POINTS; from += STRIDE) {
        for (size_t i = 0; i < STRIDE; i++) {
            const size_t k       = from + i;
            const double sd      = curve->spread2[k];
            const double pooled2 = relative2 * curve->mean[k] * curve->mean[k];
            curve->spread2[k]    = (1.0 - shared) * sd * sd + shared * pooled2 + floor2;
        }
    }
}

// A product as mantissa and exponent: it cannot overflow, and only one logarithm is computed.
struct product {
    double mantissa;
    int    exponent;
};

static inline void multiply(struct product *const product, const double factor)
{
    product->mantissa *= factor;
    if (!(product->mantissa > 1e-60 && product->mantissa < 1e60)) {
        int exponent      = 0;
        product->mantissa = frexp(product->mantissa, &exponent);
        product->exponent += exponent;
    }
}

static double log_of(const struct product *const product)
{
    return log(product->mantissa) + (double)product->exponent * ln_2;
}

// Sum of the misses and of the logarithms of the variances.
static double sum_up(const size_t count, const double miss2[], const double d[])
{
    double         sum     = 0.0;
    struct product product = { 1.0, 0 };
    for (size_t k = 0; k < count; k += 4) {
        sum += (miss2[k] + miss2[k + 1]) + (miss2[k + 2] + miss2[k + 3]);
        multiply(&product, d[k] * d[k + 1]);
        multiply(&product, d[k + 2] * d[k + 3]);
    }
    return sum + log_of(&product);
}

// Normalised misses squared and determinants, point by point. Where nothing was measured the miss
// is 0 and the variance 1.
struct misses {
    double miss2[DIG_CURVE_POINTS];
    double d[DIG_CURVE_POINTS];
};

static void miss_moment(const struct dig_likelihood *const restrict l,
                        const struct dig_cell *const cell, struct misses *const restrict misses)
{
    struct channel_curve moment;
    make_curve(l, cell, DIG_CHANNEL_MY_Nm, &moment);
    for (size_t from = 0; from < DIG_CURVE_POINTS; from += STRIDE) {
        for (size_t i = 0; i < STRIDE; i++) {
            const size_t k       = from + i;
            const double widened = l->inverse_digs[k] + cell->inverse_packings;
            const double d_there = moment.spread2[k] * widened + l->sigma2[0][k] + least_d;
            const double miss    = l->mean[0][k] - moment.mean[k];
            misses->miss2[k]     = l->measured[k] * miss * miss / d_there;
            misses->d[k]         = l->measured[k] * d_there + (1.0 - l->measured[k]);
        }
    }
}

// miss' D^-1 miss and det D of moment and forces at one point, D of the digs' spread and of the
// measurement, about a mean. By Cholesky's square-free form, D = L diag(e) L'.
static inline double joint2(const double miss[DIG_FORCE_CHANNELS], const double spread2[],
                            const double sigma2[], double *const determinant)
{
    const double s0  = sqrt(spread2[0]);
    const double s1  = sqrt(spread2[1]);
    const double s2  = sqrt(spread2[2]);
    const double d01 = DIG_ENTRY_SCATTER_MY_FX * s0 * s1;
    const double d02 = DIG_ENTRY_SCATTER_MY_FZ * s0 * s2;
    const double d12 = DIG_ENTRY_SCATTER_FX_FZ * s1 * s2;

    const double e0  = spread2[0] + sigma2[0];
    const double l10 = d01 / e0;
    const double l20 = d02 / e0;
    const double e1  = spread2[1] + sigma2[1] - l10 * d01;
    const double l21 = (d12 - l20 * d01) / e1;
    const double e2  = spread2[2] + sigma2[2] - l20 * d02 - l21 * l21 * e1;
    const double y1  = miss[1] - l10 * miss[0];
    const double y2  = miss[2] - l20 * miss[0] - l21 * y1;
    *determinant     = e0 * e1 * e2;
    return miss[0] * miss[0] / e0 + y1 * y1 / e1 + y2 * y2 / e2;
}

static void miss_all(const struct dig_likelihood *const restrict l,
                     const struct dig_cell *const cell, struct misses *const restrict misses)
{
    struct channel_curve curve[DIG_FORCE_CHANNELS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        make_curve(l, cell, c, &curve[c]);
    }
    for (size_t from = 0; from < DIG_CURVE_POINTS; from += STRIDE) {
        for (size_t i = 0; i < STRIDE; i++) {
            const size_t k         = from + i;
            const double widened   = l->inverse_digs[k] + cell->inverse_packings;
            const double miss[]    = { l->mean[0][k] - curve[0].mean[k],
                                       l->mean[1][k] - curve[1].mean[k],
                                       l->mean[2][k] - curve[2].mean[k] };
            const double spread2[] = { widened * curve[0].spread2[k] + least_d,
                                       widened * curve[1].spread2[k] + least_d,
                                       widened * curve[2].spread2[k] + least_d };
            const double sigma2[]  = { l->sigma2[0][k], l->sigma2[1][k], l->sigma2[2][k] };
            double       determinant;
            misses->miss2[k] = l->measured[k] * joint2(miss, spread2, sigma2, &determinant);
            misses->d[k]     = l->measured[k] * determinant + (1.0 - l->measured[k]);
        }
    }
}

static void miss_by(const struct dig_likelihood *const l, const struct dig_cell *const cell,
                    struct misses *const misses)
{
    if (l->channels == 1) {
        miss_moment(l, cell, misses);
    } else {
        miss_all(l, cell, misses);
    }
}

double dig_likelihood_log(const struct dig_likelihood *const l, const struct dig_cell *const cell)
{
    assert(l != NULL && cell != NULL);
    struct misses misses;
    miss_by(l, cell, &misses);
    const double sum = sum_up(DIG_CURVE_POINTS, misses.miss2, misses.d);
    return -0.5 * l->effective * sum / l->measured_count;
}

void dig_likelihood_make(const struct dig_curve_set *const set,
                         const struct dig_pooled *const group, struct dig_likelihood *const l)
{
    assert(set != NULL && group != NULL && l != NULL);
    *l = (struct dig_likelihood){ .trajectory = group->trajectory,
                                  .channels   = group->forces ? DIG_FORCE_CHANNELS : 1 };
    for (size_t n = 0; n < DIG_COVARIANCE_NUMBERS; n++) {
        l->relative2[n / DIG_COVARIANCE_BLOCKS] +=
            set->relative2[group->trajectory][n] / DIG_COVARIANCE_BLOCKS;
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double n = group->count[k];
        if (!(n > 0.0)) {
            continue;
        }
        l->measured_count += 1.0;
        l->measured[k]     = 1.0;
        l->inverse_digs[k] = 1.0 / n;
        l->mean[0][k]      = group->mean_Nm[k];
        l->sigma2[0][k]    = group->sigma2_Nm2[k] / n;
        for (size_t c = 1; c < DIG_FORCE_CHANNELS; c++) {
            l->mean[c][k]   = group->force_N[c - 1][k];
            l->sigma2[c][k] = group->force_sigma2_N2[c - 1][k] / n;
        }
    }
    const struct dig_trajectory *const t = &set->trajectory[group->trajectory];
    const double whole_m = dig_trajectory_path_m(t, set->tooth_m, dig_trajectory_duration_s(t));
    const double correlation_m = DIG_LIKELIHOOD_CORRELATION * set->tooth_m;
    const double share         = (l->measured_count - 1.0) / (DIG_CURVE_POINTS - 1);
    l->effective               = fmax(share * whole_m / correlation_m, 1.0);
}

double dig_likelihood_evidence(const struct dig_curve_set *const set,
                               const struct dig_pooled *const    group)
{
    assert(set != NULL && group != NULL);
    struct dig_likelihood l;
    double                log_of[ALL_COARSE];
    double                most = -INFINITY;
    dig_likelihood_make(set, group, &l);
    for (size_t i = 0; i < ALL_COARSE; i++) {
        const size_t      of[DIG_AXES] = { i / COARSE_DENSITY / COARSE, i / COARSE_DENSITY % COARSE,
                                           i % COARSE_DENSITY };
        struct dig_gravel gravel;
        struct dig_cell   cell;
        for (int a = 0; a < DIG_AXES; a++) {
            const double count = a == DIG_AXIS_DENSITY_kgpm3 ? COARSE_DENSITY : COARSE;
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, ((double)of[a] + 0.5) / count);
        }
        log_of[i] = dig_cell_find(set, &gravel, l.trajectory, &cell) == DIG_OK
                        ? dig_likelihood_log(&l, &cell)
                        : -(double)INFINITY;
        most      = fmax(most, log_of[i]);
    }
    double sum = 0.0;
    for (size_t i = 0; isfinite(most) && i < ALL_COARSE; i++) {
        sum += exp(log_of[i] - most);
    }
    return most + log(sum / ALL_COARSE);
}
