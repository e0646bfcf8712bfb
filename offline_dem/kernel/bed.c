#include "offline_dem/kernel/bed.h"

#include <stdlib.h>

enum dig_status dig_bed_create(const size_t grains, const bool materials, const bool clumps,
                               struct dig_bed *const bed)
{
    struct dig_bed made = {
        .grains   = grains,
        .x_m      = calloc(grains + 1, sizeof *made.x_m),
        .y_m      = calloc(grains + 1, sizeof *made.y_m),
        .z_m      = calloc(grains + 1, sizeof *made.z_m),
        .radius_m = calloc(grains + 1, sizeof *made.radius_m),
        .material = materials ? calloc(grains + 1, sizeof *made.material) : NULL,
        .clump    = clumps ? calloc(grains + 1, sizeof *made.clump) : NULL,
    };
    if (made.x_m == NULL || made.y_m == NULL || made.z_m == NULL || made.radius_m == NULL ||
        (materials && made.material == NULL) || (clumps && made.clump == NULL)) {
        dig_bed_finish(&made);
        return DIG_ENOMEM;
    }
    *bed = made;
    return DIG_OK;
}

struct numbered {
    uint32_t id, place;
};

static int by_id(const void *const a, const void *const b)
{
    const uint32_t x = ((const struct numbered *)a)->id;
    const uint32_t y = ((const struct numbered *)b)->id;
    return (x > y) - (x < y);
}

enum dig_status dig_bed_from_grains(const struct dig_grains *const grains, const size_t material[],
                                    struct dig_bed *const bed)
{
    const size_t           n     = grains->n;
    struct numbered *const order = malloc((n + 1) * sizeof *order);
    struct dig_bed         made  = { 0 };
    if (order == NULL ||
        dig_bed_create(n, material != NULL, grains->clump != NULL, &made) != DIG_OK) {
        free(order);
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        order[i] = (struct numbered){ grains->id[i], (uint32_t)i };
    }
    if (grains->clump != NULL) {
        qsort(order, n, sizeof *order, by_id);
    }
    for (size_t k = 0; k < n; k++) {
        const size_t i   = order[k].place;
        made.x_m[k]      = grains->motion[i].x_m[0];
        made.y_m[k]      = grains->motion[i].x_m[1];
        made.z_m[k]      = grains->motion[i].x_m[2];
        made.radius_m[k] = grains->type[grains->type_of[i]].radius_m;
        if (material != NULL) {
            made.material[k] = (uint8_t)material[grains->type_of[i]];
        }
        if (grains->clump != NULL) {
            made.clump[k] = grains->clump[i];
        }
    }
    free(order);
    *bed = made;
    return DIG_OK;
}

void dig_bed_finish(struct dig_bed *const bed)
{
    if (bed == NULL) {
        return;
    }
    free(bed->x_m);
    free(bed->y_m);
    free(bed->z_m);
    free(bed->radius_m);
    free(bed->material);
    free(bed->clump);
    *bed = (struct dig_bed){ 0 };
}
