#include "core/sort.h"

#include <assert.h>
#include <stdlib.h>

static int ascending(const void *const left, const void *const right)
{
    const double a = *(const double *)left;
    const double b = *(const double *)right;
    return (a > b) - (a < b);
}

void dig_sort(const size_t n, double value[])
{
    assert(n == 0 || value != NULL);
    if (n > 0) {
        qsort(value, n, sizeof value[0], ascending);
    }
}

double dig_sort_median(const size_t n, double value[])
{
    assert(n > 0);
    dig_sort(n, value);
    return value[n / 2];
}
