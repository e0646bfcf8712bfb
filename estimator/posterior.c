#include "estimator/posterior.h"

#include "estimator/interpolate.h"
#include "estimator/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID_MAX = FINE * FINE * FINE_DENSITY };

// How many packings the pooled spread is worth against an entry's own.
static const double pooled_weight = 4.0;

// Share of the table's pooled spread below which no point of a curve is believed.
static const double least_spread = 0.25;

// Keeps variances apart from 0, and products of four of them from the end of the numbers.
static const double least_d = 1e-60;

// Of the digs along one trajectory.
struct likelihood {
    const struct dig_pooled *group;
    double                   effective; // independent errors along the dig
    double                   relative2; // pooled (sd / mean)^2 of the trajectory
    size_t                   from, end; // first point measured, and behind the last
    double                   points;    // measured
};

// Squared spread of one dig relative to the mean, over all entries of the trajectory.
static double pooled_relative2(const struct dig_curve_set *const set, const size_t trajectory)
{
    double sd2   = 0.0;
    double mean2 = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * set->trajectories + trajectory;
        if (set->packings[slot] <= 0) {
            continue;
        }
        const struct dig_curve *const curve = &set->curve[slot];

        // Each entry counts alike, however hard it resists.
        double entry_sd2   = 0.0;
        double entry_mean2 = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            entry_sd2 += pow((double)curve->sd[DIG_CHANNEL_MY_Nm][k], 2.0);
            entry_mean2 += pow((double)curve->mean[DIG_CHANNEL_MY_Nm][k], 2.0);
        }
        if (entry_mean2 > 0.0) {
            sd2 += entry_sd2 / entry_mean2;
            mean2 += 1.0;
        }
    }
    return mean2 > 0.0 ? sd2 / mean2 : 0.0;
}

static double log_likelihood(const struct likelihood *const l, const struct dig_cell *const cell)
{
    const double own    = fmax(1.0 / cell->inverse_packings - 1.0, 0.0);
    const double shared = pooled_weight / (pooled_weight + own);

    double mean_Nm[DIG_CURVE_POINTS];
    double sd_Nm[DIG_CURVE_POINTS];
    dig_cell_blend(cell, DIG_CHANNEL_MY_Nm, mean_Nm, sd_Nm);

    double mean2 = 0.0;
    for (size_t k = l->from; k < l->end; k++) {
        mean2 += l->group->count[k] > 0.0 ? mean_Nm[k] * mean_Nm[k] : 0.0;
    }
    const double floor2 = least_spread * least_spread * l->relative2 * mean2 / l->points;

    // A logarithm is dear: one of a few variances' product.
    double sum     = 0.0;
    double product = 1.0;
    for (size_t k = l->from; k < l->end; k++) {
        const double n = l->group->count[k];
        if (!(n > 0.0)) {
            continue;
        }
        const double pooled2 = l->relative2 * mean_Nm[k] * mean_Nm[k];
        const double spread2 = (1.0 - shared) * sd_Nm[k] * sd_Nm[k] + shared * pooled2 + floor2;
        const double d =
            spread2 * (1.0 / n + cell->inverse_packings) + l->group->sigma2_Nm2[k] / n + least_d;
        const double miss = l->group->mean_Nm[k] - mean_Nm[k];
        sum += miss * miss / d;
        product *= d;
        if (k % 4 == 3) {
            sum += log(product);
            product = 1.0;
        }
    }
    return -0.5 * l->effective * (sum + log(product)) / l->points;
}

static struct likelihood likelihood_of(const struct dig_curve_set *const set,
                                       const struct dig_pooled *const    group)
{
    const struct dig_trajectory *const t = &set->trajectory[group->trajectory];
    const double whole_m = dig_trajectory_path_m(t, set->tooth_m, dig_trajectory_duration_s(t));
    const double correlation_m = DIG_POSTERIOR_CORRELATION * set->tooth_m;

    struct likelihood l = { .group     = group,
                            .relative2 = pooled_relative2(set, group->trajectory),
                            .from      = DIG_CURVE_POINTS };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (group->count[k] > 0.0) {
            l.from = k < l.from ? k : l.from;
            l.end  = k + 1;
            l.points += 1.0;
        }
    }
    const double share = (l.points - 1.0) / (DIG_CURVE_POINTS - 1);
    l.effective        = fmax(share * whole_m / correlation_m, 1.0);
    return l;
}

