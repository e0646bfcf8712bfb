#include "estimator/match/gaussian.h"

#include "core/outline.h"
#include "core/units.h"
#include "estimator/match/entry_scatter.h"
#include "estimator/match/rubbed.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

enum {
    BLOCKS   = DIG_COVARIANCE_BLOCKS,
    NUMBERS  = DIG_COVARIANCE_NUMBERS,
    CHANNELS = DIG_FORCE_CHANNELS,
    HALVES   = DIG_OUTLINE_BLOCKS,
    POINTS   = DIG_OUTLINE_POINTS
};
_Static_assert(HALVES == 2 * BLOCKS, "a block is two of an outline's");

// Correlations that depend on the distance of two blocks alone are worth so many degrees of freedom
// against those of the packings, and a factor on them that keeps C positive definite.
static const double even_freedom   = 69.0;
static const double even_reduction = 0.95;

// Degrees of freedom the packings' covariance needs: one for each number.
static const double least_freedom = NUMBERS;

// Share of a number's variance that is independent of all others.
static const double own_share = 0.05;

// Keeps variances apart from 0.
static const double least_u2 = 1e-80;

static const double ln_2 = 0.69314718055994530942;

struct matrix {
    double of[NUMBERS][NUMBERS];
};

// Mean correlation of all pairs of blocks of two channels that are lag apart.
static double mean_at_lag(const struct matrix *const c, const size_t one, const size_t other,
                          const int lag)
{
    double sum = 0.0;
    double n   = 0.0;
    for (int b = 0; b < BLOCKS; b++) {
        if (b + lag >= 0 && b + lag < BLOCKS) {
            sum += c->of[one * BLOCKS + (size_t)b][other * BLOCKS + (size_t)(b + lag)];
            n += 1.0;
        }
    }
    return sum / n;
}

// Correlations of the table's packings.
static void take_correlation(const struct dig_covariance *const covariance, struct matrix *const c)
{
    const double  towards_even = even_freedom / (even_freedom + covariance->freedom);
    struct matrix plain;
    for (size_t i = 0; i < NUMBERS; i++) {
        for (size_t j = 0; j < NUMBERS; j++) {
            const double product = covariance->of[i][i] * covariance->of[j][j];
            plain.of[i][j]       = product > 0.0 ? covariance->of[i][j] / sqrt(product) : 0.0;
        }
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        for (size_t j = 0; j < NUMBERS; j++) {
            const int    lag  = (int)(j % BLOCKS) - (int)(i % BLOCKS);
            const double even = mean_at_lag(&plain, i / BLOCKS, j / BLOCKS, lag);
            c->of[i][j] =
                (1.0 - towards_even) * plain.of[i][j] + towards_even * even_reduction * even;
        }
    }
}

// Covariance of block means of errors of variance 1, lag blocks apart, by entry_scatter.h.
static double between(const double point_m, const double width_m, const int lag)
{
    enum { WIDE = 2 * POINTS };
    double sum = 0.0;
    for (int u = 1 - WIDE; u < WIDE; u++) {
        const double off = point_m * (lag * WIDE + u) / width_m;
        sum += (WIDE - fabs((double)u)) * exp(-DIG_PI * off * off);
    }
    return (1.0 - DIG_ENTRY_SCATTER_SHARED) * sum / (WIDE * WIDE) + DIG_ENTRY_SCATTER_SHARED;
}

// The same by entry_scatter.h, where there are too few packings; the variances into *variance.
static void assume_correlation(const struct dig_curve_set *const set, const size_t trajectory,
                               struct matrix *const c, double variance[NUMBERS])
{
    const struct dig_trajectory *const t = &set->trajectory[trajectory];
    const double whole_m = dig_trajectory_path_m(t, set->tooth_m, dig_trajectory_duration_s(t));
    const double point_m = whole_m / (DIG_CURVE_POINTS - 1);
    const double width_m = DIG_ENTRY_SCATTER_WIDTH * set->tooth_m;
    double       lag_of[BLOCKS];
    for (int lag = 0; lag < BLOCKS; lag++) {
        lag_of[lag] = between(point_m, width_m, lag);
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        variance[i] = set->relative2[trajectory][i] * lag_of[0];
        for (size_t j = 0; j < NUMBERS; j++) {
            const size_t one   = i % BLOCKS;
            const size_t other = j % BLOCKS;
            c->of[i][j]        = dig_entry_scatter_between[i / BLOCKS][j / BLOCKS] *
                          lag_of[one > other ? one - other : other - one] / lag_of[0];
        }
    }
}

