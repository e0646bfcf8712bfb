#include "closed_loop/fit/posterior.h"

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/numeric/dense.h"
#include "core/chance.h"
#include "core/sort.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    NUMBERS = DIG_HYPOTHESIS_NUMBERS,
    POINTS  = 500, // of the cloud
    SWEEPS  = 3,   // in which every point moves on, at each power
    COUNTED = 8,   // sweeps at the posterior itself, whose points are counted
    TAKEN   = POINTS * COUNTED,
};

// Accepted between these, a step is neither too short nor too long.
static const double few_accepted = 0.2, many_accepted = 0.4;

// How far templates are off, as a share of what an effect adds, is known to within a factor of e to
// this: 1 sigma of its logarithm.
static const double log_share = 2.0;

struct point {
    double x[NUMBERS];
    double misfit;
    double z[DIG_STEPS_MAX]; // of the batch's steps, less their middle
};

// A cloud of points that is distributed as (the likelihood)^power within the bounds.
struct cloud {
    struct dig_likelihood likelihood;
    double                low[NUMBERS], high[NUMBERS];
    double                added[DIG_TRAJECTORY_MAX * DIG_FEATURES]; // by the effects at the fit
    double                squares;                                  // of them; 0 without templates
    double                power;
    struct point          point[POINTS], old[POINTS];
    double                lower[NUMBERS * NUMBERS]; // L of the points' covariance = L L'
    double                reach;                    // a step is so many of it
    double                common[NUMBERS]; // 1 sigma of what no fit shows: dig_shifts_common()
    double                residual[DIG_LIKELIHOOD_RESIDUALS];
    double                taken[NUMBERS][TAKEN];
    double                z_sum[DIG_STEPS_MAX]; // over the points that were counted
    double                z_squares[DIG_STEPS_MAX * DIG_STEPS_MAX];
};

// What the effects add to each group, in the batch's amplitudes.
static void fill_added(const struct dig_likelihood *const l, const double x[],
                       double added[DIG_TRAJECTORY_MAX * DIG_FEATURES])
{
    for (size_t g = 0; g < l->batch->groups; g++) {
        const struct dig_group *const group = &l->batch->group[g];
        double *const                 of    = added + g * DIG_FEATURES;
        const struct dig_plain        plain = dig_plain_of(l->batch->soil, group->trajectory, x);
        (void)dig_forward_added(l->batch, g, &plain, l->hypothesis, x, of);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            of[f] /= group->amplitude[f / DIG_FEATURE_BINS];
        }
    }
}

// The templates' error is as large as at the fit. Where the effects add more or less of what they
// add there, it is another share of them, which is as likely as that.
static double misfit_of_share(const struct cloud *const c, const double x[])
{
    static const double nothing = 1e-6;
    const size_t        n       = c->likelihood.batch->groups * DIG_FEATURES;
    double              added[DIG_TRAJECTORY_MAX * DIG_FEATURES];
    if (!(c->squares > 0.0)) {
        return 0.0;
    }
    fill_added(&c->likelihood, x, added);
    return pow(log(fmax(dig_product(n, added, c->added) / c->squares, nothing)) / log_share, 2.0);
}

// Tells misfit and z of a point at its x.
static void look(struct cloud *const c, struct point *const point)
{
    const struct dig_likelihood *const l = &c->likelihood;
    double                             squares;
    dig_likelihood_residual(&c->likelihood, point->x, c->residual);
    point->misfit = dig_likelihood_misfit(l, c->residual, &squares) + misfit_of_share(c, point->x);
    memcpy(point->z, c->residual + l->residuals - l->steps, l->steps * sizeof point->z[0]);
}

static void spread_out(struct cloud *const c, uint64_t *const seed)
{
    for (size_t p = 0; p < POINTS; p++) {
        for (size_t j = 0; j < c->likelihood.numbers; j++) {
            c->point[p].x[j] = c->low[j] + (c->high[j] - c->low[j]) * dig_chance_uniform(seed);
        }
        look(c, &c->point[p]);
    }
    c->power = 0.0;
}

