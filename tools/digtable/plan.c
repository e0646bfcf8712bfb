#include "tools/digtable/plan.h"

#include "core/sha256.h"
#include "files/grid_yaml.h"
#include "files/scene_yaml.h"
#include "offline_dem/dig/input_checks.h"
#include "offline_dem/dig/variant.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct dig_gravel gravel_at(const struct dig_grid *const grid, size_t index)
{
    struct dig_gravel gravel;
    for (int a = DIG_AXES - 1; a >= 0; a--) {
        gravel.value[a] = grid->value[a][index % grid->count[a]];
        index /= grid->count[a];
    }
    return gravel;
}

// A single point among n points: in place of the same, or behind them. Returns how many there are.
static size_t put(const struct dig_grid_point *const one, const size_t n,
                  struct dig_plan_point point[const])
{
    size_t at = 0;
    while (at < n && !(dig_gravel_is_same(&point[at].gravel, &one->gravel) &&
                       dig_approach_is_same(&point[at].approach, &one->approach))) {
        at++;
    }
    point[at] = (struct dig_plan_point){ .gravel   = one->gravel,
                                         .approach = one->approach,
                                         .packings = one->packings };
    return at == n ? n + 1 : n;
}

// The plain points: the axes' product, then what stands beside it.
static size_t fill_plain(const struct dig_grid *const grid, const size_t product,
                         struct dig_plan_point point[const])
{
    size_t n = 0;
    for (; n < product; n++) {
        point[n] =
            (struct dig_plan_point){ .gravel = gravel_at(grid, n), .packings = grid->packings };
    }
    for (size_t i = 0; i < grid->points; i++) {
        if (!grid->point[i].states) {
            n = put(&grid->point[i], n, point);
        }
    }
    return n;
}

// Behind the plain points the same in every approach, then the single digs that state theirs: a
// sweep cut short has the plain ones first.
static size_t fill_approached(const struct dig_grid *const grid, const size_t plain,
                              struct dig_plan_point point[const])
{
    size_t n = plain;
    for (size_t i = 0; i < plain; i++) {
        for (size_t k = 0; k < grid->approaches; k++) {
            point[n]          = point[i];
            point[n].approach = grid->approach[k];
            if (grid->varied_packings > 0) {
                point[n].packings = grid->varied_packings;
            }
            n++;
        }
    }
    for (size_t i = 0; i < grid->points; i++) {
        if (grid->point[i].states) {
            n = put(&grid->point[i], n, point);
        }
    }
    return n;
}

static struct dig_plan_point vary(const struct dig_plan_point *const  plain,
                                  const struct dig_grid_effect *const effect, const size_t m)
{
    struct dig_plan_point varied = *plain;
    const char *const     name   = dig_effect_name(effect->effect);
    memcpy(varied.effect, name, strlen(name) + 1);
    varied.magnitude = effect->magnitude[m];
    return varied;
}

// Every plain point with every effect. A sweep cut short has the first point, and of every effect
// the magnitude that stands first.
static size_t fill_varied(const struct dig_grid *const grid, const size_t plain,
                          const struct dig_plan_point from[const], struct dig_plan_point to[const])
{
    size_t n = 0;
    for (size_t i = 0; i < plain; i++) {
        for (size_t m = 0; m < DIG_MAGNITUDES_MAX; m++) {
            for (size_t e = 0; e < grid->effects; e++) {
                if (m < grid->effect[e].magnitudes) {
                    to[n++] = vary(&from[i], &grid->effect[e], m);
                }
            }
        }
    }
    return n;
}

// NULL without memory.
static struct dig_plan_point *points_of(const struct dig_grid *const grid, const size_t packings,
                                        size_t *const count)
{
    size_t product = grid->count[0] > 0 ? 1 : 0;
    size_t times   = grid->effects > 0 ? 0 : 1;
    for (int a = 0; a < DIG_AXES && product > 0; a++) {
        product *= grid->count[a];
    }
    for (size_t e = 0; e < grid->effects; e++) {
        times += grid->effect[e].magnitudes;
    }
    struct dig_plan_point *point =
        calloc((product + grid->points) * (1 + grid->approaches), sizeof *point);
    if (point == NULL) {
        return NULL;
    }
    size_t n = fill_plain(grid, product, point);
    n        = fill_approached(grid, n, point);
    if (grid->effects > 0) {
        struct dig_plan_point *const varied = calloc(n * times + 1, sizeof *varied);
        n = varied != NULL ? fill_varied(grid, n, point, varied) : 0;
        free(point);
        point = varied;
    }
    for (size_t i = 0; i < n && packings > 0 && point != NULL; i++) {
        point[i].packings = packings;
    }
    *count = n;
    return point;
}

