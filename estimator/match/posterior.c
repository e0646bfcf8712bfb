#include "estimator/match/posterior.h"

#include "estimator/approach/interpolate.h"
#include "estimator/match/likelihood.h"
#include "estimator/match/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID_MAX = FINE * FINE * FINE_DENSITY };
enum { COARSE = 9, COARSE_DENSITY = 7 };

// A point whose log-likelihood by the outlines is this far below the greatest is skipped. All
// skipped points together weigh less than a thousandth of the likeliest.
static const double unlikely = 16.0;

double dig_posterior_excess(const struct dig_curve_set *const set,
                            const struct dig_prefilter *const prefilter,
                            const struct dig_pool_sums *const sums,
                            const struct dig_gravel *const    gravel)
{
    assert(set != NULL && sums != NULL && gravel != NULL);
    double errors = 0.0; // independent ones, of all trajectories and channels
    double miss2  = 0.0; // mean of a trajectory, as often as it has such
    for (size_t g = 0; g < sums->groups; g++) {
        struct dig_likelihood l;
        struct dig_cell       cell;
        dig_likelihood_make(set, prefilter, &sums->group[g], &l);
        if (dig_cell_find(set, gravel, l.trajectory, &cell) != DIG_OK) {
            return INFINITY;
        }
        const double own = (double)l.channels * l.effective;
        errors += own;
        miss2 += own * dig_likelihood_reduced_chi2(&l, &cell);
    }
    return (miss2 / errors - 1.0) * sqrt(0.5 * errors);
}

// A grid: points are centres of equal intervals of each axis's position. What belongs to a
// point depends on single axes, and is computed once for each of their values.
struct grid {
    size_t                   count[DIG_AXES];
    size_t                   all;
    double                   value[DIG_AXES][FINE];
    struct dig_axis_interval place[DIG_AXES][FINE];
};

// DIG_ENOMATCH when an axis has no points.
static enum dig_status make_grid(const struct dig_curve_set *const set, const size_t most_friction,
                                 const size_t most_density, struct grid *const grid)
{
    grid->all = 1;
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        const size_t        most = a == DIG_AXIS_DENSITY_kgpm3 ? most_density : most_friction;
        if (set->axis_count[a] == 0) {
            return DIG_ENOMATCH;
        }
        grid->count[a] = set->axis_count[a] > 1 ? most : 1;
        grid->all *= grid->count[a];
        for (size_t i = 0; i < grid->count[a]; i++) {
            const double value =
                dig_axis_value(set, axis, ((double)i + 0.5) / (double)grid->count[a]);
            const enum dig_status status = dig_axis_locate(set, axis, value, &grid->place[a][i]);
            if (status != DIG_OK) {
                return status;
            }
            grid->value[a][i] = value;
        }
    }
    return DIG_OK;
}

// Where on its axes a point lies.
struct indices {
    size_t on[DIG_AXES];
};

static struct indices indices_of(const struct grid *const grid, const size_t point)
{
    struct indices at;
    size_t         rest = point;
    for (int a = DIG_AXES - 1; a >= 0; a--) {
        at.on[a] = rest % grid->count[a];
        rest /= grid->count[a];
    }
    return at;
}

static struct dig_gravel gravel_at(const struct grid *const grid, const size_t point)
{
    const struct indices at = indices_of(grid, point);
    struct dig_gravel    gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        gravel.value[a] = grid->value[a][at.on[a]];
    }
    return gravel;
}

// Of all digs at one point; -infinity where the table has no curve.
static double log_likelihood_at(const struct dig_curve_set *const set,
                                const struct grid *const grid, const size_t point,
                                const size_t groups, const struct dig_likelihood l[])
{
    const struct indices     at = indices_of(grid, point);
    struct dig_axis_interval place[DIG_AXES];
    for (int a = 0; a < DIG_AXES; a++) {
        place[a] = grid->place[a][at.on[a]];
    }
    double sum = 0.0;
    for (size_t g = 0; g < groups; g++) {
        struct dig_cell cell;
        if (dig_cell_at(set, place, l[g].trajectory, &cell) != DIG_OK) {
            return -INFINITY;
        }
        sum += dig_likelihood_log(&l[g], &cell);
    }
    return sum;
}

// The gravel of the most probable point; what piles up at an end of an axis belongs there.
static struct dig_gravel mode_at(const struct dig_curve_set *const set,
                                 const struct grid *const grid, const size_t point)
{
    const struct indices at     = indices_of(grid, point);
    struct dig_gravel    gravel = gravel_at(grid, point);
    for (int a = 0; a < DIG_AXES; a++) {
        if (at.on[a] == 0 || at.on[a] + 1 == grid->count[a]) {
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, at.on[a] == 0 ? 0.0 : 1.0);
        }
    }
    return gravel;
}

// The weights along each axis; they sum to 1.
struct marginal {
    double weight[DIG_AXES][FINE];
};

static struct marginal marginal_of(const struct grid *const grid, const double weight[])
{
    struct marginal m = { { { 0.0 } } };
    for (size_t i = 0; i < grid->all; i++) {
        const struct indices at = indices_of(grid, i);
        for (int a = 0; a < DIG_AXES; a++) {
            m.weight[a][at.on[a]] += weight[i];
        }
    }
    return m;
}

