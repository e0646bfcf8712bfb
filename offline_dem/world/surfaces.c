#include "offline_dem/world/surfaces.h"

#include "offline_dem/shapes/bucket_surface.h"

#include <math.h>
#include <string.h>

#define FAR_m 1e9 // distance that means no contact

// Candidate plates of a grain, consecutive in the list.
struct near_plates {
    size_t count;
    size_t contact[DIG_PLATES_MAX];
    size_t plate[DIG_PLATES_MAX];
    double closest_m[DIG_PLATES_MAX][3]; // body frame
    double distance_m[DIG_PLATES_MAX];
    bool   is_contact[DIG_PLATES_MAX];
};

static bool has_history(const struct dig_contacts *const list, const size_t c)
{
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        if (fabs(list->history[m][c]) > 0.0) {
            return true;
        }
    }
    return false;
}

// Moves the history of `from` to `to`, unless that has one.
static void move_history(struct dig_contacts *const list, const size_t from, const size_t to)
{
    if (!has_history(list, to)) {
        for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
            list->history[m][to]   = list->history[m][from];
            list->history[m][from] = 0.0;
        }
    }
}

// Leaves the local minima of the distance to the whole tool.
static void resolve_edges(const struct dig_tool *const tool, const double radius_m,
                          struct near_plates *const near, struct dig_contacts *const list)
{
    const double same_m = 1e-6 * radius_m;
    for (size_t p = 0; p < near->count; p++) {
        for (size_t q = 0; q < near->count && near->is_contact[p]; q++) {
            if (q == p || !near->is_contact[q] ||
                near->distance_m[q] > near->distance_m[p] + same_m) {
                continue;
            }
            // Does p's closest point lie on q as well?
            double on_q[3];
            dig_bucket_closest(&tool->bucket, near->plate[q], near->closest_m[p], on_q);
            if (dig_bucket_distance(on_q, near->closest_m[p]) > same_m) {
                continue;
            }
            // On a tie the contact stays with the plate that had it; else with the first.
            const bool tie = near->distance_m[q] > near->distance_m[p] - same_m;
            if (tie && (has_history(list, near->contact[p]) ||
                        (!has_history(list, near->contact[q]) && p < q))) {
                near->is_contact[q] = false;
                continue;
            }
            move_history(list, near->contact[p], near->contact[q]);
            near->is_contact[p] = false;
        }
    }
}

static void fill_contact(struct dig_block *const block, const size_t c,
                         const struct dig_motion *const m, const double d[3], const double v[3])
{
    for (int k = 0; k < 3; k++) {
        block->in[k][c]     = d[k];
        block->in[3 + k][c] = m->v_mps[k] - v[k];
        block->in[6 + k][c] = m->w_radps[k];
        block->in[9 + k][c] = 0.0;
    }
}

// One contact with the tool; keeps the arm from the pin to the contact point for the moment.
static void fill_plate(const struct dig_tool *const tool, const double body_m[3],
                       const double closest_m[3], const struct dig_motion *const m, const size_t c,
                       struct dig_block *const block, double arm_m[3])
{
    double d[3];
    double v[3];
    dig_tool_separation(tool, body_m, closest_m, d, arm_m, v);
    fill_contact(block, c, m, d, v);
}

// Candidates of one grain, contacts c … of the list; returns how many.
static size_t fill_plates(struct dig_world *const w, struct dig_contacts *const list,
                          const double radius_m, const size_t first, const size_t c,
                          const size_t count, struct dig_block *const block,
                          double arm_m[DIG_BLOCK][3])
{
    const uint32_t          i = list->i[first + c];
    const struct dig_motion m = dig_grains_motion(&w->grains, i);
    struct near_plates      near;
    double                  body_m[3];
    dig_tool_to_body(w->tool, m.x_m, body_m);
    size_t used   = 0;
    size_t in_use = 0;
    while (c + used < count && list->i[first + c + used] == i) {
        const size_t k     = used;
        const size_t plate = list->j[first + c + k] - w->walls;
        dig_bucket_closest(&w->tool->bucket, plate, body_m, near.closest_m[k]);
        near.contact[k]    = first + c + k;
        near.plate[k]      = plate;
        near.distance_m[k] = dig_bucket_distance(body_m, near.closest_m[k]);
        near.is_contact[k] = near.distance_m[k] < radius_m;
        in_use += near.is_contact[k];
        used++;
    }
    near.count = used;
    if (in_use > 1) {
        resolve_edges(w->tool, radius_m, &near, list);
    }
    for (size_t k = 0; k < used; k++) {
        if (near.is_contact[k]) {
            fill_plate(w->tool, body_m, near.closest_m[k], &m, c + k, block, arm_m[c + k]);
        } else {
            fill_contact(block, c + k, &m, (const double[3]){ FAR_m, 0.0, 0.0 },
                         (const double[3]){ 0.0, 0.0, 0.0 });
            memset(arm_m[c + k], 0, sizeof arm_m[c + k]);
        }
    }
    return used;
}

static void add_loads(struct dig_world *const w, const struct dig_contacts *const list,
                      const size_t first, const size_t count, const struct dig_block *const block,
                      const double arm_m[DIG_BLOCK][3], struct dig_wrench *const sum)
{
    for (size_t c = 0; c < count; c++) {
        double f[3];
        double on_grain[3];
        double t[3];
        for (int k = 0; k < 3; k++) {
            f[k]        = block->out[k][c];
            on_grain[k] = block->out[3 + k][c];
            t[k]        = block->out[6 + k][c];
        }
        dig_grains_add_load(&w->grains, list->i[first + c], f, on_grain);
        dig_wrench_react(f, t, arm_m[c], sum);
    }
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
    struct dig_contacts *const list     = &w->surface[DIG_GRAIN_TYPES_MAX + type];
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
        add_loads(w, list, first, count, &block, (const double(*)[3])arm_m, on_tool);
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
