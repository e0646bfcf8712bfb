// Least squares within bounds for a handful of unknowns (Levenberg and Marquardt, differences for
// derivatives).

#ifndef DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H
#define DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H

#include "core/status.h"

#include <stddef.h>

#define DIG_LEVENBERG_UNKNOWNS 9

struct dig_levenberg {
    size_t unknowns, residuals;
    double low[DIG_LEVENBERG_UNKNOWNS], high[DIG_LEVENBERG_UNKNOWNS]; // low = high: held
    double step;                                                      // of the differences
    int    iterations;
    void (*residual)(void *context, const double x[], double r[]);
    void   *context;
    double *memory; // [residuals * (unknowns + 2)], the caller's
};

/// Improves x, which is put within the bounds first. *squares: the sum of squares at the end.
void dig_levenberg_run(const struct dig_levenberg *problem, double x[], double *squares);

#endif // DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H