// Of all digs at one gravel; -infinity where the table has no curve.
static double log_likelihood_at(const struct dig_curve_set *const set,
                                const struct dig_gravel *const gravel, const size_t groups,
                                const struct likelihood l[])
{
    double sum = 0.0;
    for (size_t g = 0; g < groups; g++) {
        struct dig_cell cell;
        if (dig_cell_find(set, gravel, l[g].group->trajectory, &cell) != DIG_OK) {
            return -INFINITY;
        }
        sum += log_likelihood(&l[g], &cell);
    }
    return sum;
}

// The fine grid: points are centres of equal intervals of each axis's position.
struct fine {
    size_t count[DIG_AXES];
    size_t all;
};

static struct fine make_fine(const struct dig_curve_set *const set)
{
    struct fine fine = { .all = 1 };
    for (int a = 0; a < DIG_AXES; a++) {
        const size_t most = a == DIG_AXIS_DENSITY_kgpm3 ? FINE_DENSITY : FINE;
        fine.count[a]     = set->axis_count[a] > 1 ? most : 1;
        fine.all *= fine.count[a];
    }
    return fine;
}

static size_t index_on(const struct fine *const fine, const size_t point, const int axis)
{
    size_t rest = point;
    for (int a = DIG_AXES - 1; a > axis; a--) {
        rest /= fine->count[a];
    }
    return rest % fine->count[axis];
}

static struct dig_gravel gravel_at(const struct dig_curve_set *const set,
                                   const struct fine *const fine, const size_t point)
{
    struct dig_gravel gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        const double position = ((double)index_on(fine, point, a) + 0.5) / (double)fine->count[a];
        gravel.value[a]       = dig_axis_value(set, (enum dig_axis)a, position);
    }
    return gravel;
}

// Position at which the marginal distribution reaches a probability; weights sum to 1.
static double quantile(const struct fine *const fine, const int axis, const double weight[],
                       const double probability)
{
    double marginal[FINE] = { 0 };
    for (size_t i = 0; i < fine->all; i++) {
        marginal[index_on(fine, i, axis)] += weight[i];
    }
    double below = 0.0;
    for (size_t i = 0; i < fine->count[axis]; i++) {
        if (below + marginal[i] >= probability && marginal[i] > 0.0) {
            return ((double)i + (probability - below) / marginal[i]) / (double)fine->count[axis];
        }
        below += marginal[i];
    }
    return 1.0;
}

// Gravels at equal steps of the cumulative weight: each stands for as much of the posterior.
static void draw_samples(const struct dig_curve_set *const set, const struct fine *const fine,
                         const double weight[], struct dig_match *const match)
{
    double sum = 0.0;
    size_t i   = 0;
    for (size_t s = 0; s < DIG_MATCH_SAMPLES; s++) {
        const double at = ((double)s + 0.5) / DIG_MATCH_SAMPLES;
        while (i + 1 < fine->all && sum + weight[i] < at) {
            sum += weight[i++];
        }
        match->sample[s] = gravel_at(set, fine, i);
    }
    match->samples = DIG_MATCH_SAMPLES;
}

enum dig_status dig_posterior_fill(const struct dig_curve_set *const set,
                                   const struct dig_pool_sums *const sums,
                                   struct dig_match *const           match)
{
    assert(set != NULL && sums != NULL && match != NULL);
    for (int a = 0; a < DIG_AXES; a++) {
        if (set->axis_count[a] == 0) {
            return DIG_ENOMATCH;
        }
    }
    struct likelihood l[DIG_TRAJECTORY_MAX];
    for (size_t g = 0; g < sums->groups; g++) {
        l[g] = likelihood_of(set, &sums->group[g]);
    }
    const struct fine fine = make_fine(set);

    double weight[GRID_MAX];
    double most = -INFINITY;
    for (size_t i = 0; i < fine.all; i++) {
        const struct dig_gravel gravel = gravel_at(set, &fine, i);
        weight[i]                      = log_likelihood_at(set, &gravel, sums->groups, l);
        most                           = fmax(most, weight[i]);
    }
    if (!isfinite(most)) {
        return DIG_ENOMATCH;
    }

    double sum = 0.0;
    for (size_t i = 0; i < fine.all; i++) {
        weight[i] = exp(weight[i] - most);
        sum += weight[i];
    }
    struct dig_gravel mean = { { 0 } };
    for (size_t i = 0; i < fine.all; i++) {
        weight[i] /= sum;
        const struct dig_gravel gravel = gravel_at(set, &fine, i);
        for (int a = 0; a < DIG_AXES; a++) {
            mean.value[a] += weight[i] * gravel.value[a];
        }
    }

    match->mean = mean;
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        match->low.value[a]      = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.05));
        match->high.value[a]     = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.95));
    }
    draw_samples(set, &fine, weight, match);
    return DIG_OK;
}
