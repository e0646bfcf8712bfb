// Numbers in order.

#ifndef DIG_CORE_SORT_H
#define DIG_CORE_SORT_H

#include <stddef.h>

/// Sorts n numbers, none of them NaN, the smallest first. Not for the loop: qsort() may allocate.
void dig_sort(size_t n, double value[]);

/// Sorts n > 0 numbers; the middle one, of an even n the upper of both.
double dig_sort_median(size_t n, double value[]);

#endif // DIG_CORE_SORT_H
