// The grains near one, from rows of cells: eight at a time. Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_NEAR_SEARCH_H
#define DIG_OFFLINE_DEM_KERNEL_NEAR_SEARCH_H

#include "offline_dem/kernel/kernel.h"
#include "offline_dem/kernel/rows.h"

#include <stddef.h>
#include <stdint.h>

#define NEAR_LANES DIG_NEAR_PADDING

// Whether a near grain is listed under the query's. The grain with the larger margin searches far
// enough to find the pair. No branch: most grains of a row are not near.
INLINED void look_near(const struct dig_near_query *const  query,
                       const struct dig_near_grains *const in, const size_t first,
                       uint32_t is_listed[NEAR_LANES])
{
    const struct dig_near_query q = *query;
#pragma omp simd simdlen(8)
    for (size_t l = 0; l < NEAR_LANES; l++) {
        const size_t k        = first + l;
        const double dx_m     = q.x_m[0] - in->x_m[k];
        const double dy_m     = q.x_m[1] - in->y_m[k];
        const double dz_m     = q.x_m[2] - in->z_m[k];
        const double margin_m = in->margin_m[k];
        const double reach_m  = q.own_m + in->radius_m[k] + margin_m;
        const int    is_near  = dx_m * dx_m + dy_m * dy_m + dz_m * dz_m < reach_m * reach_m;
        const int    is_first =
            (margin_m < q.margin_m) | ((margin_m <= q.margin_m) & (in->grain[k] > q.grain));
        const int is_nearest = (dy_m >= -q.half_m) & (dy_m < q.half_m);
        is_listed[l]         = (uint32_t)(is_near & is_first & is_nearest);
    }
}

// Every grain is written and only listed ones are counted.
INLINED size_t near_body(const struct dig_near_query *const  query,
                         const struct dig_near_grains *const in, const size_t rows,
                         const struct dig_near_row row[], uint32_t other[])
{
    size_t count = 0;
    for (size_t r = 0; r < rows; r++) {
        for (size_t k = row[r].first; k < row[r].end; k += NEAR_LANES) {
            uint32_t is_listed[NEAR_LANES];
            look_near(query, in, k, is_listed);
            const size_t left = row[r].end - k;
            for (size_t l = 0; l < (left < NEAR_LANES ? left : NEAR_LANES); l++) {
                other[count] = in->grain[k + l];
                count += is_listed[l];
            }
        }
    }
    return count;
}

#endif // DIG_OFFLINE_DEM_KERNEL_NEAR_SEARCH_H
