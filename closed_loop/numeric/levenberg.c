#include "closed_loop/numeric/levenberg.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { SQUARE = DIG_LEVENBERG_UNKNOWNS * DIG_LEVENBERG_UNKNOWNS };

static const double enough = 1e-3; // a fall of the sum of squares that is none

static void clip(const struct dig_levenberg *const p, double x[])
{
    for (size_t j = 0; j < p->unknowns; j++) {
        x[j] = fmin(fmax(x[j], p->low[j]), p->high[j]);
    }
}

// Columns of the Jacobian by differences that stay within the bounds.
static void differentiate(const struct dig_levenberg *const p, const double x[], const double r[],
                          double jacobian[])
{
    // Backwards: numbers of effects first, while the caller may still know the gravel's plain dig.
    for (size_t j = p->unknowns; j-- > 0;) {
        double *const column = jacobian + j * p->residuals;
        double        moved[DIG_LEVENBERG_UNKNOWNS];
        memcpy(moved, x, p->unknowns * sizeof moved[0]);
        const double step = x[j] + p->step <= p->high[j] ? p->step : -p->step;
        moved[j] += step;
        if (!(p->high[j] > p->low[j])) {
            memset(column, 0, p->residuals * sizeof column[0]);
            continue;
        }
        p->residual(p->context, moved, column);
        for (size_t i = 0; i < p->residuals; i++) {
            column[i] = (column[i] - r[i]) / step;
        }
    }
}

// J'J and J'r without the unknowns that are held or press against a bound.
static void normal_equations(const struct dig_levenberg *const p, const double x[],
                             const double r[], const double jacobian[], double normal[],
                             double gradient[])
{
    const size_t n = p->unknowns;
    bool         held[DIG_LEVENBERG_UNKNOWNS];
    for (size_t j = 0; j < n; j++) {
        gradient[j] = dig_product(p->residuals, jacobian + j * p->residuals, r);
        held[j]     = !(p->high[j] > p->low[j]) || (x[j] <= p->low[j] && gradient[j] > 0.0) ||
                  (x[j] >= p->high[j] && gradient[j] < 0.0);
        gradient[j] = held[j] ? 0.0 : gradient[j];
    }
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b <= a; b++) {
            const double sum  = held[a] || held[b]
                                    ? 0.0
                                    : dig_product(p->residuals, jacobian + a * p->residuals,
                                                  jacobian + b * p->residuals);
            normal[a * n + b] = sum;
            normal[b * n + a] = sum;
        }
    }
}

// One damped step from x; false when it makes nothing better.
static bool take_step(const struct dig_levenberg *const p, const double normal[],
                      const double gradient[], const double damping, double x[], double r[],
                      double *const squares)
{
    const size_t n = p->unknowns;
    double       damped[SQUARE];
    double       step[DIG_LEVENBERG_UNKNOWNS];
    memcpy(damped, normal, n * n * sizeof damped[0]);
    for (size_t j = 0; j < n; j++) {
        const double diagonal = normal[j * n + j];
        damped[j * n + j]     = diagonal > 0.0 ? diagonal * (1.0 + damping) + 1e-9 : 1.0;
        step[j]               = -gradient[j];
    }
    if (dig_cholesky(n, damped) != DIG_OK) {
        return false;
    }
    dig_cholesky_solve(n, damped, step);
    double tried[DIG_LEVENBERG_UNKNOWNS];
    for (size_t j = 0; j < n; j++) {
        tried[j] = x[j] + step[j];
    }
    clip(p, tried);
    p->residual(p->context, tried, r);
    const double there = dig_product(p->residuals, r, r);
    if (!(there < *squares)) {
        return false;
    }
    memcpy(x, tried, n * sizeof x[0]);
    *squares = there;
    return true;
}

void dig_levenberg_run(const struct dig_levenberg *const problem, double x[], double *const squares)
{
    assert(problem->unknowns <= DIG_LEVENBERG_UNKNOWNS);
    double *const r                                = problem->memory;
    double *const tried                            = r + problem->residuals;
    double *const jacobian                         = tried + problem->residuals;
    double        gradient[DIG_LEVENBERG_UNKNOWNS] = { 0.0 };
    double        product[SQUARE]                  = { 0.0 };
    double        damping                          = 1e-3;
    bool          better                           = true;
    clip(problem, x);
    problem->residual(problem->context, x, r);
    double sum = dig_product(problem->residuals, r, r);
    for (int i = 0; i < problem->iterations && better; i++) {
        differentiate(problem, x, r, jacobian);
        normal_equations(problem, x, r, jacobian, product, gradient);
        const double before = sum;
        better              = false;
        for (int tries = 0; tries < 6 && !better; tries++) {
            better = take_step(problem, product, gradient, damping, x, tried, &sum);
            damping *= better ? 0.2 : 10.0;
        }
        if (better) {
            memcpy(r, tried, problem->residuals * sizeof r[0]);
        }
        if (before - sum < enough) {
            break;
        }
    }
    *squares = sum;
}
