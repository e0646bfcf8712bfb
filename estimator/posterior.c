#include "estimator/posterior.h"

#include "estimator/interpolate.h"
#include "estimator/likelihood.h"
#include "estimator/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID_MAX = FINE * FINE * FINE_DENSITY };

// How much less likely, in logarithms, than the likeliest a point may look by the outlines and
// still be worth a closer look. All that are not together weigh less than a thousandth of the
// likeliest.
static const double unlikely = 16.0;

// Of all digs at one gravel; -infinity where the table has no curve.
static double log_likelihood_at(const struct dig_curve_set *const set,
                                const struct dig_gravel *const gravel, const size_t groups,
                                const struct dig_likelihood l[])
{
    double sum = 0.0;
    for (size_t g = 0; g < groups; g++) {
        struct dig_cell cell;
        if (dig_cell_find(set, gravel, l[g].trajectory, &cell) != DIG_OK) {
            return -INFINITY;
        }
        sum += dig_likelihood_log(&l[g], &cell);
    }
    return sum;
}

double dig_posterior_excess(const struct dig_curve_set *const set,
                            const struct dig_summary *const   summary,
                            const struct dig_pool_sums *const sums,
                            const struct dig_gravel *const    gravel)
{
    assert(set != NULL && sums != NULL && gravel != NULL);
    double errors = 0.0; // independent ones, of all trajectories and channels
    double miss2  = 0.0; // mean of a trajectory, as often as it has such
    for (size_t g = 0; g < sums->groups; g++) {
        struct dig_likelihood l;
        struct dig_cell       cell;
        dig_likelihood_make(set, summary, &sums->group[g], &l);
        if (dig_cell_find(set, gravel, l.trajectory, &cell) != DIG_OK) {
            return INFINITY;
        }
        const double own = (double)l.channels * l.effective;
        errors += own;
        miss2 += own * dig_likelihood_miss2(&l, &cell);
    }
    return (miss2 / errors - 1.0) * sqrt(0.5 * errors);
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

// The same of the most probable point; what piles up at an end of an axis belongs there.
static struct dig_gravel mode_at(const struct dig_curve_set *const set,
                                 const struct fine *const fine, const size_t point)
{
    struct dig_gravel gravel = gravel_at(set, fine, point);
    for (int a = 0; a < DIG_AXES; a++) {
        const size_t index = index_on(fine, point, a);
        if (index == 0 || index + 1 == fine->count[a]) {
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, index == 0 ? 0.0 : 1.0);
        }
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

// Which points are worth a look: 0, or -infinity. All, if there is nothing to tell it from.
static void look_roughly(const struct dig_curve_set *const set,
                         const struct dig_summary *const   summary,
                         const struct dig_pool_sums *const sums, const struct fine *const fine,
                         struct dig_likelihood l[], double weight[])
{
    bool rough = summary != NULL;
    for (size_t g = 0; rough && g < sums->groups; g++) {
        dig_likelihood_make(set, summary, &sums->group[g], &l[g]);
        rough = dig_likelihood_outline(summary, &l[g]);
    }
    double most = -INFINITY;
    for (size_t i = 0; i < fine->all; i++) {
        const struct dig_gravel gravel = gravel_at(set, fine, i);
        weight[i] = rough ? log_likelihood_at(set, &gravel, sums->groups, l) : 0.0;
        most      = fmax(most, weight[i]);
    }
    for (size_t i = 0; i < fine->all; i++) {
        weight[i] = weight[i] < most - unlikely ? -(double)INFINITY : 0.0;
    }
}

enum dig_status dig_posterior_fill(const struct dig_curve_set *const set,
                                   const struct dig_summary *const   summary,
                                   const struct dig_pool_sums *const sums,
                                   struct dig_match *const           match)
{
    assert(set != NULL && sums != NULL && match != NULL);
    for (int a = 0; a < DIG_AXES; a++) {
        if (set->axis_count[a] == 0) {
            return DIG_ENOMATCH;
        }
    }
    const struct fine     fine = make_fine(set);
    struct dig_likelihood l[DIG_TRAJECTORY_MAX];
    double                weight[GRID_MAX];
    look_roughly(set, summary, sums, &fine, l, weight);

    for (size_t g = 0; g < sums->groups; g++) {
        dig_likelihood_make(set, summary, &sums->group[g], &l[g]);
    }
    double most = -INFINITY;
    for (size_t i = 0; i < fine.all; i++) {
        const struct dig_gravel gravel = gravel_at(set, &fine, i);
        if (!(weight[i] < 0.0)) {
            weight[i] = log_likelihood_at(set, &gravel, sums->groups, l);
        }
        most = fmax(most, weight[i]);
    }
    if (!isfinite(most)) {
        return DIG_ENOMATCH;
    }

    size_t mode = 0;
    for (size_t i = 1; i < fine.all; i++) {
        mode = weight[i] > weight[mode] ? i : mode;
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
    match->mode = mode_at(set, &fine, mode);
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        match->low.value[a]      = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.05));
        match->high.value[a]     = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.95));
    }
    draw_samples(set, &fine, weight, match);
    return DIG_OK;
}
