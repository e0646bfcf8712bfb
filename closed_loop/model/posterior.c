#include "closed_loop/model/posterior.h"

#include "closed_loop/model/likelihood.h"
#include "closed_loop/numeric/chance.h"
#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    NUMBERS = DIG_HYPOTHESIS_NUMBERS,
    SETTLE  = 500,  // steps, in which the walk learns how far to go
    STEPS   = 4000, // that are counted
};

// The share of steps that is best taken in some dimensions (Gelman and others 1996).
static const double best_taken = 0.3;

struct walk {
    struct dig_likelihood likelihood;
    double                low[NUMBERS], high[NUMBERS];
    double                lower[NUMBERS * NUMBERS]; // of the steps' covariance
    double                reach;                    // times this
    double                residual[DIG_LIKELIHOOD_RESIDUALS];
    double                moved[DIG_LIKELIHOOD_RESIDUALS * NUMBERS];
    double                taken[NUMBERS][STEPS];
};

static double misfit_at(struct walk *const w, const double x[])
{
    double squares;
    dig_likelihood_residual(&w->likelihood, x, w->residual);
    return dig_likelihood_misfit(&w->likelihood, w->residual, &squares);
}

// The steps' covariance: the inverse of the curvature, with a prior as wide as the bounds. A number
// that is held has no width and takes no step.
static void measure_curvature(struct walk *const w, const double x[])
{
    static const double step = 1e-3;
    const size_t        n    = w->likelihood.numbers;
    const size_t        rows = w->likelihood.residuals;
    double              a[NUMBERS * NUMBERS];
    (void)misfit_at(w, x);
    for (size_t j = 0; j < n; j++) {
        double       there[NUMBERS];
        const double by = x[j] + step <= w->high[j] ? step : -step;
        memcpy(there, x, n * sizeof there[0]);
        there[j] += w->high[j] > w->low[j] ? by : 0.0;
        dig_likelihood_residual(&w->likelihood, there, w->moved + j * rows);
        for (size_t i = 0; i < rows; i++) {
            w->moved[j * rows + i] = (w->moved[j * rows + i] - w->residual[i]) / by;
        }
    }
    for (size_t j = 0; j < n; j++) {
        for (size_t k = 0; k <= j; k++) {
            a[j * n + k] = 0.0;
            for (size_t i = 0; i < rows; i++) {
                a[j * n + k] += w->moved[j * rows + i] * w->moved[k * rows + i];
            }
        }
        a[j * n + j] += 12.0 / pow(fmax(w->high[j] - w->low[j], 1e-6), 2.0);
    }
    // With a = L L', a step L'^-1 z has the covariance a^-1.
    const enum dig_status status = dig_cholesky(n, a);
    assert(status == DIG_OK);
    (void)status;
    memcpy(w->lower, a, sizeof a);
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

static void propose(const struct walk *const w, const double x[], uint64_t *const seed,
                    double tried[])
{
    const size_t n = w->likelihood.numbers;
    double       step[NUMBERS];
    for (size_t j = 0; j < n; j++) {
        step[j] = dig_chance_normal(seed);
    }
    dig_lower_transposed_solve(n, w->lower, step);
    for (size_t j = 0; j < n; j++) {
        tried[j] = reflect(x[j] + w->reach * step[j], w->low[j], w->high[j]);
    }
}

static void run(struct walk *const w, const double start[], uint64_t seed)
{
    const size_t n = w->likelihood.numbers;
    double       x[NUMBERS];
    double       misfit = misfit_at(w, start);
    memcpy(x, start, n * sizeof x[0]);
    for (int i = -SETTLE; i < STEPS; i++) {
        double tried[NUMBERS];
        propose(w, x, &seed, tried);
        const double there = misfit_at(w, tried);
        const bool   take  = dig_chance_uniform(&seed) < exp(0.5 * (misfit - there));
        if (take) {
            memcpy(x, tried, n * sizeof x[0]);
            misfit = there;
        }
        if (i < 0) {
            w->reach *= exp((take ? 1.0 - best_taken : -best_taken) * 0.05);
        }
        for (size_t j = 0; i >= 0 && j < n; j++) {
            w->taken[j][i] = x[j];
        }
    }
}

static int ascending(const void *const a, const void *const b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The shortest interval that holds nine steps of ten. A bound is in it that the posterior leans on:
// less than a twentieth lies between, and more than a fiftieth within a tenth of the interval of
// it.
static void set_interval(struct walk *const w, const size_t j, struct dig_fitted *const fitted)
{
    enum { INSIDE = STEPS / 10 * 9, FEW = STEPS / 20, SOME = STEPS / 50 };
    double *const taken = w->taken[j];
    size_t        first = 0;
    qsort(taken, STEPS, sizeof taken[0], ascending);
    for (size_t i = 1; i + INSIDE <= STEPS; i++) {
        const double wide = taken[i + INSIDE - 1] - taken[i];
        first             = wide < taken[first + INSIDE - 1] - taken[first] ? i : first;
    }
    const size_t last       = first + INSIDE - 1;
    const double near       = 0.1 * (taken[last] - taken[first]);
    const bool   leans_low  = first < FEW && taken[SOME] < w->low[j] + near;
    const bool   leans_high = STEPS - 1 - last < FEW && taken[STEPS - 1 - SOME] > w->high[j] - near;
    fitted->low[j]          = fmin(leans_low ? w->low[j] : taken[first], fitted->number[j]);
    fitted->high[j]         = fmax(leans_high ? w->high[j] : taken[last], fitted->number[j]);
}

static void begin(struct walk *const w, const struct dig_whitened_digs *const batch,
                  const struct dig_soil *const soil, const struct dig_fitted *const fitted)
{
    dig_likelihood_init(&w->likelihood, batch, soil, &fitted->hypothesis);
    dig_likelihood_weigh(&w->likelihood, fitted->number);
    dig_hypothesis_bounds(soil, &fitted->hypothesis, w->low, w->high);
    w->reach = 2.4 / sqrt((double)w->likelihood.numbers);
    measure_curvature(w, fitted->number);
}

enum dig_status dig_posterior_intervals(const struct dig_whitened_digs *const batch,
                                        const struct dig_soil *const soil, const uint64_t seed,
                                        struct dig_fitted *const fitted)
{
    assert(batch != NULL && soil != NULL && fitted != NULL);
    struct walk *const w = malloc(sizeof *w);
    if (w == NULL) {
        return DIG_ENOMEM;
    }
    begin(w, batch, soil, fitted);
    run(w, fitted->number, seed);
    for (size_t j = 0; j < w->likelihood.numbers; j++) {
        set_interval(w, j, fitted);
    }
    free(w);
    return DIG_OK;
}

// At given numbers z has the covariance M^-1; with the numbers it moves as the residuals' tail
// says.
static void add_numbers_share(const struct walk *const w, const double z_of[], double covariance[])
{
    const struct dig_likelihood *const l = &w->likelihood;
    for (size_t k = 0; k < l->steps; k++) {
        double moves[NUMBERS];
        for (size_t j = 0; j < l->numbers; j++) {
            moves[j] = z_of[j * l->residuals + k];
        }
        dig_lower_solve(l->numbers, w->lower, moves);
        dig_lower_transposed_solve(l->numbers, w->lower, moves);
        for (size_t m = 0; m < l->steps; m++) {
            for (size_t j = 0; j < l->numbers; j++) {
                covariance[k * l->steps + m] += moves[j] * z_of[j * l->residuals + m];
            }
        }
    }
}

enum dig_status dig_posterior_steps(const struct dig_whitened_digs *const batch,
                                    const struct dig_soil *const          soil,
                                    const struct dig_fitted *const fitted, double covariance[])
{
    assert(batch != NULL && soil != NULL && fitted != NULL && covariance != NULL);
    struct walk *const w = malloc(sizeof *w);
    if (w == NULL) {
        return DIG_ENOMEM;
    }
    begin(w, batch, soil, fitted);
    const struct dig_likelihood *const l = &w->likelihood;
    for (size_t k = 0; k < l->steps; k++) {
        double *const row = covariance + k * l->steps;
        memset(row, 0, l->steps * sizeof row[0]);
        row[k] = 1.0;
        dig_lower_solve(l->steps, l->step_lower, row);
        dig_lower_transposed_solve(l->steps, l->step_lower, row);
    }
    add_numbers_share(w, w->moved + l->residuals - l->steps, covariance);
    free(w);
    return DIG_OK;
}
