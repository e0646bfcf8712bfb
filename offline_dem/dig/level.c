#include "offline_dem/dig/level.h"

#include "core/ground.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/law/law_general.h"
#include "offline_dem/world/bodies.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PLATE_mps   0.05 // m/s, quasi-static: slow beside the bed's own waves
#define DEEPEST     0.5  // radii the plate may cut into a grain
#define CHECK_STEPS 4    // steps between two checks of the plate's load
#define MOST_CELLS  2147483648.0

static double radius(const struct dig_world *const world, const size_t i)
{
    return world->grains.type[world->grains.type_of[i]].radius_m;
}

// Grains above the ground, alone or with a sphere of their clump. NULL when memory is short.
static unsigned char *find_above_ground(const struct dig_scene *const scene,
                                        const struct dig_world *const world)
{
    const struct dig_grains *const g      = &world->grains;
    const size_t                   clumps = world->bodies == NULL ? 0 : world->bodies->clumps;
    unsigned char *const           above  = calloc(g->n + 1, 1);
    unsigned char *const           body   = calloc(clumps + 1, 1);
    if (above == NULL || body == NULL) {
        free(above);
        free(body);
        return NULL;
    }
    for (size_t i = 0; i < g->n; i++) {
        const double *const x = g->motion[i].x_m;
        above[i]              = x[2] > dig_scene_ground_m(scene, x[0], x[1]) - radius(world, i);
        if (above[i] && g->clump != NULL) {
            body[g->clump[i]] = 1;
        }
    }
    for (size_t i = 0; i < g->n && g->clump != NULL; i++) {
        above[i] = g->clump[i] > 0 ? body[g->clump[i]] : above[i];
    }
    free(body);
    return above;
}

enum dig_status dig_level_cut(const struct dig_scene *const scene, struct dig_world *const world)
{
    enum dig_status status = dig_world_sync(world);
    if (status != DIG_OK) {
        return status;
    }
    unsigned char *const above = find_above_ground(scene, world);
    if (above == NULL) {
        return DIG_ENOMEM;
    }
    status = dig_world_drop(world, above);
    free(above);
    return status;
}

// Height of the bed in cells as wide as its largest grain.
struct height_map {
    double  low_m[2], edge_m;
    size_t  count[2];
    double *top_m;
};

static size_t cell_of(const struct height_map *const height_map, const double x_m[])
{
    size_t cell[2];
    for (int a = 0; a < 2; a++) {
        const double c = floor((x_m[a] - height_map->low_m[a]) / height_map->edge_m);
        const double m = (double)(height_map->count[a] - 1);
        cell[a]        = (size_t)fmin(fmax(c, 0.0), m);
    }
    return cell[0] + height_map->count[0] * cell[1];
}

static void centre_of(const struct height_map *const height_map, const size_t cell, double x_m[2])
{
    const size_t column = cell % height_map->count[0];
    const size_t row    = cell / height_map->count[0];
    x_m[0]              = height_map->low_m[0] + ((double)column + 0.5) * height_map->edge_m;
    x_m[1]              = height_map->low_m[1] + ((double)row + 0.5) * height_map->edge_m;
}

// Highest of the cell and the eight around it: a grain deposited there overlaps none.
static double top_around(const struct height_map *const height_map, const size_t cell)
{
    const ptrdiff_t cx    = (ptrdiff_t)(cell % height_map->count[0]);
    const ptrdiff_t cy    = (ptrdiff_t)(cell / height_map->count[0]);
    double          top_m = -INFINITY;
    for (ptrdiff_t y = cy - 1; y <= cy + 1; y++) {
        for (ptrdiff_t x = cx - 1; x <= cx + 1; x++) {
            if (x >= 0 && y >= 0 && x < (ptrdiff_t)height_map->count[0] &&
                y < (ptrdiff_t)height_map->count[1]) {
                top_m =
                    fmax(top_m, height_map->top_m[(size_t)x + height_map->count[0] * (size_t)y]);
            }
        }
    }
    return top_m;
}