// The points' weights at a higher power; how many points of equal weight they are worth.
static double weigh(const struct cloud *const c, const double power, double weight[POINTS])
{
    double least   = INFINITY;
    double sum     = 0.0;
    double squares = 0.0;
    for (size_t p = 0; p < POINTS; p++) {
        least = fmin(least, c->point[p].misfit);
    }
    for (size_t p = 0; p < POINTS; p++) {
        weight[p] = exp(-0.5 * (power - c->power) * (c->point[p].misfit - least));
        sum += weight[p];
        squares += weight[p] * weight[p];
    }
    return sum * sum / squares;
}

// The highest power at which the points are worth half of what they are.
static double next_power(const struct cloud *const c, double weight[POINTS])
{
    double low  = c->power;
    double high = 1.0;
    if (weigh(c, high, weight) >= 0.5 * POINTS) {
        return high;
    }
    for (int half = 0; half < 20; half++) {
        const double middle                                        = 0.5 * (low + high);
        *(weigh(c, middle, weight) >= 0.5 * POINTS ? &low : &high) = middle;
    }
    return high;
}

// Draws the points anew by their weights, evenly: one of weight w comes w times, rounded.
static void draw_anew(struct cloud *const c, const double weight[POINTS], uint64_t *const seed)
{
    double sum = 0.0;
    for (size_t p = 0; p < POINTS; p++) {
        sum += weight[p];
    }
    const double first = dig_chance_uniform(seed);
    double       at    = weight[0]; // of the points up to from
    size_t       from  = 0;
    memcpy(c->old, c->point, sizeof c->old);
    for (size_t made = 0; made < POINTS; made++) {
        const double next = sum / POINTS * (first + (double)made);
        while (from + 1 < POINTS && !(next < at)) {
            at += weight[++from];
        }
        c->point[made] = c->old[from];
    }
}

// A number that is held, or of which all points agree, keeps a width that is nothing beside its
// bounds'.
static void measure_covariance(struct cloud *const c)
{
    const size_t n             = c->likelihood.numbers;
    double       mean[NUMBERS] = { 0.0 };
    for (size_t p = 0; p < POINTS; p++) {
        for (size_t j = 0; j < n; j++) {
            mean[j] += c->point[p].x[j] / POINTS;
        }
    }
    for (size_t j = 0; j < n; j++) {
        for (size_t k = 0; k <= j; k++) {
            double sum = 0.0;
            for (size_t p = 0; p < POINTS; p++) {
                const double *const x = c->point[p].x;
                sum += (x[j] - mean[j]) * (x[k] - mean[k]) / POINTS;
            }
            c->lower[j * n + k] = sum;
        }
        c->lower[j * n + j] += 1e-10 * fmax(pow(c->high[j] - c->low[j], 2.0), 1e-10);
    }
    dig_cholesky_sure(n, c->lower);
}

// Leaves bounds as a ray leaves a mirror, so that no place is favoured.
static double reflect(const double x, const double low, const double high)
{
    double at = x;
    for (int turn = 0; turn < 8 && (at < low || at > high); turn++) {
        at = at < low ? 2.0 * low - at : 2.0 * high - at;
    }
    return fmin(fmax(at, low), high);
}

// One step of Metropolis' for every point.
static void sweep(struct cloud *const c, uint64_t *const seed)
{
    const size_t n        = c->likelihood.numbers;
    double       accepted = 0.0;
    for (size_t p = 0; p < POINTS; p++) {
        struct point tried = { .misfit = 0.0 };
        for (size_t j = 0; j < n; j++) {
            tried.x[j] = c->reach * dig_chance_normal(seed);
        }
        dig_lower_multiply(n, c->lower, tried.x);
        for (size_t j = 0; j < n; j++) {
            tried.x[j] = reflect(c->point[p].x[j] + tried.x[j], c->low[j], c->high[j]);
        }
        look(c, &tried);
        if (dig_chance_uniform(seed) < exp(0.5 * c->power * (c->point[p].misfit - tried.misfit))) {
            c->point[p] = tried;
            accepted += 1.0 / POINTS;
        }
    }
    c->reach *= accepted < few_accepted ? 0.7 : (accepted > many_accepted ? 1.4 : 1.0);
}

// Counts z of all points.
static void count_z(struct cloud *const c)
{
    const size_t steps = c->likelihood.steps;
    for (size_t p = 0; p < POINTS; p++) {
        const double *const z = c->point[p].z;
        for (size_t k = 0; k < steps; k++) {
            c->z_sum[k] += z[k];
            for (size_t m = 0; m < steps; m++) {
                c->z_squares[k * steps + m] += z[k] * z[m];
            }
        }
    }
}

