#include "closed_loop/fit/posterior.h"

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS = DIG_HYPOTHESIS_NUMBERS };

struct curvature {
    struct dig_likelihood likelihood;
    double                residual[DIG_LIKELIHOOD_RESIDUALS];
    double                slope[DIG_LIKELIHOOD_RESIDUALS * NUMBERS]; // [number][residual]
    double                lower[NUMBERS * NUMBERS];                  // L of L L' = J'J and a prior
};

// The residuals' slopes at x, and their squares with a prior as wide as the bounds: a number that
// is held has no width.
static void measure(struct curvature *const c, const double x[], const double low[],
                    const double high[])
{
    static const double step = 1e-3;
    const size_t        n    = c->likelihood.numbers;
    const size_t        rows = c->likelihood.residuals;
    dig_likelihood_weigh(&c->likelihood, x);
    dig_likelihood_residual(&c->likelihood, x, c->residual);
    for (size_t j = 0; j < n; j++) {
        double       there[NUMBERS];
        const double by = x[j] + step <= high[j] ? step : -step;
        memcpy(there, x, n * sizeof there[0]);
        there[j] += high[j] > low[j] ? by : 0.0;
        dig_likelihood_residual(&c->likelihood, there, c->slope + j * rows);
        for (size_t i = 0; i < rows; i++) {
            c->slope[j * rows + i] = (c->slope[j * rows + i] - c->residual[i]) / by;
        }
    }
    for (size_t j = 0; j < n; j++) {
        for (size_t k = 0; k <= j; k++) {
            c->lower[j * n + k] = 0.0;
            for (size_t i = 0; i < rows; i++) {
                c->lower[j * n + k] += c->slope[j * rows + i] * c->slope[k * rows + i];
            }
        }
        c->lower[j * n + j] += 12.0 / pow(fmax(high[j] - low[j], 1e-6), 2.0);
    }
    const enum dig_status status = dig_cholesky(n, c->lower);
    assert(status == DIG_OK);
    (void)status;
}

// At given numbers z has the covariance M^-1; with the numbers it moves as the residuals' tail
// says.
static void add_numbers_share(const struct curvature *const c, double covariance[])
{
    const struct dig_likelihood *const l    = &c->likelihood;
    const double *const                z_of = c->slope + l->residuals - l->steps;
    for (size_t k = 0; k < l->steps; k++) {
        double moves[NUMBERS];
        for (size_t j = 0; j < l->numbers; j++) {
            moves[j] = z_of[j * l->residuals + k];
        }
        dig_lower_solve(l->numbers, c->lower, moves);
        dig_lower_transposed_solve(l->numbers, c->lower, moves);
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
    struct curvature *const c = malloc(sizeof *c);
    if (c == NULL) {
        return DIG_ENOMEM;
    }
    double low[NUMBERS];
    double high[NUMBERS];
    dig_likelihood_init(&c->likelihood, batch, soil, &fitted->hypothesis);
    dig_hypothesis_bounds(soil, &fitted->hypothesis, low, high);
    measure(c, fitted->number, low, high);
    const struct dig_likelihood *const l = &c->likelihood;
    for (size_t k = 0; k < l->steps; k++) {
        double *const row = covariance + k * l->steps;
        memset(row, 0, l->steps * sizeof row[0]);
        row[k] = 1.0;
        dig_lower_solve(l->steps, l->step_lower, row);
        dig_lower_transposed_solve(l->steps, l->step_lower, row);
    }
    add_numbers_share(c, covariance);
    free(c);
    return DIG_OK;
}
