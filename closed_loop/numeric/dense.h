// Small dense linear algebra: symmetric positive definite systems of a few dozen unknowns, row
// major, lower triangles.

#ifndef DIG_CLOSED_LOOP_NUMERIC_DENSE_H
#define DIG_CLOSED_LOOP_NUMERIC_DENSE_H

#include "core/status.h"

#include <stddef.h>
#include <string.h>

/// The product of two vectors, summed from the first element on.
double dig_product(size_t n, const double a[], const double b[]);

/// Overwrites the lower triangle of the n x n matrix a with L of a = L L'; what stands above the
/// diagonal is neither read nor written. DIG_EINVAL when a is not positive definite; a is then
/// unspecified. O(n^3 / 3).
DIG_MUST_CHECK enum dig_status dig_cholesky(size_t n, double a[]);

/// The same of one that is positive definite by how it was made.
void dig_cholesky_sure(size_t n, double a[]);

/// Solves L x = b in place: x takes b's place. O(n^2 / 2).
void dig_lower_solve(size_t n, const double l[], double b[]);

/// Solves L L' x = b in place. O(n^2).
void dig_cholesky_solve(size_t n, const double l[], double b[]);

/// x = L b, in place.
void dig_lower_multiply(size_t n, const double l[], double b[]);

/// The lower triangle of L^-1, for who solves again and again: a product takes a third of a solve's
/// time. inverse is another matrix than l. O(n^3 / 3).
void dig_lower_invert(size_t n, const double l[], double inverse[]);

/// 2 sum log L_ii: the logarithm of the determinant of L L'.
double dig_lower_log_det(size_t n, const double l[]);

// Loops compiled once for each width of vector that a processor may have, chosen when the program
// starts. No sum changes its order and no product is fused, so all give the same bits.
// A sanitizer is not ready yet when the choice is made.
#if defined __x86_64__ && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define DIG_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DIG_VECTORS
#endif

#define DIG_ROWS_AT_ONCE 10 // columns, which a compiler keeps in registers

/// Rows of a matrix added up, in their order, the innermost of all that is fitted to digs: out[c] =
/// sum over k < rows of x[k] m[k * columns + c], of so many columns.
static inline void dig_rows_add(const size_t rows, const double x[], const size_t columns,
                                const double m[], double out[DIG_ROWS_AT_ONCE])
{
    double sum[DIG_ROWS_AT_ONCE] = { 0.0 };
    for (size_t k = 0; k < rows; k++) {
        for (size_t c = 0; c < DIG_ROWS_AT_ONCE; c++) {
            sum[c] += x[k] * m[k * columns + c];
        }
    }
    memcpy(out, sum, sizeof sum);
}

#endif // DIG_CLOSED_LOOP_NUMERIC_DENSE_H
