// Loops compiled once for each width of vector that a processor may have, chosen when the program
// starts. No sum changes its order and no product is fused, so all give the same bits.

#ifndef DIG_CLOSED_LOOP_NUMERIC_VECTORS_H
#define DIG_CLOSED_LOOP_NUMERIC_VECTORS_H

#include <stddef.h>
#include <string.h>

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

#endif // DIG_CLOSED_LOOP_NUMERIC_VECTORS_H
