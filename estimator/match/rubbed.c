#include "estimator/match/rubbed.h"

#include <assert.h>
#include <math.h>

void dig_rubbed_add(const double x, const double v[const DIG_RUBS], struct dig_rubbed *const rubbed)
{
    for (size_t r = 0; r < DIG_RUBS; r++) {
        rubbed->b[r] += v[r] * x;
        for (size_t s = 0; s <= r; s++) {
            rubbed->a[r][s] += v[r] * v[s];
        }
    }
}

void dig_rubbed_join(struct dig_rubbed *const sum, const struct dig_rubbed *const more)
{
    for (size_t r = 0; r < DIG_RUBS; r++) {
        sum->b[r] += more->b[r];
        for (size_t s = 0; s <= r; s++) {
            sum->a[r][s] += more->a[r][s];
        }
    }
}

struct dig_rubbed_sums dig_rubbed_sum(const struct dig_rubbed *const rubbed, const double weight)
{
    assert(rubbed != NULL && weight >= 0.0);
    double                 lower[DIG_RUBS][DIG_RUBS]; // of 1 + A
    struct dig_rubbed_sums sums = { .log_det = 0.0 };
    double                 b[DIG_RUBS];
    for (size_t r = 0; r < DIG_RUBS; r++) {
        b[r] = weight * rubbed->b[r];
        for (size_t s = 0; s <= r; s++) {
            double rest = weight * rubbed->a[r][s] + (r == s ? 1.0 : 0.0);
            for (size_t m = 0; m < s; m++) {
                rest -= lower[r][m] * lower[s][m];
            }
            lower[r][s] = r == s ? sqrt(rest) : rest / lower[s][s];
            b[r] -= r == s ? 0.0 : lower[r][s] * b[s];
        }
        b[r] /= lower[r][r];
        sums.explained += b[r] * b[r];
        sums.log_det += 2.0 * log(lower[r][r]);
    }
    return sums;
}

double dig_rubbed_left2(const struct dig_rubbed *const rubbed, const double x2, const double floor2)
{
    const double explained = floor2 > 0.0 ? dig_rubbed_sum(rubbed, 1.0 / floor2).explained : 0.0;
    return explained > 0.0 ? fmax(x2 - floor2 * explained, 0.0) : x2;
}
