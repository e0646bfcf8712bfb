#include "offline_dem/world/world.h"

#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/lists.h"
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

// Before the first contact. Plates have few contacts and stay in double precision.
static void choose_precision(struct dig_world *const w)
{
    bool plain = w->bodies == NULL || w->bodies->clumps == 0;
    for (size_t a = 0; a < w->grains.types; a++) {
        plain = plain && !w->wall_law[a].general;
        for (size_t b = a; b < w->grains.types; b++) {
            plain = plain && !w->pair_law[a * DIG_GRAIN_TYPES_MAX + b].general;
        }
    }
    w->single = w->single && plain;
    for (size_t l = 0; l < DIG_PAIR_LISTS; l++) {
        w->pair[l].single           = w->single;
        w->detection.pair[l].single = w->single;
    }
    for (size_t type = 0; type < DIG_GRAIN_TYPES_MAX; type++) {
        w->surface[type].single           = w->single;
        w->detection.surface[type].single = w->single;
    }
}

// Everything a step needs before forces are computed.
static enum dig_status prepare(struct dig_world *const w)
{
    if (w->tool != NULL && !w->stale &&
        dig_tool_travel_m(w->tool, w->tool_reference, w->tool->pose) > w->tool_margin_m) {
        w->stale = true;
    }
    enum dig_status status = DIG_OK;
    if (w->stale) {
        if (w->contact_rebuilds == 0) {
            choose_precision(w);
        }
        status =
            dig_grains_are_sound(&w->grains, w->dt_s, w->crew) ? dig_lists_update(w) : DIG_EINVAL;
    }
    if (status == DIG_OK && w->single) {
        status = dig_grains_begin_single(&w->grains);
    }
    const size_t slabs = w->grains.slabs.count;
    if (status == DIG_OK && slabs > w->slab_sums_room) {
        struct dig_slab_sums *const more = realloc(w->slab_sums, slabs * sizeof *more);
        if (more == NULL) {
            return DIG_ENOMEM;
        }
        w->slab_sums      = more;
        w->slab_sums_room = slabs;
    }
    return status;
}

static void add_contact_loads(struct dig_world *const w, const size_t slab)
{
    struct dig_slab_sums *const sums = &w->slab_sums[slab];
    *sums                            = (struct dig_slab_sums){ .left = false };
    for (size_t a = 0; a < w->grains.types; a++) {
        for (size_t b = a; b < w->grains.types; b++) {
            const size_t l = a * DIG_GRAIN_TYPES_MAX + b;
            dig_kernel_pairs(w->isa, &w->pair_law[l], w->dt_s, w->period_y_m, &w->pair[l], slab,
                             &w->grains);
        }
    }
    dig_surfaces_add_loads(w, slab, &sums->on_tool, &sums->on_walls);
}

static void advance(struct dig_world *const w, const size_t slab)
{
    w->slab_sums[slab].left =
        dig_kernel_advance(w->isa, w->gravity_mps2, w->started ? w->dt_s : 0.5 * w->dt_s, w->dt_s,
                           (const double(*)[4])w->reference_m, slab, &w->grains);
}

static void add_loads(void *const context, const size_t first, const size_t end)
{
    for (size_t slab = first; slab < end; slab++) {
        add_contact_loads(context, slab);
    }
}

static void advance_slabs(void *const context, const size_t first, const size_t end)
{
    for (size_t slab = first; slab < end; slab++) {
        advance(context, slab);
    }
}

// A slab is advanced as soon as its contacts and those beside it are done, while it is still in the
// cache. The first and the last slab of a member wait for those of other members.
static void add_loads_and_advance(void *const context, const size_t first, const size_t end)
{
    for (size_t slab = first; slab < end; slab++) {
        add_contact_loads(context, slab);
        if (slab > first + 1) {
            advance(context, slab - 1);
        }
    }
}

static void advance_ends(void *const context, const size_t first, const size_t end)
{
    advance_slabs(context, first, first < end ? first + 1 : first);
    advance_slabs(context, first + 1 < end ? end - 1 : end, end);
}

enum dig_status dig_world_step(struct dig_world *const w)
{
    if (w->stand_in != NULL) {
        return w->stand_in->step(w);
    }
    const enum dig_status status = prepare(w);
    if (status != DIG_OK) {
        return status;
    }
    const size_t slabs = w->grains.slabs.count;
    if (w->bodies != NULL) {
        dig_crew_each(w->crew, slabs, add_loads, w);
        dig_bodies_apply_loads(w);
        dig_crew_each(w->crew, slabs, advance_slabs, w);
    } else {
        dig_crew_each(w->crew, slabs, add_loads_and_advance, w);
        dig_crew_each(w->crew, slabs, advance_ends, w);
    }
    w->on_tool  = w->slab_sums[0].on_tool;
    w->on_walls = w->slab_sums[0].on_walls;
    w->stale    = w->slab_sums[0].left;
    for (size_t slab = 1; slab < slabs; slab++) {
        dig_wrench_add(&w->slab_sums[slab].on_tool, &w->on_tool);
        dig_wrench_add(&w->slab_sums[slab].on_walls, &w->on_walls);
        w->stale = w->stale || w->slab_sums[slab].left;
    }
    if (w->bodies != NULL) {
        dig_bodies_step_rocks(w);
    }
    dig_wrench_add(&w->on_tool, &w->sum_tool);
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
    dig_grains_read_single(&w->grains);
    return w->stand_in == NULL ? DIG_OK : w->stand_in->sync(w, false);
}

enum dig_status dig_world_sync(struct dig_world *const w)
{
    dig_grains_end_single(&w->grains);
    return w->stand_in == NULL ? DIG_OK : w->stand_in->sync(w, true);
}

void dig_world_finish(struct dig_world *const world)
{
    if (world == NULL) {
        return;
    }
    if (world->stand_in != NULL) {
        world->stand_in->destroy(world);
        world->stand_in = NULL;
    }
    free(world->slab_sums);
    world->slab_sums      = NULL;
    world->slab_sums_room = 0;
    dig_grains_finish(&world->grains);
    dig_lists_finish(world);
}