// Position at which the distribution along an axis of so many intervals reaches a probability.
static double quantile(const size_t count, const double weight[], const double probability)
{
    double below = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (below + weight[i] >= probability && weight[i] > 0.0) {
            return ((double)i + (probability - below) / weight[i]) / (double)count;
        }
        below += weight[i];
    }
    return 1.0;
}

// Gravels at equal steps of the cumulative weight: each stands for as much of the posterior.
static void draw_samples(const struct grid *const grid, const double weight[],
                         struct dig_match *const match)
{
    double sum = 0.0;
    size_t i   = 0;
    for (size_t s = 0; s < DIG_MATCH_SAMPLES; s++) {
        const double at = ((double)s + 0.5) / DIG_MATCH_SAMPLES;
        while (i + 1 < grid->all && sum + weight[i] < at) {
            sum += weight[i++];
        }
        match->sample[s] = gravel_at(grid, i);
    }
    match->samples = DIG_MATCH_SAMPLES;
}

// Marks the points to evaluate by 0, others by -infinity; all without a prefilter.
static void mark_likely(const struct dig_curve_set *const set,
                        const struct dig_prefilter *const prefilter,
                        const struct dig_pool_sums *const sums, const struct grid *const grid,
                        struct dig_likelihood l[], double weight[])
{
    bool rough = prefilter != NULL;
    bool dear  = false; // more than the rough look
    for (size_t g = 0; rough && g < sums->groups; g++) {
        dig_likelihood_make(set, prefilter, &sums->group[g], &l[g]);
        dear  = dear || !l[g].is_gaussian;
        rough = l[g].is_gaussian || dig_likelihood_outline(prefilter, &l[g]);
    }
    rough       = rough && dear;
    double most = -INFINITY;
    for (size_t i = 0; i < grid->all; i++) {
        weight[i] = rough ? log_likelihood_at(set, grid, i, sums->groups, l) : 0.0;
        most      = fmax(most, weight[i]);
    }
    for (size_t i = 0; i < grid->all; i++) {
        weight[i] = weight[i] < most - unlikely ? -(double)INFINITY : 0.0;
    }
}

double dig_posterior_evidence(const struct dig_curve_set *const set,
                              const struct dig_pool_sums *const sums)
{
    assert(set != NULL && sums != NULL);
    struct grid           coarse;
    struct dig_likelihood l[DIG_TRAJECTORY_MAX];
    double                log_of[COARSE * COARSE * COARSE_DENSITY];
    double                most = -INFINITY;
    if (make_grid(set, COARSE, COARSE_DENSITY, &coarse) != DIG_OK) {
        return -INFINITY;
    }
    for (size_t g = 0; g < sums->groups; g++) {
        dig_likelihood_make(set, NULL, &sums->group[g], &l[g]);
    }
    for (size_t i = 0; i < coarse.all; i++) {
        log_of[i] = log_likelihood_at(set, &coarse, i, sums->groups, l);
        most      = fmax(most, log_of[i]);
    }
    double sum = 0.0;
    for (size_t i = 0; isfinite(most) && i < coarse.all; i++) {
        sum += exp(log_of[i] - most);
    }
    return most + log(sum / (double)coarse.all);
}

enum dig_status dig_posterior_fill(const struct dig_curve_set *const set,
                                   const struct dig_prefilter *const prefilter,
                                   const struct dig_pool_sums *const sums,
                                   struct dig_match *const           match)
{
    assert(set != NULL && sums != NULL && match != NULL);
    struct grid grid;
    if (make_grid(set, FINE, FINE_DENSITY, &grid) != DIG_OK) {
        return DIG_ENOMATCH;
    }
    struct dig_likelihood l[DIG_TRAJECTORY_MAX];
    double                weight[GRID_MAX];
    mark_likely(set, prefilter, sums, &grid, l, weight);

    for (size_t g = 0; g < sums->groups; g++) {
        dig_likelihood_make(set, prefilter, &sums->group[g], &l[g]);
    }
    double most = -INFINITY;
    for (size_t i = 0; i < grid.all; i++) {
        if (!(weight[i] < 0.0)) {
            weight[i] = log_likelihood_at(set, &grid, i, sums->groups, l);
        }
        most = fmax(most, weight[i]);
    }
    if (!isfinite(most)) {
        return DIG_ENOMATCH;
    }

    size_t mode = 0;
    for (size_t i = 1; i < grid.all; i++) {
        mode = weight[i] > weight[mode] ? i : mode;
    }
    double sum = 0.0;
    for (size_t i = 0; i < grid.all; i++) {
        weight[i] = exp(weight[i] - most);
        sum += weight[i];
    }
    struct dig_gravel mean = { { 0 } };
    for (size_t i = 0; i < grid.all; i++) {
        weight[i] /= sum;
        const struct dig_gravel gravel = gravel_at(&grid, i);
        for (int a = 0; a < DIG_AXES; a++) {
            mean.value[a] += weight[i] * gravel.value[a];
        }
    }

    const struct marginal m = marginal_of(&grid, weight);
    match->mean             = mean;
    match->mode             = mode_at(set, &grid, mode);
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        match->low.value[a] = dig_axis_value(set, axis, quantile(grid.count[a], m.weight[a], 0.05));
        match->high.value[a] =
            dig_axis_value(set, axis, quantile(grid.count[a], m.weight[a], 0.95));
    }
    draw_samples(&grid, weight, match);
    return DIG_OK;
}
