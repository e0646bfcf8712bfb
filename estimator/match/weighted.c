// The entry nearest to digs by the noise-weighted (Mahalanobis) distance over every channel
// measured, with the covariance of the packings along the dig. The paper's Euclidean norm of the
// moment is in match.h.
//
//   q = (x - t)' D^-1 (x - t)      x, t, D as in gaussian.h
//
// with one D for all entries, that of the entry nearest by the Euclidean norm: with its own D each,
// an entry of large variance would be near to every dig. Trajectories are independent: their q add.

#include "estimator/match/match.h"

#include "core/outline.h"
#include "estimator/match/gaussian.h"
#include "estimator/match/pool.h"

#include <assert.h>
#include <math.h>

enum { NUMBERS = DIG_COVARIANCE_NUMBERS };

// A first pass compares every so many entries, for a good bound to start with: the nearest by the
// Euclidean norm can be a hundred times as far by this distance. A prime, so that it varies along
// every axis of the table's grid.
enum { FIRST_LOOK = 17 };

// One trajectory, whitened: q is the sum of (white_i - sum_j by_ij t_j)^2.
struct compared_group {
    struct dig_gaussian gaussian;
    double              by[NUMBERS][NUMBERS]; // below the diagonal and on it
    double              white[NUMBERS];
};

struct search {
    const struct dig_curve_set *set;
    size_t                      groups;
    struct compared_group       group[DIG_TRAJECTORY_MAX];
    size_t                      entry; // the nearest so far
    double                      least; // its q
};

// by = M^-1 by, with M M' = 1 + W W': W is what friction adds to whitened numbers.
static void take_rubbed(struct compared_group *const a)
{
    const struct dig_gaussian *const g = &a->gaussian;
    double                           rubs[NUMBERS][DIG_RUBS];
    double                           lower[NUMBERS][NUMBERS];
    for (size_t i = 0; i < g->numbers; i++) {
        for (size_t r = 0; r < DIG_RUBS; r++) {
            rubs[i][r] = 0.0;
            for (size_t j = 0; j <= i; j++) {
                rubs[i][r] += a->by[i][j] * g->compared[j].rubs[r];
            }
        }
        for (size_t j = 0; j <= i; j++) {
            double sum = i == j ? 1.0 : 0.0;
            for (size_t r = 0; r < DIG_RUBS; r++) {
                sum += rubs[i][r] * rubs[j][r];
            }
            for (size_t k = 0; k < j; k++) {
                sum -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = i == j ? sqrt(sum) : sum / lower[j][j];
        }
        for (size_t j = 0; j <= i; j++) {
            for (size_t k = j; k < i; k++) {
                a->by[i][j] -= lower[i][k] * a->by[k][j];
            }
            a->by[i][j] /= lower[i][i];
        }
    }
}

// by = L^-1 U^-1.
static void whiten(const struct dig_curve_set *const set, const size_t nearest,
                   struct compared_group *const a)
{
    const struct dig_gaussian *const g = &a->gaussian;
    const struct dig_cell            cell =
        dig_cell_of_entry(set, nearest * set->trajectories + g->trajectory);
    double u[NUMBERS];
    dig_gaussian_scale(g, &cell, u);
    for (size_t i = 0; i < g->numbers; i++) {
        for (size_t j = 0; j <= i; j++) {
            double sum = i == j ? 1.0 / u[j] : 0.0;
            for (size_t k = j; k < i; k++) {
                sum -= g->lower[i][k] * a->by[k][j];
            }
            a->by[i][j] = sum * g->lower[i][i];
        }
    }
    if (g->rubbed) {
        take_rubbed(a);
    }
    for (size_t i = 0; i < g->numbers; i++) {
        a->white[i] = 0.0;
        for (size_t j = 0; j <= i; j++) {
            a->white[i] += a->by[i][j] * g->compared[j].mean;
        }
    }
}

// The value of an entry's outline that is compared with a number.
static double there(const struct dig_compared *const n, const float outline[])
{
    const double first  = (double)outline[2 * n->block];
    const double second = (double)outline[2 * n->block + 1];
    return n->first && n->second ? 0.5 * (first + second) : n->first ? first : second;
}

// q of one trajectory and what was summed up before; above the limit not to its end. NaN of a curve
// that is none.
static double square(const struct compared_group *const a, const float *const outline[],
                     const double limit, double sum)
{
    double t[NUMBERS];
    for (size_t i = 0; i < a->gaussian.numbers && sum <= limit; i++) {
        const struct dig_compared *const n   = &a->gaussian.compared[i];
        double                           own = a->white[i];
        t[i]                                 = there(n, outline[n->channel]);
        for (size_t j = 0; j <= i; j++) {
            own -= a->by[i][j] * t[j];
        }
        sum += own * own;
    }
    return sum;
}

// Above the limit at once for an entry that lacks a trajectory.
static double square_of(const struct search *const s, const size_t entry, const double limit)
{
    double sum = 0.0;
    for (size_t g = 0; g < s->groups && sum <= limit; g++) {
        const struct compared_group *const a = &s->group[g];
        const size_t slot = entry * s->set->trajectories + a->gaussian.trajectory;
        const float *outline[DIG_FORCE_CHANNELS];
        if (s->set->packings[slot] <= 0) {
            return INFINITY;
        }
        for (size_t c = 0; c < a->gaussian.channels; c++) {
            outline[c] = dig_outline_mean(s->set, c, slot);
        }
        sum = square(a, outline, limit, sum);
    }
    return sum;
}

static void try_entry(struct search *const s, const size_t entry)
{
    const double sum = square_of(s, entry, s->least);
    if (sum < s->least || (sum <= s->least && entry < s->entry)) {
        s->least = sum;
        s->entry = entry;
    }
}

void dig_match_find_weighted(const struct dig_curve_set *const set, const size_t digs,
                             const struct dig_observation dig[], struct dig_match *const match)
{
    assert(set != NULL && digs > 0 && dig != NULL && match != NULL && match->nearest >= 0);
    assert((size_t)match->nearest < set->entries);
    const size_t         nearest = (size_t)match->nearest;
    double               numbers = 0.0;
    struct dig_pool_sums sums;
    dig_pool_sum(digs, dig, &sums);
    struct search s          = { .set = set, .groups = sums.groups };
    match->weighted          = -1;
    match->weighted_distance = (double)NAN;
    for (size_t g = 0; g < sums.groups; g++) {
        dig_gaussian_make(set, &sums.group[g], &s.group[g].gaussian);
        if (s.group[g].gaussian.numbers == 0) {
            return;
        }
        whiten(set, nearest, &s.group[g]);
        numbers += (double)s.group[g].gaussian.numbers;
    }
    s.entry = nearest;
    s.least = square_of(&s, nearest, INFINITY);
    for (size_t e = 0; e < set->entries; e += FIRST_LOOK) {
        try_entry(&s, e);
    }
    for (size_t e = 0; e < set->entries; e++) {
        try_entry(&s, e);
    }
    match->weighted          = (int)s.entry;
    match->weighted_distance = sqrt(s.least / numbers);
}
