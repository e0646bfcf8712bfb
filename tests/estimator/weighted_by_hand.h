// The noise-weighted distance to every entry, as its formula is written.

#ifndef DIG_TESTS_ESTIMATOR_WEIGHTED_BY_HAND_H
#define DIG_TESTS_ESTIMATOR_WEIGHTED_BY_HAND_H

#include "estimator/match/pool.h"

#include "estimator/match/entry_scatter.h"
#include "tests/made_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS   = DIG_CURVE_POINTS,
    BLOCKS   = DIG_COVARIANCE_BLOCKS,
    WIDE     = 32,
    PACKINGS = 3,
    MOST     = 3 * 3 * BLOCKS
};

static const double channels[3][3] = { { 1, DIG_ENTRY_SCATTER_MY_FX, DIG_ENTRY_SCATTER_MY_FZ },
                                       { DIG_ENTRY_SCATTER_MY_FX, 1, DIG_ENTRY_SCATTER_FX_FZ },
                                       { DIG_ENTRY_SCATTER_MY_FZ, DIG_ENTRY_SCATTER_FX_FZ, 1 } };

// What is compared of one trajectory: a number a block and channel, and D between all of them.
struct numbers {
    int    count;
    double miss[MOST], d[MOST][MOST];
};

// Of the points of one block that lie in halves measured whole; NaN where neither was.
static inline double mean_in(const struct dig_pooled *const group, const int block,
                             const double of[], const float also[])
{
    double sum = 0.0, points = 0.0;
    for (int half = 0; half < 2; half++) {
        const int from  = block * WIDE + half * WIDE / 2;
        bool      whole = true;
        for (int k = from; k < from + WIDE / 2; k++) {
            whole = whole && group->count[k] > 0.0;
        }
        for (int k = from; k < from + WIDE / 2 && whole; k++) {
            sum += of != NULL ? of[k] : (double)also[k];
            points += 1.0;
        }
    }
    return sum / points;
}

// Mean of the correlation of all pairs of points of two blocks, as entry_scatter.h has it.
static inline double assumed(const struct dig_trajectory *const t, const int one, const int other)
{
    const double whole_m = dig_trajectory_path_m(t, 0.09, dig_trajectory_duration_s(t));
    double       sum     = 0.0;
    for (int i = 0; i < WIDE; i++) {
        for (int j = 0; j < WIDE; j++) {
            const double away_m = whole_m * ((one - other) * WIDE + i - j) / 255.0;
            const double own =
                exp(-3.14159265358979 * pow(away_m / (DIG_ENTRY_SCATTER_WIDTH * 0.09), 2.0));
            sum +=
                (DIG_ENTRY_SCATTER_SHARED + (1.0 - DIG_ENTRY_SCATTER_SHARED) * own) / (WIDE * WIDE);
        }
    }
    return sum;
}

// Mean square of a curve in one block over that of the whole curve, of all entries: scatter goes
// with the curve.
static inline double share_of(const struct dig_curve_set *const set, const size_t trajectory,
                              const int number)
{
    double sum = 0.0, entries = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * MADE_TRAJECTORIES + trajectory;
        double       here = 0.0, whole = 0.0;
        for (int k = 0; k < POINTS; k++) {
            const double t = (double)set->curve[slot].mean[number / BLOCKS][k];
            here += k / WIDE == number % BLOCKS ? t * t / WIDE : 0.0;
            whole += t * t / POINTS;
        }
        sum += set->packings[slot] > 0 ? here / whole : 0.0;
        entries += set->packings[slot] > 0 ? 1.0 : 0.0;
    }
    return sum / entries;
}

// Between two numbers of one dig, relative to the sizes of the curves: what packings show, drawn
// towards 0.95 of the mean along its diagonal, which counts 69 degrees of freedom, or what is
// assumed; 5 % is each one's own.
static inline double covariance_of(const struct dig_curve_set *const set, const size_t trajectory,
                                   const int one, const int other, const double relative_sd)
{
    const struct dig_trajectory t = made_trajectory((enum made_trajectory)trajectory);
    if (set->covariance == NULL) {
        return relative_sd * relative_sd *
               sqrt(share_of(set, trajectory, one) * share_of(set, trajectory, other)) *
               channels[one / BLOCKS][other / BLOCKS] * assumed(&t, one % BLOCKS, other % BLOCKS) *
               (one == other ? 1.0 : 0.95);
    }
    const struct dig_covariance *const c = &set->covariance[trajectory];
    if (one == other) {
        return c->of[one][one];
    }
    const int lag = other % BLOCKS - one % BLOCKS;
    double    sum = 0.0, n = 0.0;
    for (int i = one / BLOCKS * BLOCKS; i < (one / BLOCKS + 1) * BLOCKS; i++) {
        const int j = other / BLOCKS * BLOCKS + i % BLOCKS + lag;
        if (i % BLOCKS + lag >= 0 && i % BLOCKS + lag < BLOCKS) {
            sum += c->of[i][j] / sqrt(c->of[i][i] * c->of[j][j]);
            n += 1.0;
        }
    }
    const double scale = sqrt(c->of[one][one] * c->of[other][other]);
    const double even  = 69.0 / (69.0 + c->freedom);
    return 0.95 * ((1.0 - even) * c->of[one][other] + even * 0.95 * sum / n * scale);
}

// Of all numbers of one dig: the same for every entry.
struct relative {
    double of[3 * BLOCKS][3 * BLOCKS];
};