static enum dig_status make_height_map(const struct dig_scene *const scene,
                                       const struct dig_world *const world,
                                       const unsigned char above[], const double edge_m,
                                       struct height_map *const height_map)
{
    const struct dig_box *const box = &scene->box;
    const double span[2]            = { box->x_max_m - box->x_min_m, box->y_max_m - box->y_min_m };
    *height_map = (struct height_map){ .low_m = { box->x_min_m, box->y_min_m }, .edge_m = edge_m };
    const double count[2] = { fmax(1.0, floor(span[0] / edge_m)),
                              fmax(1.0, floor(span[1] / edge_m)) };
    if (!(count[0] * count[1] <= MOST_CELLS)) {
        return DIG_ENOMEM;
    }
    for (int a = 0; a < 2; a++) {
        height_map->count[a] = (size_t)count[a];
        // Cells end at the walls: the remainder is split between both sides.
        height_map->low_m[a] += 0.5 * (span[a] - (double)height_map->count[a] * edge_m);
    }
    height_map->top_m =
        malloc(height_map->count[0] * height_map->count[1] * sizeof *height_map->top_m);
    if (height_map->top_m == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t c = 0; c < height_map->count[0] * height_map->count[1]; c++) {
        height_map->top_m[c] = box->z_min_m;
    }
    for (size_t i = 0; i < world->grains.n; i++) {
        if (!above[i]) {
            const double *const x = world->grains.motion[i].x_m;
            double *const       t = &height_map->top_m[cell_of(height_map, x)];
            *t                    = fmax(*t, x[2] + radius(world, i));
        }
    }
    return DIG_OK;
}

// Deposits grain i, or its clump, on the cell that lies lowest under the ground.
static void deposit(const struct dig_scene *const scene, struct height_map *const height_map,
                    const size_t n, const uint32_t member[], struct dig_world *const world)
{
    size_t lowest = 0;
    double most_m = -INFINITY;
    for (size_t c = 0; c < height_map->count[0] * height_map->count[1]; c++) {
        double x_m[2];
        centre_of(height_map, c, x_m);
        const double missing_m = dig_scene_ground_m(scene, x_m[0], x_m[1]) - height_map->top_m[c];
        if (missing_m > most_m) {
            most_m = missing_m;
            lowest = c;
        }
    }
    double to_m[3];
    centre_of(height_map, lowest, to_m);
    const double *const x      = world->grains.motion[member[0]].x_m;
    double              low_m  = INFINITY;
    double              high_m = -INFINITY;
    for (size_t k = 0; k < n; k++) {
        const double *const y = world->grains.motion[member[k]].x_m;
        low_m                 = fmin(low_m, y[2] - radius(world, member[k]));
        high_m                = fmax(high_m, y[2] + radius(world, member[k]));
    }
    const double lift_m       = top_around(height_map, lowest) - low_m;
    const double by_m[3]      = { to_m[0] - x[0], to_m[1] - x[1], lift_m };
    height_map->top_m[lowest] = high_m + lift_m;
    for (size_t k = 0; k < n; k++) {
        struct dig_motion *const m = &world->grains.motion[member[k]];
        for (int a = 0; a < 3; a++) {
            m->x_m[a] += by_m[a];
            m->v_mps[a]   = 0.0;
            m->w_radps[a] = 0.0;
        }
    }
    if (n > 1) {
        struct dig_rigid *const body =
            &world->bodies->clump[world->grains.clump[member[0]] - 1].body;
        for (int a = 0; a < 3; a++) {
            body->x_m[a] += by_m[a];
            body->v_mps[a] = 0.0;
            body->l_Nms[a] = 0.0;
        }
    }
}