// Where a point is dug plainly, its trajectories stay in the box as the scene gives them.
static enum dig_status check_plain(const char *const             scene_path,
                                   const struct dig_scene *const scene,
                                   const struct dig_plan *const plan, struct dig_error *const error)
{
    bool plain = false;
    for (size_t i = 0; i < plan->points && !plain; i++) {
        plain = dig_approach_is_plain(&plan->point[i].approach);
    }
    for (size_t i = 0; i < plan->trajectories && plain; i++) {
        const enum dig_status status =
            dig_input_checks_path(scene, &scene->trajectory[plan->trajectory[i]], error);
        if (status != DIG_OK) {
            return dig_error_name(error, status, "%s", scene_path);
        }
    }
    return DIG_OK;
}

enum dig_status dig_plan_read(const char *const scene_path, const char *const grid_path,
                              const size_t packings, struct dig_scene *const scene,
                              struct dig_plan *const plan, struct dig_plan_point **const point,
                              struct dig_error *const error)
{
    struct dig_scene read;
    struct dig_grid  grid;
    struct dig_plan  made   = { .points = 0 };
    enum dig_status  status = dig_scene_read(scene_path, &read, error);
    if (status == DIG_OK) {
        status = dig_grid_read(grid_path, &grid, error);
    }
    if (status == DIG_OK) {
        status = dig_grid_trajectories(grid_path, &grid, &read, &made.trajectories, made.trajectory,
                                       error);
    }
    if (status != DIG_OK) {
        return status;
    }
    struct dig_plan_point *const points = points_of(&grid, packings, &made.points);
    if (points == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory for the grid", grid_path);
    }
    made.point = points;
    status     = check_plain(scene_path, &read, &made, error);
    if (status != DIG_OK) {
        free(points);
        return status;
    }
    *scene = read;
    *plan  = made;
    *point = points;
    return DIG_OK;
}

void dig_plan_hash(const struct dig_plan *const plan, const struct dig_scene *const scene,
                   const struct dig_engine *const engine, char hex[const 65])
{
    struct dig_sha256 hash;
    char              line[400];
    char              scene_hash[65];
    uint8_t           digest[32];
    dig_sha256_init(&hash);
    dig_scene_hash(scene, scene_hash);
    int length =
        snprintf(line, sizeof line, "scene=%s engine=%s version=%s trajectories=", scene_hash,
                 engine->name, engine->version);
    dig_sha256_add(&hash, line, (size_t)length);
    for (size_t i = 0; i < plan->trajectories; i++) {
        length = snprintf(line, sizeof line, "%zu,", plan->trajectory[i]);
        dig_sha256_add(&hash, line, (size_t)length);
    }
    for (size_t i = 0; i < plan->points; i++) {
        const struct dig_plan_point *const p = &plan->point[i];
        length = snprintf(line, sizeof line, "\n%.17g %.17g %.17g %s %.17g %.17g %.17g %zu",
                          p->gravel.value[0], p->gravel.value[1], p->gravel.value[2], p->effect,
                          p->magnitude, p->approach.depth, p->approach.attack_rad, p->packings);
        dig_sha256_add(&hash, line, (size_t)length);
    }
    dig_sha256_finish(&hash, digest);
    for (size_t i = 0; i < sizeof digest; i++) {
        (void)snprintf(&hex[2 * i], 3, "%02x", digest[i]);
    }
}

// Every trajectory of the plan, dug so.
static enum dig_status check_approach(const struct dig_plan *const       plan,
                                      const struct dig_plan_point *const point,
                                      const struct dig_scene *const      scene,
                                      struct dig_error *const            error)
{
    enum dig_status status = DIG_OK;
    for (size_t i = 0; status == DIG_OK && i < plan->trajectories; i++) {
        struct dig_trajectory dug;
        status = dig_approach_make(scene, &scene->trajectory[plan->trajectory[i]], &point->approach,
                                   &dug, error);
        status = status == DIG_OK ? dig_input_checks_path(scene, &dug, error) : status;
        if (status != DIG_OK) {
            char how[DIG_APPROACH_TEXT_SIZE];
            dig_approach_text(&point->approach, how);
            return dig_error_name(error, status, "grid%s", how);
        }
    }
    return DIG_OK;
}

enum dig_status dig_plan_check(const struct dig_plan *const  plan,
                               const struct dig_scene *const scene, struct dig_error *const error)
{
    for (size_t i = 0; i < plan->points; i++) {
        const struct dig_plan_point *const p = &plan->point[i];
        if (!dig_approach_is_plain(&p->approach)) {
            const enum dig_status status = check_approach(plan, p, scene, error);
            if (status != DIG_OK) {
                return status;
            }
        }
        if (p->effect[0] == '\0') {
            continue;
        }
        struct dig_scene         varied;
        const enum dig_effect_id effect = (enum dig_effect_id)dig_effect_find(p->effect);
        const enum dig_status    status =
            dig_variant_make(scene, effect, p->magnitude, &varied, error);
        if (status != DIG_OK) {
            return status;
        }
    }
    return DIG_OK;
}