// Share of each number's standard deviation that comes from the digs' correlated scatter, the rest
// being the measurement's; for digs as large as those measured.
static void scatter_shares(const struct dig_gaussian *const g, double share[NUMBERS])
{
    double size2[CHANNELS] = { 0.0 };
    double count[CHANNELS] = { 0.0 };
    for (size_t i = 0; i < g->numbers; i++) {
        const struct dig_compared *const n = &g->compared[i];
        size2[n->channel] += n->mean * n->mean;
        count[n->channel] += 1.0;
    }
    for (size_t i = 0; i < g->numbers; i++) {
        const struct dig_compared *const n = &g->compared[i];
        const double                     own =
            size2[n->channel] / count[n->channel] * n->spread * n->spread * n->inverse_digs;
        share[i] = sqrt(own / (own + n->sigma2 + least_u2));
    }
}

// L of the numbers that are compared. False where the matrix is not positive definite.
static bool factor(const struct matrix *const c, struct dig_gaussian *const g)
{
    size_t at[NUMBERS];
    double share[NUMBERS];
    scatter_shares(g, share);
    for (size_t i = 0; i < g->numbers; i++) {
        at[i] = g->compared[i].channel * BLOCKS + g->compared[i].block;
    }
    for (size_t i = 0; i < g->numbers; i++) {
        for (size_t j = 0; j <= i; j++) {
            double sum =
                i == j ? 1.0 : (1.0 - own_share) * share[i] * share[j] * c->of[at[i]][at[j]];
            for (size_t k = 0; k < j; k++) {
                sum -= g->lower[i][k] * g->lower[j][k];
            }
            if (i == j && !(sum > 1e-6)) {
                return false;
            }
            g->lower[i][j] = i == j ? 1.0 / sqrt(sum) : sum * g->lower[j][j];
        }
    }
    return true;
}

// Over one block of an outline; count is 0 where a point was not measured.
struct half {
    bool   whole;
    double mean, sigma2, inverse_digs, rubs[DIG_RUBS];
};

static struct half half_of(const struct dig_pooled *const group, const size_t channel,
                           const size_t half)
{
    struct half h = { .whole = true };
    for (size_t k = half * POINTS; k < (half + 1) * POINTS; k++) {
        h.whole = h.whole && group->count[k] > 0.0;
        h.mean += group->mean[channel][k] / POINTS;
        h.sigma2 += group->sigma2[channel][k] / POINTS;
        h.inverse_digs += 1.0 / group->count[k] / POINTS;
        for (size_t j = 0; j < DIG_RUBS; j++) {
            h.rubs[j] += (double)group->rubs[j][channel][k] / POINTS;
        }
    }
    return h;
}

// Order of the blocks: the inner ones, which discriminate best, first.
static const size_t block_order[BLOCKS] = { 4, 2, 6, 3, 5, 1, 7, 0 };

static void measure(const struct dig_pooled *const group, const double variance[NUMBERS],
                    struct dig_gaussian *const g)
{
    for (size_t next = 0; next < BLOCKS * g->channels; next++) {
        const size_t      block   = block_order[next % BLOCKS];
        const size_t      channel = next / BLOCKS;
        const struct half half[2] = { half_of(group, channel, 2 * block),
                                      half_of(group, channel, 2 * block + 1) };
        const double      halves  = (half[0].whole ? 1.0 : 0.0) + (half[1].whole ? 1.0 : 0.0);
        if (!(halves > 0.0)) {
            continue;
        }
        struct dig_compared *const to = &g->compared[g->numbers++];
        *to                           = (struct dig_compared){ .channel = channel,
                                                               .block   = block,
                                                               .first   = half[0].whole,
                                                               .second  = half[1].whole,
                                                               .spread  = sqrt(variance[channel * BLOCKS + block]) };
        for (size_t h = 0; h < 2; h++) {
            if (half[h].whole) {
                const double weight = 1.0 / halves;
                to->mean += weight * half[h].mean;
                to->sigma2 += weight * half[h].sigma2 * half[h].inverse_digs;
                to->inverse_digs += weight * half[h].inverse_digs;
                for (size_t j = 0; j < DIG_RUBS; j++) {
                    to->rubs[j] += weight * half[h].rubs[j];
                }
            }
        }
    }
}

void dig_gaussian_make(const struct dig_curve_set *const set, const struct dig_pooled *const group,
                       struct dig_gaussian *const g)
{
    assert(set != NULL && set->outline != NULL && group != NULL && g != NULL);
    *g = (struct dig_gaussian){ .set        = set,
                                .trajectory = group->trajectory,
                                .channels   = group->forces ? CHANNELS : 1,
                                .rubbed     = group->rubbed };
    struct matrix c;
    double        variance[NUMBERS];
    if (set->covariance != NULL && set->covariance[group->trajectory].freedom >= least_freedom) {
        take_correlation(&set->covariance[group->trajectory], &c);
        for (size_t i = 0; i < NUMBERS; i++) {
            variance[i] = set->covariance[group->trajectory].of[i][i];
        }
    } else {
        assume_correlation(set, group->trajectory, &c, variance);
    }
    measure(group, variance, g);
    if (g->numbers > 0 && !factor(&c, g)) {
        g->numbers = 0;
    }
}

