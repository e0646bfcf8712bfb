#include "offline_dem/engine.h"

#include "offline_dem/lists.h"
#include "offline_dem/surfaces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void dig_engine_init(struct dig_engine *const engine, struct dig_grains *const grains)
{
    engine->grains = *grains;
    engine->stale  = true;
    *grains        = (struct dig_grains){ 0 };
}

void dig_engine_touched(struct dig_engine *const engine)
{
    engine->stale = true;
}

enum dig_status dig_engine_drop(struct dig_engine *const e, const unsigned char drop[])
{
    uint32_t *const place = malloc((e->grains.n + 1) * sizeof *place);
    if (place == NULL) {
        return DIG_ENOMEM;
    }
    uint32_t kept = 0;
    for (size_t i = 0; i < e->grains.n; i++) {
        place[i] = drop[i] ? UINT32_MAX : kept++;
    }
    dig_lists_move(e, place);
    free(place);
    dig_grains_drop(&e->grains, drop);
    // The neighbour list still counts the grains there were: it is remade before it is used.
    dig_neighbours_finish(&e->near_list);
    e->stale = true;
    return DIG_OK;
}

static bool is_finite(const struct dig_grains *const grains)
{
    for (size_t i = 0; i < grains->n; i++) {
        const struct dig_motion *const m = &grains->motion[i];
        if (!isfinite(m->x_m[0] + m->x_m[1] + m->x_m[2] + m->v_mps[0] + m->v_mps[1] + m->v_mps[2] +
                      m->w_radps[0] + m->w_radps[1] + m->w_radps[2])) {
            return false;
        }
    }
    return true;
}

enum dig_status dig_engine_step(struct dig_engine *const e)
{
    if (e->tool != NULL && !e->stale &&
        dig_tool_travel_m(e->tool, e->tool_at, e->tool->pose) > e->tool_margin_m) {
        e->stale = true;
    }
    if (e->stale) {
        if (!is_finite(&e->grains)) {
            return DIG_EINVAL;
        }
        const enum dig_status status = dig_lists_update(e);
        if (status != DIG_OK) {
            return status;
        }
    }
    for (size_t a = 0; a < e->grains.kinds; a++) {
        for (size_t b = a; b < e->grains.kinds; b++) {
            const struct dig_kind ka = e->grains.kind[a];
            const struct dig_kind kb = e->grains.kind[b];
            const struct dig_law  law =
                dig_law_pair(&e->material, ka.radius_m, kb.radius_m, ka.mass_kg, kb.mass_kg);
            dig_kernel_pairs(e->isa, &law, e->dt_s, &e->pair[a * DIG_KINDS_MAX + b], &e->grains);
        }
    }
    dig_surfaces_step(e);
    e->stale   = dig_kernel_advance(e->isa, e->gravity_mps2, e->started ? e->dt_s : 0.5 * e->dt_s,
                                    e->dt_s, (const double(*)[4])e->at_m, &e->grains);
    e->started = true;
    e->steps++;
    return DIG_OK;
}

void dig_engine_finish(struct dig_engine *const engine)
{
    if (engine == NULL) {
        return;
    }
    dig_grains_finish(&engine->grains);
    dig_lists_finish(engine);
}
