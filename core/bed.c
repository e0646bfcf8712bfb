#include "core/bed.h"

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
