#include "offline_dem/world/world.h"

#include "offline_dem/world/bodies.h"
#include "offline_dem/world/lists.h"
#include "offline_dem/world/offloaded.h"
#include "offline_dem/world/surfaces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void dig_world_init(struct dig_world *const world, struct dig_grains *const grains)
{
    world->grains = *grains;
    world->stale  = true;
    *grains       = (struct dig_grains){ 0 };
}

void dig_world_mark_stale(struct dig_world *const world)
{
    world->stale = true;
}

enum dig_status dig_world_drop(struct dig_world *const w, const unsigned char drop[])
{
    const enum dig_status here = dig_world_sync(w);
    if (here != DIG_OK) {
        return here;
    }
    uint32_t *const new_index = malloc((w->grains.n + 1) * sizeof *new_index);
    if (new_index == NULL) {
        return DIG_ENOMEM;
    }
    uint32_t kept = 0;
    for (size_t i = 0; i < w->grains.n; i++) {
        new_index[i] = drop[i] ? UINT32_MAX : kept++;
    }
    dig_lists_renumber(w, new_index);
    dig_bodies_renumber(w->bodies, new_index);
    free(new_index);
    dig_grains_drop(&w->grains, drop);
    // The neighbour list holds the removed grains: it is rebuilt before it is read.
    dig_neighbours_finish(&w->neighbours);
    w->stale = true;
    return DIG_OK;
}

static void add_pair_loads(struct dig_world *const w)
{
    for (size_t a = 0; a < w->grains.types; a++) {
        for (size_t b = a; b < w->grains.types; b++) {
            const size_t l = a * DIG_GRAIN_TYPES_MAX + b;
            dig_kernel_pairs(w->isa, &w->pair_law[l], w->dt_s, w->period_y_m, &w->pair[l],
                             &w->grains);
        }
    }
}

static void add_wrench(const struct dig_wrench *const wrench, struct dig_wrench *const sum)
{
    for (int k = 0; k < 3; k++) {
        sum->f_N[k] += wrench->f_N[k];
        sum->t_Nm[k] += wrench->t_Nm[k];
    }
}

enum dig_status dig_world_step(struct dig_world *const w)
{
    if (w->offloaded != NULL) {
        return dig_offloaded_step(w);
    }
    if (w->tool != NULL && !w->stale &&
        dig_tool_travel_m(w->tool, w->tool_reference, w->tool->pose) > w->tool_margin_m) {
        w->stale = true;
    }
    if (w->stale) {
        if (!dig_grains_are_sound(&w->grains, w->dt_s)) {
            return DIG_EINVAL;
        }
        const enum dig_status status = dig_lists_update(w);
        if (status != DIG_OK) {
            return status;
        }
    }
    add_pair_loads(w);
    dig_surfaces_add_loads(w);
    if (w->bodies != NULL) {
        dig_bodies_apply_loads(w);
    }
    w->stale = dig_kernel_advance(w->isa, w->gravity_mps2, w->started ? w->dt_s : 0.5 * w->dt_s,
                                  w->dt_s, (const double(*)[4])w->reference_m, &w->grains);
    if (w->bodies != NULL) {
        dig_bodies_step_rocks(w);
    }
    add_wrench(&w->on_tool, &w->sum_tool);
    w->started = true;
    w->steps++;
    return DIG_OK;
}

enum dig_status dig_world_take_wrench(struct dig_world *const w, struct dig_wrench *const wrench)
{
    const enum dig_status status = dig_world_sync_motion(w);
    if (status == DIG_OK) {
        *wrench     = w->sum_tool;
        w->sum_tool = (struct dig_wrench){ 0 };
    }
    return status;
}

enum dig_status dig_world_sync_motion(struct dig_world *const w)
{
    return w->offloaded == NULL ? DIG_OK : dig_offloaded_sync_motion(w);
}

enum dig_status dig_world_sync(struct dig_world *const w)
{
    return w->offloaded == NULL ? DIG_OK : dig_offloaded_sync(w);
}

void dig_world_finish(struct dig_world *const world)
{
    if (world == NULL) {
        return;
    }
    dig_offloaded_destroy(world->offloaded);
    world->offloaded = NULL;
    dig_grains_finish(&world->grains);
    dig_lists_finish(world);
}
