#include "estimator/match/likelihood.h"

#include "estimator/match/entry_scatter.h"
#include "estimator/match/rubbed.h"

#include <assert.h>
#include <math.h>

enum { COARSE = 9, COARSE_DENSITY = 7 }; // points of an axis
enum { ALL_COARSE = COARSE * COARSE * COARSE_DENSITY };

// Weight of the pooled spread against an entry's own, in packings.
static const double pooled_weight = 4.0;

// Lower bound of a point's spread, as a share of the table's pooled spread: less is chance.
static const double least_spread = 0.25;

// Keeps variances apart from 0, and products of three of them from the end of the numbers.
static const double least_d = 1e-40;

// Mean and variance of one dig, point by point, of one channel at one gravel.
struct channel_curve {
    double mean[DIG_CURVE_POINTS];
    double spread2[DIG_CURVE_POINTS];
};

static void make_curve(const struct dig_likelihood *const l, const struct dig_cell *const cell,
                       const size_t channel, struct channel_curve *const curve)
{
    const double own    = fmax(1.0 / cell->inverse_packings - 1.0, 0.0);
    const double shared = pooled_weight / (pooled_weight + own);
    dig_cell_blend(cell, (enum dig_channel)channel, curve->mean, curve->spread2);

    double mean2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        mean2 += l->group->count[k] > 0.0 ? curve->mean[k] * curve->mean[k] : 0.0;
    }
    const double relative2 = l->relative2[channel] + cell->error2[channel];
    const double floor2    = least_spread * least_spread * relative2 * mean2 / l->measured_count;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double sd      = curve->spread2[k];
        const double pooled2 = relative2 * curve->mean[k] * curve->mean[k];
        curve->spread2[k]    = (1.0 - shared) * sd * sd + shared * pooled2 + floor2;
    }
}

// Sums over points.
struct misfit {
    double            square, log_det; // (m - t)' D^-1 (m - t), log det D
    struct dig_rubbed rubbed;
};

// Adds one point's, about a mean of packings. By Cholesky's square-root-free form, D = L diag(d)
// L'.
static void add_point(const struct dig_likelihood *const l, const double inverse_packings,
                      const struct channel_curve curve[const DIG_FORCE_CHANNELS], const size_t k,
                      struct misfit *const misfit)
{
    double       spread[DIG_FORCE_CHANNELS];
    double       lower[DIG_FORCE_CHANNELS][DIG_FORCE_CHANNELS];
    double       d[DIG_FORCE_CHANNELS] = { 0.0 };
    double       miss[DIG_FORCE_CHANNELS];
    double       rubs[DIG_FORCE_CHANNELS][DIG_RUBS];
    const double inverse_digs = 1.0 / l->group->count[k];
    double       determinant  = 1.0;
    for (size_t i = 0; i < l->channels; i++) {
        const double spread2 = curve[i].spread2[k] * (inverse_digs + inverse_packings) + least_d;
        spread[i]            = sqrt(spread2);
        d[i]                 = spread2 + l->group->sigma2[i][k] * inverse_digs;
        miss[i]              = l->group->mean[i][k] - curve[i].mean[k];
        for (size_t r = 0; l->rubbed && r < DIG_RUBS; r++) {
            rubs[i][r] = (double)l->group->rubs[r][i][k];
        }
        for (size_t j = 0; j < i; j++) {
            lower[i][j] = dig_entry_scatter_between[i][j] * spread[i] * spread[j];
            for (size_t m = 0; m < j; m++) {
                lower[i][j] -= lower[i][m] * lower[j][m] * d[m];
            }
            lower[i][j] /= d[j];
            d[i] -= lower[i][j] * lower[i][j] * d[j];
            miss[i] -= lower[i][j] * miss[j];
            for (size_t r = 0; l->rubbed && r < DIG_RUBS; r++) {
                rubs[i][r] -= lower[i][j] * rubs[j][r];
            }
        }
        misfit->square += miss[i] * miss[i] / d[i];
        determinant *= d[i];
    }
    for (size_t i = 0; l->rubbed && i < l->channels; i++) {
        const double inverse = 1.0 / sqrt(d[i]);
        for (size_t r = 0; r < DIG_RUBS; r++) {
            rubs[i][r] *= inverse;
        }
        dig_rubbed_add(inverse * miss[i], rubs[i], &misfit->rubbed);
    }
    misfit->log_det += log(determinant);
}

double dig_likelihood_log(const struct dig_likelihood *const l, const struct dig_cell *const cell)
{
    assert(l != NULL && cell != NULL);
    struct channel_curve curve[DIG_FORCE_CHANNELS] = { { .mean = { 0.0 } } };
    struct misfit        misfit                    = { .square = 0.0 };
    const double         weight                    = l->effective / l->measured_count;
    for (size_t c = 0; c < l->channels; c++) {
        make_curve(l, cell, c, &curve[c]);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (l->group->count[k] > 0.0) {
            add_point(l, cell->inverse_packings, curve, k, &misfit);
        }
    }
    const struct dig_rubbed_sums rubbed = dig_rubbed_sum(&misfit.rubbed, weight);
    return -0.5 * (weight * (misfit.square + misfit.log_det) - rubbed.explained + rubbed.log_det);
}

void dig_likelihood_make(const struct dig_curve_set *const set,
                         const struct dig_pooled *const group, struct dig_likelihood *const l)
{
    assert(set != NULL && group != NULL && l != NULL);
    *l = (struct dig_likelihood){ .group    = group,
                                  .channels = group->forces ? DIG_FORCE_CHANNELS : 1,
                                  .rubbed   = group->rubbed };
    for (size_t n = 0; n < DIG_COVARIANCE_NUMBERS; n++) {
        l->relative2[n / DIG_COVARIANCE_BLOCKS] +=
            set->relative2[group->trajectory][n] / DIG_COVARIANCE_BLOCKS;
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        l->measured_count += group->count[k] > 0.0 ? 1.0 : 0.0;
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
        log_of[i] = dig_cell_find(set, &gravel, group->trajectory, &cell) == DIG_OK
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
