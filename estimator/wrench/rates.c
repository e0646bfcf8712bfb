#include "estimator/wrench/rates.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Sums of a parabola's normal equations over times u (about the window's middle) and values.
struct sums {
    double n, u1, u2, u3, u4;
    double y[DIG_JOINTS], uy[DIG_JOINTS], u2y[DIG_JOINTS];
};

static void add(struct sums *const s, const double u, const double joint_rad[DIG_JOINTS],
                const double about_rad[DIG_JOINTS])
{
    s->n += 1.0;
    s->u1 += u;
    s->u2 += u * u;
    s->u3 += u * u * u;
    s->u4 += u * u * u * u;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double y = joint_rad[j] - about_rad[j];
        s->y[j] += y;
        s->uy[j] += u * y;
        s->u2y[j] += u * u * y;
    }
}

// The parabola y = c0 + c1 u + c2 u^2 of each joint by Cramer's rule; its rates at u = at, and
// their noise from the inverse of the normal matrix.
static struct dig_rates fit(const struct sums *const s, const double at, const double sigma_rad)
{
    struct dig_rates none = { .velocity_sigma = 0.0 };
    const double     a00  = s->u2 * s->u4 - s->u3 * s->u3; // cofactors of the symmetric matrix
    const double     a01  = s->u2 * s->u3 - s->u1 * s->u4;
    const double     a02  = s->u1 * s->u3 - s->u2 * s->u2;
    const double     a11  = s->n * s->u4 - s->u2 * s->u2;
    const double     a12  = s->u1 * s->u2 - s->n * s->u3;
    const double     a22  = s->n * s->u2 - s->u1 * s->u1;
    const double     det  = s->n * a00 + s->u1 * a01 + s->u2 * a02;
    if (!(det > 0.0)) {
        return none;
    }
    struct dig_rates rates = {
        .velocity_sigma =
            sigma_rad * sqrt(fmax(a11 + 4.0 * at * a12 + 4.0 * at * at * a22, 0.0) / det),
        .acceleration_sigma = sigma_rad * 2.0 * sqrt(fmax(a22, 0.0) / det),
    };
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double c1 = (a01 * s->y[j] + a11 * s->uy[j] + a12 * s->u2y[j]) / det;
        const double c2 = (a02 * s->y[j] + a12 * s->uy[j] + a22 * s->u2y[j]) / det;

        rates.velocity_radps[j]      = c1 + 2.0 * c2 * at;
        rates.acceleration_radps2[j] = 2.0 * c2;
    }
    return rates;
}

static size_t slot(const struct dig_rates_filter *const filter, const size_t age)
{
    return (filter->head + DIG_RATES_MAX - age) % DIG_RATES_MAX;
}

struct dig_rates dig_rates_step(struct dig_rates_filter *const filter, const int64_t time_ns,
                                const double joint_rad[DIG_JOINTS], const double sigma_rad)
{
    assert(filter != NULL && filter->window_s > 0.0 && joint_rad != NULL);
    const struct dig_rates still = { .velocity_sigma = 0.0 };

    // Push, then drop what is older than the window.
    filter->head                  = (filter->head + 1) % DIG_RATES_MAX;
    filter->time_ns[filter->head] = time_ns;
    memcpy(filter->joint_rad[filter->head], joint_rad, sizeof filter->joint_rad[0]);
    filter->count        = filter->count < DIG_RATES_MAX ? filter->count + 1 : DIG_RATES_MAX;
    const int64_t oldest = time_ns - (int64_t)(1e9 * filter->window_s);
    while (filter->count > 1 && filter->time_ns[slot(filter, filter->count - 1)] < oldest) {
        filter->count--;
    }

    const int64_t first_ns = filter->time_ns[slot(filter, filter->count - 1)];
    const double  span_s   = 1e-9 * (double)(time_ns - first_ns);
    if (filter->count < DIG_RATES_LEAST || !(span_s >= 0.5 * filter->window_s)) {
        return still;
    }
    struct sums sums = { .n = 0.0 };
    for (size_t age = 0; age < filter->count; age++) {
        const size_t i = slot(filter, age);
        const double u = 1e-9 * (double)(filter->time_ns[i] - time_ns) + 0.5 * span_s;
        add(&sums, u, filter->joint_rad[i], joint_rad);
    }
    return fit(&sums, 0.5 * span_s, sigma_rad);
}

struct dig_rates dig_rates_at(const size_t at, const size_t n, const double time_s[],
                              const double joint_rad[], const double sigma_rad)
{
    assert(at < n && time_s != NULL && joint_rad != NULL);
    struct sums sums = { .n = 0.0 };
    for (size_t i = 0; i < n; i++) {
        add(&sums, time_s[i] - time_s[at], &joint_rad[DIG_JOINTS * i], &joint_rad[DIG_JOINTS * at]);
    }
    return n < DIG_RATES_LEAST ? (struct dig_rates){ .velocity_sigma = 0.0 }
                               : fit(&sums, 0.0, sigma_rad);
}

void dig_rates_centred(const size_t n, const double time_s[], const double joint_rad[],
                       const double half_s, const double sigma_rad, struct dig_rates rates[])
{
    assert(n == 0 || (time_s != NULL && joint_rad != NULL && rates != NULL));
    // Slightly wider, so that rounding does not drop a sample on one side alone.
    const double reach_s = half_s + 1e-6;
    size_t       first   = 0;
    for (size_t i = 0; i < n; i++) {
        while (time_s[first] < time_s[i] - reach_s) {
            first++;
        }
        size_t end = i;
        while (end < n && time_s[end] <= time_s[i] + reach_s) {
            end++;
        }
        rates[i] = dig_rates_at(i - first, end - first, &time_s[first],
                                &joint_rad[DIG_JOINTS * first], sigma_rad);
    }
}

struct dig_rates dig_rates_between(const struct dig_rates *const a, const struct dig_rates *const b,
                                   const double f)
{
    struct dig_rates out = *a;
    out.velocity_sigma += f * (b->velocity_sigma - a->velocity_sigma);
    out.acceleration_sigma += f * (b->acceleration_sigma - a->acceleration_sigma);
    for (int j = 0; j < DIG_JOINTS; j++) {
        out.velocity_radps[j] += f * (b->velocity_radps[j] - a->velocity_radps[j]);
        out.acceleration_radps2[j] += f * (b->acceleration_radps2[j] - a->acceleration_radps2[j]);
    }
    return out;
}