// Means of the cell over an outline's blocks.
static void blend(const struct dig_gaussian *const g, const struct dig_cell *const cell,
                  double mean[CHANNELS][HALVES])
{
    for (size_t c = 0; c < g->channels; c++) {
        for (size_t h = 0; h < HALVES; h++) {
            mean[c][h] = 0.0;
        }
    }
    for (size_t i = 0; i < cell->corners; i++) {
        const double weight = cell->weight[i];
        const size_t slot   = (size_t)(cell->curve[i] - g->set->curve);
        for (size_t c = 0; c < g->channels; c++) {
            const float *const of = dig_outline_mean(g->set, c, slot);
            for (size_t h = 0; h < HALVES; h++) {
                mean[c][h] += weight * (double)of[h];
            }
        }
    }
}

// Squared root mean square of the blocks' means.
static double size2_of(const double mean[HALVES])
{
    double sum = 0.0;
    for (size_t b = 0; b < BLOCKS; b++) {
        const double block = 0.5 * (mean[2 * b] + mean[2 * b + 1]);
        sum += block * block;
    }
    return sum / BLOCKS;
}

// The cell's value for the i-th number, and its u^2.
struct there {
    double mean, u2;
};

static void predict_numbers(const struct dig_gaussian *const g, const struct dig_cell *const cell,
                            struct there there[NUMBERS])
{
    double mean[CHANNELS][HALVES];
    double size2[CHANNELS];
    blend(g, cell, mean);
    for (size_t c = 0; c < g->channels; c++) {
        size2[c] = size2_of(mean[c]);
    }
    for (size_t i = 0; i < g->numbers; i++) {
        const struct dig_compared *const n = &g->compared[i];
        const double *const              t = &mean[n->channel][2 * n->block];
        there[i].mean = n->first && n->second ? 0.5 * (t[0] + t[1]) : n->first ? t[0] : t[1];
        there[i].u2   = size2[n->channel] *
                          (n->spread * n->spread * (n->inverse_digs + cell->inverse_packings) +
                           cell->error2[n->channel]) +
                      n->sigma2 + least_u2;
    }
}

// What friction may have added to whitened misses.
static void take_rubbed(const struct dig_gaussian *const g, const struct there there[],
                        const double miss[], struct dig_mahalanobis *const misses)
{
    double            rubs[NUMBERS][DIG_RUBS];
    struct dig_rubbed rubbed = { .b = { 0.0 } };
    for (size_t i = 0; i < g->numbers; i++) {
        for (size_t r = 0; r < DIG_RUBS; r++) {
            double rest = g->compared[i].rubs[r] / sqrt(there[i].u2);
            for (size_t j = 0; j < i; j++) {
                rest -= g->lower[i][j] * rubs[j][r];
            }
            rubs[i][r] = rest * g->lower[i][i];
        }
        dig_rubbed_add(miss[i], rubs[i], &rubbed);
    }
    const struct dig_rubbed_sums sums = dig_rubbed_sum(&rubbed, 1.0);
    misses->square -= sums.explained;
    misses->log_det += sums.log_det;
}

struct dig_mahalanobis dig_gaussian_mahalanobis(const struct dig_gaussian *const g,
                                                const struct dig_cell *const     cell)
{
    assert(g != NULL && cell != NULL);
    struct there there[NUMBERS];
    double       miss[NUMBERS];
    double       mantissa = 1.0;
    int          exponent = 0;
    predict_numbers(g, cell, there);
    for (size_t i = 0; i < g->numbers; i++) {
        miss[i] = (g->compared[i].mean - there[i].mean) / sqrt(there[i].u2);
        mantissa *= there[i].u2;
        if (!(mantissa > 1e-60 && mantissa < 1e60)) {
            int more = 0;
            mantissa = frexp(mantissa, &more);
            exponent += more;
        }
    }
    struct dig_mahalanobis misses = { .log_det = log(mantissa) + (double)exponent * ln_2 };
    for (size_t i = 0; i < g->numbers; i++) {
        for (size_t j = 0; j < i; j++) {
            miss[i] -= g->lower[i][j] * miss[j];
        }
        miss[i] *= g->lower[i][i];
        misses.square += miss[i] * miss[i];
    }
    if (g->rubbed) {
        take_rubbed(g, there, miss, &misses);
    }
    return misses;
}

double dig_gaussian_log(const struct dig_gaussian *const g, const struct dig_cell *const cell)
{
    const struct dig_mahalanobis all = dig_gaussian_mahalanobis(g, cell);
    return -0.5 * DIG_GAUSSIAN_TRUST * (all.square + all.log_det);
}

void dig_gaussian_scale(const struct dig_gaussian *const g, const struct dig_cell *const cell,
                        double u[const NUMBERS])
{
    assert(g != NULL && cell != NULL && u != NULL);
    struct there there[NUMBERS];
    predict_numbers(g, cell, there);
    for (size_t i = 0; i < g->numbers; i++) {
        u[i] = sqrt(there[i].u2);
    }
}
