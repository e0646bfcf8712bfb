// Least squares within bounds for a handful of unknowns: Levenberg and Marquardt, with derivatives
// by one-sided differences.

#ifndef DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H
#define DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H

#include "core/status.h"

#include <stddef.h>

#define DIG_LEVENBERG_UNKNOWNS 9

struct dig_levenberg {
    size_t unknowns, residuals;
    double low[DIG_LEVENBERG_UNKNOWNS], high[DIG_LEVENBERG_UNKNOWNS]; // low = high: held
    double step;       // of the differences, the same for every unknown
    int    iterations; // at most
    // Writes r[residuals] at x[unknowns]; x is within the bounds.
    void (*residual)(void *context, const double x[], double r[]);
    void   *context;
    double *memory; // [residuals * (unknowns + 2)], the caller's
};

/// Improves x, which is put within the bounds first, until an iteration lowers the sum of squares
/// by less than 0.001. *squares: that sum at the end. It cannot fail; x stays where no step helps.
/// One iteration calls residual once for each unknown, and up to six times to step.
void dig_levenberg_run(const struct dig_levenberg *problem, double x[], double *squares);

#endif // DIG_CLOSED_LOOP_NUMERIC_LEVENBERG_H