// At given numbers z has the covariance M^-1; with the numbers it moves as the points tell.
static void write_covariance(const struct cloud *const c, double covariance[])
{
    const struct dig_likelihood *const l = &c->likelihood;
    for (size_t k = 0; k < l->steps; k++) {
        double *const row = covariance + k * l->steps;
        memset(row, 0, l->steps * sizeof row[0]);
        row[k] = 1.0;
        dig_cholesky_solve(l->steps, l->step_lower, row);
        for (size_t m = 0; m < l->steps; m++) {
            row[m] += (c->z_squares[k * l->steps + m] - c->z_sum[k] * c->z_sum[m] / TAKEN) / TAKEN;
        }
    }
}

// From the whole of the bounds to the posterior.
static void anneal(struct cloud *const c, uint64_t seed)
{
    spread_out(c, &seed);
    while (c->power < 1.0) {
        double       weight[POINTS];
        const double power = next_power(c, weight);
        // Beyond all numbers no point outweighs another, and no power would ever be reached.
        if (!isfinite(weigh(c, power, weight))) {
            break;
        }
        draw_anew(c, weight, &seed);
        c->power = power;
        measure_covariance(c);
        for (int s = 0; s < SWEEPS; s++) {
            sweep(c, &seed);
        }
    }
    for (size_t s = 0; s < COUNTED; s++) {
        sweep(c, &seed);
        count_z(c);
        for (size_t p = 0; p < POINTS; p++) {
            for (size_t j = 0; j < c->likelihood.numbers; j++) {
                const double off =
                    c->common[j] > 0.0 ? c->common[j] * dig_chance_normal(&seed) : 0.0;
                c->taken[j][s * POINTS + p] =
                    reflect(c->point[p].x[j] + off, c->low[j], c->high[j]);
            }
        }
    }
}

// The shortest interval that holds nine points of ten. A bound is in it that the posterior leans
// on: less than a twentieth lies between, and more than a fiftieth within a tenth of the interval
// of it.
static void set_interval(struct cloud *const c, const size_t j, struct dig_fitted *const fitted)
{
    enum { INSIDE = TAKEN / 10 * 9, FEW = TAKEN / 20, SOME = TAKEN / 50 };
    double *const taken = c->taken[j];
    size_t        first = 0;
    dig_sort(TAKEN, taken);
    for (size_t i = 1; i + INSIDE <= TAKEN; i++) {
        const double wide = taken[i + INSIDE - 1] - taken[i];
        first             = wide < taken[first + INSIDE - 1] - taken[first] ? i : first;
    }
    const size_t last       = first + INSIDE - 1;
    const double near       = 0.1 * (taken[last] - taken[first]);
    const bool   leans_low  = first < FEW && taken[SOME] < c->low[j] + near;
    const bool   leans_high = TAKEN - 1 - last < FEW && taken[TAKEN - 1 - SOME] > c->high[j] - near;
    fitted->low[j]          = fmin(leans_low ? c->low[j] : taken[first], fitted->number[j]);
    fitted->high[j]         = fmax(leans_high ? c->high[j] : taken[last], fitted->number[j]);
}

void dig_posterior_intervals(const struct dig_batch *const batch, const uint64_t seed,
                             struct dig_fitted *const fitted, double covariance[])
{
    assert(batch != NULL && fitted != NULL);
    struct cloud c = { .power = 0.0 };
    dig_likelihood_init(&c.likelihood, batch, &fitted->hypothesis);
    dig_likelihood_weigh(&c.likelihood, fitted->number);
    dig_hypothesis_bounds(batch->soil, &fitted->hypothesis, c.low, c.high);
    dig_shifts_common(batch, &fitted->hypothesis, fitted->number, c.common);
    if (dig_shifts_templated(&fitted->hypothesis)) {
        fill_added(&c.likelihood, fitted->number, c.added);
        c.squares = dig_product(batch->groups * DIG_FEATURES, c.added, c.added);
    }
    c.reach = 2.4 / sqrt((double)c.likelihood.numbers);
    anneal(&c, seed);
    for (size_t j = 0; j < c.likelihood.numbers; j++) {
        set_interval(&c, j, fitted);
    }
    if (covariance != NULL) {
        write_covariance(&c, covariance);
    }
}
