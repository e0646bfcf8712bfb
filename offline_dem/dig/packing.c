#include "offline_dem/dig/packing.h"

#include "core/ground.h"
#include "core/units.h"
#include "offline_dem/law/random.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Cells that hold one grain at most: overlaps are within two cells around.
struct cells {
    double    low_m[3], edge_m;
    ptrdiff_t count[3];
    uint32_t *grain; // [cells] 1 + index, 0: free
};

size_t dig_packing_grains(const struct dig_scene *const scene)
{
    const struct dig_box *const box      = &scene->box;
    const double                d_m      = scene->material.diameter_m;
    const double                grain_m3 = DIG_PI / 6.0 * d_m * d_m * d_m;
    const double box_m3 = (box->x_max_m - box->x_min_m) * (box->y_max_m - box->y_min_m) *
                          (dig_scene_ground_max_m(scene) - box->z_min_m);
    return (size_t)floor(scene->packing.fill_factor * box_m3 / grain_m3);
}

static bool is_free(const struct cells *const cells, const ptrdiff_t at[3], const double p[3],
                    const double d_m, const double *const position[3])
{
    ptrdiff_t low[3];
    ptrdiff_t high[3];
    for (int a = 0; a < 3; a++) {
        low[a]  = at[a] > 2 ? at[a] - 2 : 0;
        high[a] = at[a] + 2 < cells->count[a] ? at[a] + 2 : cells->count[a] - 1;
    }
    for (ptrdiff_t iz = low[2]; iz <= high[2]; iz++) {
        for (ptrdiff_t iy = low[1]; iy <= high[1]; iy++) {
            for (ptrdiff_t ix = low[0]; ix <= high[0]; ix++) {
                const uint32_t g = cells->grain[ix + cells->count[0] * (iy + cells->count[1] * iz)];
                if (g == 0) {
                    continue;
                }
                const double dx = p[0] - position[0][g - 1];
                const double dy = p[1] - position[1][g - 1];
                const double dz = p[2] - position[2][g - 1];
                if (dx * dx + dy * dy + dz * dz < d_m * d_m) {
                    return false;
                }
            }
        }
    }
    return true;
}

static enum dig_status insert(struct cells *const cells, double high_m[3], const double d_m,
                              const uint64_t seed, const size_t n, double *const position[3])
{
    const double tallest_m = cells->low_m[2] + (high_m[2] - cells->low_m[2]) * DIG_PACKING_TALLEST;
    struct dig_random random = { .state = seed };
    for (size_t i = 0; i < n; i++) {
        int attempt = 0;
        for (; attempt < DIG_PACKING_ATTEMPTS; attempt++) {
            double    p[3];
            ptrdiff_t at[3];
            for (int a = 0; a < 3; a++) {
                p[a]  = dig_random_between(&random, cells->low_m[a], high_m[a]);
                at[a] = (ptrdiff_t)((p[a] - cells->low_m[a]) / cells->edge_m);
            }
            if (is_free(cells, at, p, d_m, (const double *const *)position)) {
                for (int a = 0; a < 3; a++) {
                    position[a][i] = p[a];
                }
                cells->grain[at[0] + cells->count[0] * (at[1] + cells->count[1] * at[2])] =
                    (uint32_t)(i + 1);
                break;
            }
        }
        if (attempt == DIG_PACKING_ATTEMPTS) {
            high_m[2] = cells->low_m[2] + (high_m[2] - cells->low_m[2]) * DIG_PACKING_GROWTH;
            if (high_m[2] > tallest_m) {
                return DIG_EUNREACHABLE;
            }
            i--; // the same grain again
        }
    }
    return DIG_OK;
}

enum dig_status dig_packing_insert(const struct dig_scene *const scene, const uint64_t seed,
                                   const size_t n, double x_m[], double y_m[], double z_m[])
{
    const struct dig_box *const box    = &scene->box;
    const double                d_m    = scene->material.diameter_m;
    const double                column = (dig_scene_ground_max_m(scene) - box->z_min_m) *
                          scene->packing.fill_factor / scene->packing.solid_fraction;
    double       high_m[3] = { box->x_max_m - 0.5 * d_m, box->y_max_m - 0.5 * d_m,
                               box->z_min_m + column - 0.5 * d_m };
    struct cells cells     = {
            .low_m  = { box->x_min_m + 0.5 * d_m, box->y_min_m + 0.5 * d_m, box->z_min_m + 0.5 * d_m },
            .edge_m = d_m / sqrt(3.0) * (1.0 - 1e-9),
    };
    size_t total = 1;
    for (int a = 0; a < 3; a++) {
        if (!(high_m[a] > cells.low_m[a])) {
            return DIG_EUNREACHABLE;
        }
        const double span_m = (high_m[a] - cells.low_m[a]) * (a == 2 ? DIG_PACKING_TALLEST : 1.0);
        cells.count[a]      = (ptrdiff_t)(span_m / cells.edge_m) + 1;
        total *= (size_t)cells.count[a];
    }
    cells.grain            = calloc(total, sizeof *cells.grain);
    double *const   made   = malloc((3 * n + 1) * sizeof *made);
    enum dig_status status = DIG_ENOMEM;
    if (cells.grain != NULL && made != NULL) {
        double *const position[3] = { made, made + n, made + 2 * n };
        status                    = insert(&cells, high_m, d_m, seed, n, position);
        if (status == DIG_OK) {
            memcpy(x_m, position[0], n * sizeof *x_m);
            memcpy(y_m, position[1], n * sizeof *y_m);
            memcpy(z_m, position[2], n * sizeof *z_m);
        }
    }
    free(cells.grain);
    free(made);
    return status;
}
