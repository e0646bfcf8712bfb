#include "offline_dem/kernel/grains.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Cache lines: no grain's position or velocity straddles two.
#define ALIGNMENT 64

static void *allocate(const size_t n, const size_t size)
{
    const size_t bytes = (n * size + ALIGNMENT) / ALIGNMENT * ALIGNMENT;
    void *const  p     = aligned_alloc(ALIGNMENT, bytes);
    if (p != NULL) {
        memset(p, 0, bytes);
    }
    return p;
}

static bool is_type(const struct dig_grain_type *const type)
{
    return type->radius_m > 0.0 && type->mass_kg > 0.0 && type->inertia_kgm2 > 0.0 &&
           isfinite(type->radius_m + type->mass_kg + type->inertia_kgm2);
}

enum dig_status dig_grains_create(const size_t types, const struct dig_grain_type type[],
                                  const size_t n, const double x_m[], const double y_m[],
                                  const double z_m[], const uint8_t type_of[],
                                  struct dig_grains *const grains)
{
    struct dig_grains made = {
        .n       = n,
        .types   = types,
        .motion  = allocate(n, sizeof *made.motion),
        .load    = allocate(n, sizeof *made.load),
        .type_of = allocate(n, sizeof *made.type_of),
        .id      = allocate(n, sizeof *made.id),
    };
    enum dig_status status = DIG_ENOMEM;
    if (made.motion == NULL || made.load == NULL || made.type_of == NULL || made.id == NULL) {
        goto error;
    }
    status = DIG_EINVAL;
    if (types > DIG_GRAIN_TYPES_MAX) {
        goto error;
    }
    for (size_t k = 0; k < types; k++) {
        if (!is_type(&type[k])) {
            goto error;
        }
        made.type[k] = type[k];
    }
    for (size_t i = 0; i < n; i++) {
        if (type_of[i] >= types || !isfinite(x_m[i] + y_m[i] + z_m[i])) {
            goto error;
        }
        made.motion[i]  = (struct dig_motion){ .x_m = { x_m[i], y_m[i], z_m[i] } };
        made.type_of[i] = type_of[i];
        made.id[i]      = (uint32_t)i;
    }
    *grains = made;
    return DIG_OK;

error:
    dig_grains_finish(&made);
    return status;
}

void dig_grains_drop(struct dig_grains *const grains, const unsigned char drop[])
{
    size_t kept = 0;
    for (size_t i = 0; i < grains->n; i++) {
        if (!drop[i]) {
            grains->motion[kept]  = grains->motion[i];
            grains->load[kept]    = grains->load[i];
            grains->type_of[kept] = grains->type_of[i];
            grains->id[kept]      = grains->id[i];
            if (grains->clump != NULL) {
                grains->clump[kept] = grains->clump[i];
            }
            kept++;
        }
    }
    grains->n = kept;
}

enum dig_status dig_grains_reorder(struct dig_grains *const grains, const uint32_t order[])
{
    const size_t      n    = grains->n;
    struct dig_grains made = {
        .motion  = allocate(n, sizeof *made.motion),
        .type_of = allocate(n, sizeof *made.type_of),
        .id      = allocate(n, sizeof *made.id),
        .clump   = grains->clump == NULL ? NULL : allocate(n, sizeof *made.clump),
    };
    if (made.motion == NULL || made.type_of == NULL || made.id == NULL ||
        (made.clump == NULL && grains->clump != NULL)) {
        dig_grains_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        made.motion[k]  = grains->motion[order[k]];
        made.type_of[k] = grains->type_of[order[k]];
        made.id[k]      = grains->id[order[k]];
        if (made.clump != NULL) {
            made.clump[k] = grains->clump[order[k]];
        }
    }
    free(grains->motion);
    free(grains->type_of);
    free(grains->id);
    free(grains->clump);
    grains->motion  = made.motion;
    grains->type_of = made.type_of;
    grains->id      = made.id;
    grains->clump   = made.clump;
    return DIG_OK;
}

void dig_grains_finish(struct dig_grains *const grains)
{
    if (grains == NULL) {
        return;
    }
    free(grains->motion);
    free(grains->load);
    free(grains->type_of);
    free(grains->id);
    free(grains->clump);
    *grains = (struct dig_grains){ 0 };
}

double dig_grains_kinetic_J(const struct dig_grains *const grains)
{
    double sum_J = 0.0;
    for (size_t i = 0; i < grains->n; i++) {
        const double *const                v    = grains->motion[i].v_mps;
        const double *const                w    = grains->motion[i].w_radps;
        const struct dig_grain_type *const type = &grains->type[grains->type_of[i]];
        sum_J += 0.5 * type->mass_kg * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) +
                 0.5 * type->inertia_kgm2 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    }
    return sum_J;
}

bool dig_grains_are_sound(const struct dig_grains *const grains, const double dt_s)
{
    assert(grains != NULL);
    for (size_t i = 0; i < grains->n; i++) {
        const double *const x        = grains->motion[i].x_m;
        const double *const v        = grains->motion[i].v_mps;
        const double *const o        = grains->motion[i].w_radps;
        const double        radius_m = grains->type[grains->type_of[i]].radius_m;
        const double        limit    = radius_m / dt_s;
        if (!(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < limit * limit) ||
            !isfinite(x[0] + x[1] + x[2] + o[0] + o[1] + o[2])) {
            return false;
        }
    }
    return true;
}
