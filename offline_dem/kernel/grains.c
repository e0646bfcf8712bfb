#include "offline_dem/kernel/grains.h"

#include "core/units.h"
#include "offline_dem/kernel/crew.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

// Cache lines: no grain's position or velocity straddles two.
#define ALIGNMENT 64

// What is allocated has no values yet.
static void *allocate_unset(const size_t n, const size_t size)
{
    return aligned_alloc(ALIGNMENT, (n * size + ALIGNMENT) / ALIGNMENT * ALIGNMENT);
}

static void *allocate(const size_t n, const size_t size)
{
    void *const p = allocate_unset(n, size);
    if (p != NULL) {
        memset(p, 0, n * size);
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
        .slabs   = { .count = 1, .grains = n + 1 },
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
    assert(!grains->in_single);
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
    grains->n     = kept;
    grains->slabs = (struct dig_slabs){ .count = 1, .grains = kept + 1 };
}

// Grains on their way to another order.
struct reorder {
    const struct dig_grains *from;
    const uint32_t          *order;
    struct dig_grains       *to;
};

static void reorder_share(void *const context, const size_t first, const size_t end)
{
    const struct reorder *const    r    = context;
    const struct dig_grains *const from = r->from;
    for (size_t k = first; k < end; k++) {
        const uint32_t i  = r->order[k];
        r->to->motion[k]  = from->motion[i];
        r->to->type_of[k] = from->type_of[i];
        r->to->id[k]      = from->id[i];
        if (from->clump != NULL) {
            r->to->clump[k] = from->clump[i];
        }
    }
}

enum dig_status dig_grains_reorder(struct dig_grains *const grains, const uint32_t order[],
                                   struct dig_crew *const crew)
{
    assert(!grains->in_single);
    const size_t      n    = grains->n;
    struct dig_grains made = {
        .motion  = allocate_unset(n, sizeof *made.motion),
        .type_of = allocate_unset(n, sizeof *made.type_of),
        .id      = allocate_unset(n, sizeof *made.id),
        .clump   = grains->clump == NULL ? NULL : allocate_unset(n, sizeof *made.clump),
    };
    if (made.motion == NULL || made.type_of == NULL || made.id == NULL ||
        (made.clump == NULL && grains->clump != NULL)) {
        dig_grains_finish(&made);
        return DIG_ENOMEM;
    }
    struct reorder reorder = { grains, order, &made };
    dig_crew_each(crew, n, reorder_share, &reorder);
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
    free(grains->single_motion);
    free(grains->single_load);
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

// Slabs of fewer grains are not worth their halos.
#define SLAB_GRAINS 16384

void dig_grains_set_slabs(struct dig_grains *const grains, const size_t reach)
{
    assert(!grains->in_single);
    const size_t least = reach > SLAB_GRAINS / 2 ? 2 * reach : SLAB_GRAINS;
    const size_t count = grains->n / least;
    grains->slabs      = (struct dig_slabs){ .count = 1, .grains = grains->n + 1 };
    if (count > 1) {
        const size_t each = (grains->n + count - 1) / count;
        grains->slabs     = (struct dig_slabs){ (grains->n + each - 1) / each, each, reach };
    }
}

static enum dig_status make_single_room(struct dig_grains *const grains)
{
    const size_t loads = grains->n + 2 * grains->slabs.halo * grains->slabs.count;
    if (grains->single_motion == NULL) {
        grains->single_motion = allocate(grains->n, sizeof *grains->single_motion);
    }
    if (grains->single_load == NULL || grains->single_load_room < loads) {
        free(grains->single_load);
        grains->single_load_room = loads + loads / 8;
        grains->single_load      = allocate(grains->single_load_room, sizeof *grains->single_load);
    }
    return grains->single_motion == NULL || grains->single_load == NULL ? DIG_ENOMEM : DIG_OK;
}

enum dig_status dig_grains_begin_single(struct dig_grains *const grains)
{
    if (grains->in_single) {
        return DIG_OK;
    }
    const enum dig_status status = make_single_room(grains);
    if (status != DIG_OK) {
        return status;
    }
    for (size_t i = 0; i < grains->n; i++) {
        for (int k = 0; k < 3; k++) {
            grains->single_motion[i].x_m[k]     = grains->motion[i].x_m[k];
            grains->single_motion[i].v_mps[k]   = (float)grains->motion[i].v_mps[k];
            grains->single_motion[i].w_radps[k] = (float)grains->motion[i].w_radps[k];
        }
    }
    grains->in_single = true;
    return DIG_OK;
}

void dig_grains_read_single(struct dig_grains *const grains)
{
    for (size_t i = 0; i < grains->n && grains->in_single; i++) {
        grains->motion[i] = dig_grains_motion(grains, i);
    }
}

void dig_grains_end_single(struct dig_grains *const grains)
{
    dig_grains_read_single(grains);
    grains->in_single = false;
}

// Grains that a crew looks at.
struct inspection {
    const struct dig_grains *grains;
    double                   dt_s;
    atomic_bool              unsound;
};

static void inspect(void *const context, const size_t first, const size_t end)
{
    struct inspection *const       inspection = context;
    const struct dig_grains *const grains     = inspection->grains;
    for (size_t i = first; i < end; i++) {
        const struct dig_motion m        = dig_grains_motion(grains, i);
        const double *const     x        = m.x_m;
        const double *const     v        = m.v_mps;
        const double *const     o        = m.w_radps;
        const double            radius_m = grains->type[grains->type_of[i]].radius_m;
        const double            limit    = radius_m / inspection->dt_s;
        if (!(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < limit * limit) ||
            !isfinite(x[0] + x[1] + x[2] + o[0] + o[1] + o[2])) {
            atomic_store(&inspection->unsound, true);
            return;
        }
    }
}

bool dig_grains_are_sound(const struct dig_grains *const grains, const double dt_s,
                          struct dig_crew *const crew)
{
    assert(grains != NULL);
    struct inspection inspection = { .grains = grains, .dt_s = dt_s };
    dig_crew_each(crew, grains->n, inspect, &inspection);
    return !atomic_load(&inspection.unsound);
}
