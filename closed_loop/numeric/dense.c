#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>

enum dig_status dig_cholesky(const size_t n, double a[])
{
    assert(a != NULL);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            double sum = a[i * n + j];
            for (size_t k = 0; k < j; k++) {
                sum -= a[i * n + k] * a[j * n + k];
            }
            if (i > j) {
                a[i * n + j] = sum / a[j * n + j];
            } else if (sum > 0.0) {
                a[i * n + i] = sqrt(sum);
            } else {
                return DIG_EINVAL;
            }
        }
    }
    return DIG_OK;
}

// By columns: what each unknown takes off the others does not wait for one another.
void dig_lower_solve(const size_t n, const double l[], double b[])
{
    for (size_t k = 0; k < n; k++) {
        const double known = b[k] / l[k * n + k];
        for (size_t i = k + 1; i < n; i++) {
            b[i] -= l[i * n + k] * known;
        }
        b[k] = known;
    }
}

void dig_lower_transposed_solve(const size_t n, const double l[], double b[])
{
    for (size_t i = n; i-- > 0;) {
        double sum = b[i];
        for (size_t k = i + 1; k < n; k++) {
            sum -= l[k * n + i] * b[k];
        }
        b[i] = sum / l[i * n + i];
    }
}

void dig_lower_multiply(const size_t n, const double l[], double b[])
{
    for (size_t i = n; i-- > 0;) {
        double sum = 0.0;
        for (size_t k = 0; k <= i; k++) {
            sum += l[i * n + k] * b[k];
        }
        b[i] = sum;
    }
}

double dig_lower_log_det(const size_t n, const double l[])
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += 2.0 * log(l[i * n + i]);
    }
    return sum;
}