static inline void relate(const struct dig_curve_set *const set, const size_t trajectory,
                          const double relative_sd, struct relative *const relative)
{
    for (int one = 0; one < 3 * BLOCKS; one++) {
        for (int other = 0; other < 3 * BLOCKS; other++) {
            relative->of[one][other] = covariance_of(set, trajectory, one, other, relative_sd);
        }
    }
}

// Appends those of one trajectory; what belongs to others is not correlated with them.
static inline void append(const struct dig_curve_set *const set, const size_t entry,
                          const struct dig_pooled *const group,
                          const struct relative *const relative, const size_t nearest,
                          struct numbers *const all)
{
    const struct dig_curve *const near =
        &set->curve[nearest * MADE_TRAJECTORIES + group->trajectory];
    const struct dig_curve *const c    = &set->curve[entry * MADE_TRAJECTORIES + group->trajectory];
    const int                     from = all->count;
    int                           which[MOST];
    double dig2[MOST], noise2_of[MOST], together[MOST], square[3] = { 0 }, squares[3] = { 0 };
    double rubs[MOST][DIG_RUBS];
    double scale[MOST];
    for (int w = 0; w < (group->forces ? 3 : 1) * BLOCKS; w++) {
        const int    i = w / BLOCKS, b = w % BLOCKS;
        const double x    = mean_in(group, b, group->mean[i], NULL);
        double       size = 0.0, one[POINTS], noise[POINTS];
        if (isnan(x)) {
            continue;
        }
        for (int o = 0; o < BLOCKS; o++) {
            double sum = 0.0;
            for (int k = o * WIDE; k < (o + 1) * WIDE; k++) {
                sum += (double)near->mean[i][k] / WIDE;
            }
            size += sum * sum / BLOCKS;
        }
        for (int k = 0; k < POINTS; k++) {
            one[k] = 1.0 / group->count[k];
        }
        // Of one dig, so that each half counts its own number of digs.
        for (int k = 0; k < POINTS; k++) {
            const int half = k / (WIDE / 2) * (WIDE / 2);
            double    mean = 0.0;
            for (int m = half; m < half + WIDE / 2; m++) {
                mean += one[m] / (WIDE / 2);
            }
            noise[k] = mean * group->sigma2[i][k];
        }
        const int    n    = all->count++;
        const double own2 = relative->of[w][w];
        which[n]          = w;
        scale[n]          = sqrt(size * own2 * (mean_in(group, b, one, NULL) + 1.0 / PACKINGS) +
                                 mean_in(group, b, noise, NULL)) /
                   sqrt(own2);
        all->miss[n] = x - mean_in(group, b, NULL, c->mean[i]);
        dig2[n]      = own2 * mean_in(group, b, one, NULL);
        noise2_of[n] = mean_in(group, b, noise, NULL);
        for (int j = 0; j < DIG_RUBS; j++) {
            rubs[n][j] = mean_in(group, b, NULL, group->rubs[j][i]);
        }
        square[i] += x * x;
        squares[i] += 1.0;
    }
    // What was measured wrong goes together with nothing; of digs as large as those measured.
    for (int n = from; n < all->count; n++) {
        const int    i   = which[n] / BLOCKS;
        const double own = dig2[n] * square[i] / squares[i];
        together[n]      = sqrt(own / (own + noise2_of[n]));
    }
    for (int n = from; n < all->count; n++) {
        for (int o = from; o < all->count; o++) {
            all->d[n][o] = scale[n] * scale[o] * (n == o ? 1.0 : together[n] * together[o]) *
                           relative->of[which[n]][which[o]];
            for (int j = 0; j < DIG_RUBS; j++) { // friction is the same in all
                all->d[n][o] += rubs[n][j] * rubs[o][j];
            }
        }
    }
}

// q, by Gauss' elimination.
static inline double eliminate(struct numbers *const a)
{
    double right[MOST], q = 0.0;
    memcpy(right, a->miss, sizeof right);
    for (int i = 0; i < a->count; i++) {
        for (int r = i + 1; r < a->count; r++) {
            const double by = a->d[r][i] / a->d[i][i];
            for (int c = i; c < a->count; c++) {
                a->d[r][c] -= by * a->d[i][c];
            }
            right[r] -= by * right[i];
        }
    }
    for (int i = a->count - 1; i >= 0; i--) {
        for (int c = i + 1; c < a->count; c++) {
            right[i] -= a->d[i][c] * right[c];
        }
        right[i] /= a->d[i][i];
        q += a->miss[i] * right[i];
    }
    return q;
}

struct weighted_by_hand {
    int    entry; // -1: none
    double distance;
};

static inline struct weighted_by_hand by_hand(const struct dig_curve_set *const set,
                                              const struct dig_pool_sums *const sums,
                                              const double relative_sd, const size_t nearest)
{
    struct numbers          all;
    struct weighted_by_hand best  = { .entry = -1 };
    double                  least = INFINITY;
    struct relative         relative[DIG_TRAJECTORY_MAX];
    for (size_t g = 0; g < sums->groups; g++) {
        relate(set, sums->group[g].trajectory, relative_sd, &relative[g]);
    }
    for (size_t e = 0; e < set->entries; e++) {
        bool dug = true;
        memset(&all, 0, sizeof all);
        for (size_t g = 0; g < sums->groups; g++) {
            dug = dug && set->packings[e * MADE_TRAJECTORIES + sums->group[g].trajectory] > 0;
            append(set, e, &sums->group[g], &relative[g], nearest, &all);
        }
        const double q = eliminate(&all);
        if (dug && q < least) {
            least = q;
            best  = (struct weighted_by_hand){ (int)e, sqrt(q / all.count) };
        }
    }
    return best;
}

#endif // DIG_TESTS_ESTIMATOR_WEIGHTED_BY_HAND_H
