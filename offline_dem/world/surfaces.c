#include "offline_dem/world/surfaces.h"

#include "offline_dem/shapes/plate_contacts.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <string.h>

#define FAR_m 1e9 // distance that means no contact

// A surface d from a grain moves at v there and turns by w.
static void fill_contact(struct dig_block *const block, const size_t c,
                         const struct dig_motion *const m, const double d[3], const double v[3],
                         const double w[3])
{
    for (int k = 0; k < 3; k++) {
        block->in[k][c]     = d[k];
        block->in[3 + k][c] = m->v_mps[k] - v[k];
        block->in[6 + k][c] = m->w_radps[k];
        block->in[9 + k][c] = w[k];
    }
}

// Settles which of a grain's plates are contacts, those of the list from first on.
static void resolve(const struct dig_tool *const tool, const double radius_m, const size_t first,
                    struct dig_plate_contacts *const near, struct dig_contacts *const list)
{
    for (size_t k = 0; k < near->count; k++) {
        near->history[k] = dig_contacts_history(list, first + k);
    }
    dig_plate_contacts_resolve(&tool->bucket, radius_m, near);
    for (size_t k = 0; k < near->count; k++) {
        dig_contacts_set_history(list, first + k, near->history[k]);
    }
}

// Candidates of one grain, contacts c … of the list; returns how many.
static size_t fill_plates(struct dig_world *const w, struct dig_contacts *const list,
                          const double radius_m, const size_t first, const size_t c,
                          const size_t count, struct dig_block *const block,
                          double arm_m[DIG_BLOCK][3])
{
    static const double       still[3] = { 0.0, 0.0, 0.0 };
    const uint32_t            i        = list->i[first + c];
    const struct dig_motion   m        = dig_grains_motion(&w->grains, i);
    struct dig_plate_contacts near;
    double                    body_m[3];
    dig_tool_to_body(w->tool, m.x_m, body_m);
    near.count     = 0;
    size_t touched = 0;
    while (c + near.count < count && list->i[first + c + near.count] == i) {
        const size_t plate = list->j[first + c + near.count] - DIG_FIRST_PLATE;
        touched += dig_plate_contacts_add(&w->tool->bucket, plate, body_m, radius_m, &near);
    }
    if (touched > 1) {
        resolve(w->tool, radius_m, first + c, &near, list);
    }
    for (size_t k = 0; k < near.count; k++) {
        double v[3] = { 0.0, 0.0, 0.0 };
        double d[3] = { FAR_m, 0.0, 0.0 };
        memset(arm_m[c + k], 0, sizeof arm_m[c + k]);
        if (near.touched[k]) {
            dig_tool_separation(w->tool, body_m, near.closest_m[k], d, arm_m[c + k], v);
        }
        fill_contact(block, c + k, &m, d, v, still);
    }
    return near.count;
}

// Of contact c of a block, to grain i and to the surface's sum.
static void add_load(struct dig_world *const w, const uint32_t i,
                     const struct dig_block *const block, const size_t c, const double arm_m[3],
                     struct dig_wrench *const sum)
{
    double f[3];
    double on_grain[3];
    double t[3];
    for (int k = 0; k < 3; k++) {
        f[k]        = block->out[k][c];
        on_grain[k] = block->out[3 + k][c];
        t[k]        = block->out[6 + k][c];
    }
    dig_grains_add_load(&w->grains, i, f, on_grain);
    dig_wrench_react(f, t, arm_m, sum);
}

// A block ends before a grain whose plates would not all fit.
static size_t block_length(const struct dig_contacts *const list, const size_t first,
                           const size_t end)
{
    if (end - first <= DIG_BLOCK) {
        return end - first;
    }
    size_t count = DIG_BLOCK;
    while (list->i[first + count] == list->i[first + count - 1]) {
        count--;
    }
    return count;
}

// Contacts of grains of one type with the plates.
static void step_plates(struct dig_world *const w, const size_t type, const size_t slab,
                        struct dig_wrench *const on_tool)
{
    struct dig_contacts *const list     = &w->surface[DIG_PLATE_LISTS + type];
    const double               radius_m = w->grains.type[type].radius_m;
    const size_t               end      = dig_contacts_slab_first(list, slab + 1);
    for (size_t first = dig_contacts_slab_first(list, slab); first < end;) {
        const size_t     count = block_length(list, first, end);
        struct dig_block block;
        double           arm_m[DIG_BLOCK][3];
        for (size_t c = 0; c < count;) {
            c += fill_plates(w, list, radius_m, first, c, count, &block, arm_m);
        }
        dig_kernel_block(w->isa, &w->tool_law[type], w->dt_s, list, first, count, &block);
        for (size_t c = 0; c < count; c++) {
            add_load(w, list->i[first + c], &block, c, arm_m[c], on_tool);
        }
        first += count;
    }
}

void dig_surfaces_add_loads(struct dig_world *const w, const size_t slab,
                            struct dig_wrench *const on_tool, struct dig_wrench *const on_walls)
{
    for (size_t type = 0; type < w->grains.types; type++) {
        dig_kernel_walls(w->isa, &w->wall_law[type], w->dt_s, w->wall, &w->surface[type], slab,
                         &w->grains, on_walls->f_N);
    }
    for (size_t type = 0; type < w->grains.types; type++) {
        step_plates(w, type, slab, on_tool);
    }
}

void dig_surfaces_add_rock_loads(struct dig_world *const w)
{
    struct dig_rock *const rock = w->bodies->obstacles.rock;
    for (size_t r = 0; r < w->bodies->obstacles.rocks; r++) {
        rock[r].load = (struct dig_wrench){ 0 };
    }
    for (size_t type = 0; type < w->grains.types; type++) {
        struct dig_contacts *const list     = &w->surface[DIG_ROCK_LISTS + type];
        const double               radius_m = w->grains.type[type].radius_m;
        for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
            const size_t          left  = list->n - first;
            const size_t          count = left < DIG_BLOCK ? left : DIG_BLOCK;
            const uint32_t *const i     = list->i + first;
            const uint32_t *const j     = list->j + first;
            struct dig_block      block;
            double                arm_m[DIG_BLOCK][3];
            for (size_t c = 0; c < count; c++) {
                const struct dig_rock *const of = &rock[j[c] - DIG_FIRST_ROCK];
                const struct dig_motion      m  = dig_grains_motion(&w->grains, i[c]);
                double                       d[3];
                double                       v[3];
                dig_obstacles_separation(w, of, m.x_m, radius_m, d, arm_m[c], v);
                fill_contact(&block, c, &m, d, v, of->w_radps);
            }
            dig_kernel_block(w->isa, &w->wall_law[type], w->dt_s, list, first, count, &block);
            for (size_t c = 0; c < count; c++) {
                add_load(w, i[c], &block, c, arm_m[c], &rock[j[c] - DIG_FIRST_ROCK].load);
            }
        }
    }
}