enum dig_status dig_level_rake(const struct dig_scene *const scene, struct dig_world *const world)
{
    const enum dig_status here = dig_world_sync(world);
    if (here != DIG_OK) {
        return here;
    }
    const struct dig_grains *const g = &world->grains;
    if (g->n == 0) {
        return DIG_OK;
    }
    unsigned char *const above      = find_above_ground(scene, world);
    const bool           clumps     = world->bodies != NULL && world->bodies->clumps > 0;
    double               edge_m     = 0.0;
    struct height_map    height_map = { .top_m = NULL };
    for (size_t k = 0; k < g->types; k++) {
        edge_m = fmax(edge_m, 2.0 * g->type[k].radius_m);
    }
    if (clumps) {
        edge_m *= world->bodies->shape.bound / world->bodies->shape.radius[0];
    }
    enum dig_status status = DIG_ENOMEM;
    if (above != NULL) {
        status = make_height_map(scene, world, above, edge_m, &height_map);
    }
    for (size_t i = 0; i < g->n && status == DIG_OK && clumps; i++) {
        const struct dig_clump_body *const clump = &world->bodies->clump[g->clump[i] - 1];
        if (above[i] && clump->member[0] == i) {
            deposit(scene, &height_map, world->bodies->shape.spheres, clump->member, world);
        }
    }
    for (uint32_t i = 0; i < g->n && status == DIG_OK && !clumps; i++) {
        if (above[i]) {
            deposit(scene, &height_map, 1, &i, world);
        }
    }
    if (status == DIG_OK) {
        dig_world_mark_stale(world);
    }
    free(above);
    free(height_map.top_m);
    return status;
}

// Force of the grains on a level plate at rest, and the deepest cut of the plate into a grain, in
// its radii.
static double plate_load_N(const struct dig_world *const world, const double plate_m,
                           double *const deepest)
{
    double sum_N = 0.0;
    *deepest     = 0.0;
    for (size_t i = 0; i < world->grains.n; i++) {
        const struct dig_law law   = world->wall_law[world->grains.type_of[i]];
        const double         gap_m = plate_m - world->grains.motion[i].x_m[2];
        if (gap_m < law.reach_m) {
            const struct dig_kinematics kinematics = { .dz_m = -fmax(gap_m, 1e-3 * law.reach_m) };
            struct dig_contact_history  history    = { 0 };
            const struct dig_contact_force force =
                dig_law_apply(&law, world->dt_s, &kinematics, &history);
            sum_N -= force.fz_N;
            *deepest = fmax(*deepest, 1.0 - gap_m / law.reach_m);
        }
    }
    return sum_N;
}

enum dig_status dig_level_press(const struct dig_scene *const scene, struct dig_world *const world,
                                struct dig_error *const error)
{
    const struct dig_box *const box = &scene->box;
    const double                load_N =
        scene->bed.preload_Pa * (box->x_max_m - box->x_min_m) * (box->y_max_m - box->y_min_m);
    double          plate_m = box->z_min_m;
    enum dig_status status  = dig_world_sync_motion(world);
    for (size_t i = 0; i < world->grains.n; i++) {
        plate_m = fmax(plate_m, world->grains.motion[i].x_m[2] + radius(world, i));
    }
    assert(world->walls < DIG_WALLS_MAX);
    const size_t plate = world->walls++;
    for (size_t s = 0; status == DIG_OK; s++) {
        if (s % CHECK_STEPS == 0) {
            double deepest = 0.0;
            if (plate_load_N(world, plate_m, &deepest) >= load_N) {
                break;
            }
            if (deepest > DEEPEST) {
                status = dig_error_set(error, DIG_EINVAL,
                                       "bed.preload_Pa: %g presses grains of young_Pa %g flat, "
                                       "expected less",
                                       scene->bed.preload_Pa, scene->material.young_Pa);
                continue;
            }
        }
        plate_m -= PLATE_mps * world->dt_s;
        world->wall[plate] = (struct dig_wall){ { 0.0, 0.0, -1.0 }, -plate_m };
        // The plate must stay within the margin of its contacts.
        if (s % CHECK_STEPS == 0) {
            dig_world_mark_stale(world);
        }
        status = dig_world_step(world);
        status = status == DIG_OK && s % CHECK_STEPS == CHECK_STEPS - 1
                     ? dig_world_sync_motion(world)
                     : status;
        status = status == DIG_OK ? status : dig_setup_explain(status, error);
    }
    world->walls--;
    dig_world_mark_stale(world);
    return status;
}
