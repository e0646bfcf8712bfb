#include "core/chance.h"

#include "core/sort.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>

static uint64_t next(uint64_t *const state)
{
    *state += 0x9E3779B97F4A7C15U;
    uint64_t z = *state;
    z          = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z          = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

double dig_chance_uniform(uint64_t *const state)
{
    return (double)(next(state) >> 11) * 0x1.0p-53;
}

double dig_chance_between(uint64_t *const state, const double low, const double high)
{
    return low + (high - low) * dig_chance_uniform(state);
}

double dig_chance_normal(uint64_t *const state)
{
    const double u = 1.0 - dig_chance_uniform(state);
    const double v = dig_chance_uniform(state);
    return sqrt(-2.0 * log(u)) * cos(2.0 * DIG_PI * v);
}

size_t dig_chance_index(uint64_t *const state, const size_t n)
{
    assert(n > 0);
    return (size_t)(next(state) % n);
}

void dig_chance_interval(const size_t n, double drawn[], double *const low, double *const high)
{
    assert(n > 0 && drawn != NULL && low != NULL && high != NULL);
    dig_sort(n, drawn);
    *low  = drawn[n / 20];
    *high = drawn[n - 1 - n / 20];
}

enum { TERMS_MAX = 1000 };

static const double precise = 1e-12;
static const double tiny    = 1e-300;

// P(a, x) by its series, for x < a + 1.
static double lower_series(const double a, const double x)
{
    double term = 1.0 / a;
    double sum  = term;
    for (int n = 1; n < TERMS_MAX && term > precise * sum; n++) {
        term *= x / (a + (double)n);
        sum += term;
    }
    return sum * exp(a * log(x) - x - lgamma(a));
}

// Q(a, x) by Lentz's continued fraction, for x >= a + 1.
static double upper_fraction(const double a, const double x)
{
    double b = x + 1.0 - a;
    double c = 1.0 / tiny;
    double d = 1.0 / b;
    double h = d;
    for (int n = 1; n < TERMS_MAX; n++) {
        const double by = -(double)n * ((double)n - a);
        b += 2.0;
        d                  = 1.0 / (by * d + b);
        c                  = b + by / c;
        const double delta = c * d;
        h *= delta;
        if (fabs(delta - 1.0) < precise) {
            break;
        }
    }
    return h * exp(a * log(x) - x - lgamma(a));
}

static double upper_gamma(const double a, const double x)
{
    if (!(x > 0.0)) {
        return 1.0;
    }
    return x < a + 1.0 ? 1.0 - lower_series(a, x) : upper_fraction(a, x);
}

double dig_chance_gamma_tail(const double mean, const double variance, const double x)
{
    assert(mean > 0.0 && variance > 0.0);
    return fmin(fmax(upper_gamma(mean * mean / variance, x * mean / variance), 0.0), 1.0);
}
