#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>

double dig_product(const size_t n, const double a[], const double b[])
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

// Four sums side by side, of which none waits for another.
static inline double dot(const size_t n, const double a[], const double b[])
{
    double sum[4] = { 0.0 };
    size_t i      = 0;
    for (; i + 4 <= n; i += 4) {
        for (size_t k = 0; k < 4; k++) {
            sum[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < n; i++) {
        sum[0] += a[i] * b[i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// Column by column: what a row needs was not stored just before.
DIG_VECTORS enum dig_status dig_cholesky(const size_t n, double a[])
{
    assert(a != NULL);
    for (size_t j = 0; j < n; j++) {
        const double left = a[j * n + j] - dot(j, a + j * n, a + j * n);
        if (!(left > 0.0)) {
            return DIG_EINVAL;
        }
        a[j * n + j] = sqrt(left);
        for (size_t i = j + 1; i < n; i++) {
            const double sum = a[i * n + j] - dot(j, a + i * n, a + j * n);
            a[i * n + j]     = sum / a[j * n + j];
        }
    }
    return DIG_OK;
}

void dig_cholesky_sure(const size_t n, double a[])
{
    const enum dig_status status = dig_cholesky(n, a);
    assert(status == DIG_OK);
    (void)status;
}

DIG_VECTORS void dig_lower_solve(const size_t n, const double l[], double b[])
{
    for (size_t i = 0; i < n; i++) {
        b[i] = (b[i] - dot(i, l + i * n, b)) / l[i * n + i];
    }
}

DIG_VECTORS void dig_cholesky_solve(const size_t n, const double l[], double b[])
{
    dig_lower_solve(n, l, b);
    // By columns of the transposed, which are rows of l.
    for (size_t i = n; i-- > 0;) {
        const double *const row = l + i * n;
        b[i] /= row[i];
        for (size_t k = 0; k < i; k++) {
            b[k] -= row[k] * b[i];
        }
    }
}

DIG_VECTORS void dig_lower_multiply(const size_t n, const double l[], double b[])
{
    for (size_t i = n; i-- > 0;) {
        b[i] = dot(i + 1, l + i * n, b);
    }
}

// Row by row: what is to the left of the diagonal times the rows above, which are inverted already.
DIG_VECTORS void dig_lower_invert(const size_t n, const double l[], double inverse[])
{
    for (size_t i = 0; i < n; i++) {
        double *const row = inverse + i * n;
        for (size_t j = 0; j < i; j++) {
            row[j] = 0.0;
        }
        for (size_t k = 0; k < i; k++) {
            const double times = l[i * n + k] / l[i * n + i];
            for (size_t j = 0; j <= k; j++) {
                row[j] -= times * inverse[k * n + j];
            }
        }
        row[i] = 1.0 / l[i * n + i];
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
