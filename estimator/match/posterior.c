#include "estimator/match/posterior.h"

#include "estimator/approach/interpolate.h"
#include "estimator/match/gaussian.h"
#include "estimator/match/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID_MAX = FINE * FINE * FINE_DENSITY };

// Of the digs along each trajectory.
struct likelihood {
    size_t              groups;
    struct dig_gaussian group[DIG_TRAJECTORY_MAX];
};

static void make_likelihood(const struct dig_curve_set *const set,
                            const struct dig_pool_sums *const sums, struct likelihood *const l)
{
    l->groups = sums->groups;
    for (size_t g = 0; g < sums->groups; g++) {
        dig_gaussian_make(set, &sums->group[g], &l->group[g]);
    }
}

double dig_posterior_excess(const struct dig_curve_set *const set,
                            const struct dig_pool_sums *const sums,
                            const struct dig_gravel *const    gravel)
{
    assert(set != NULL && sums != NULL && gravel != NULL);
    double numbers = 0.0;
    double square  = 0.0;
    for (size_t g = 0; g < sums->groups; g++) {
        struct dig_gaussian one;
        struct dig_cell     cell;
        dig_gaussian_make(set, &sums->group[g], &one);
        if (dig_cell_find(set, gravel, one.trajectory, &cell) != DIG_OK) {
            return INFINITY;
        }
        numbers += (double)one.numbers;
        square += dig_gaussian_mahalanobis(&one, &cell).square;
    }
    const double rough = 2.0 / (9.0 * numbers);
    return numbers > 0.0 ? (cbrt(square / numbers) - (1.0 - rough)) / sqrt(rough) : 0.0;
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
                                const struct likelihood *const l)
{
    const struct indices     at = indices_of(grid, point);
    struct dig_axis_interval place[DIG_AXES];
    for (int a = 0; a < DIG_AXES; a++) {
        place[a] = grid->place[a][at.on[a]];
    }
    double sum = 0.0;
    for (size_t g = 0; g < l->groups; g++) {
        struct dig_cell cell;
        if (dig_cell_at(set, place, l->group[g].trajectory, &cell) != DIG_OK) {
            return -INFINITY;
        }
        sum += dig_gaussian_log(&l->group[g], &cell);
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

enum dig_status dig_posterior_fill(const struct dig_curve_set *const set,
                                   const struct dig_pool_sums *const sums,
                                   struct dig_match *const           match)
{
    assert(set != NULL && sums != NULL && match != NULL);
    struct grid grid;
    if (make_grid(set, FINE, FINE_DENSITY, &grid) != DIG_OK) {
        return DIG_ENOMATCH;
    }
    struct likelihood l;
    double            weight[GRID_MAX];
    double            most = -INFINITY;
    make_likelihood(set, sums, &l);
    for (size_t i = 0; i < grid.all; i++) {
        weight[i] = log_likelihood_at(set, &grid, i, &l);
        most      = fmax(most, weight[i]);
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
