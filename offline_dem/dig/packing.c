#include "offline_dem/dig/packing.h"

#include "core/chance.h"
#include "core/ground.h"
#include "core/units.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/law/rigid.h"
#include "offline_dem/shapes/clump.h"
#include "offline_dem/world/obstacles.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define NO_SPHERE UINT32_MAX
#define MOST      2147483648.0 // spheres, and cells: what NO_SPHERE can tell, and memory may hold

#define ATTEMPTS 100000 // for one body, before the column counts as full
#define GROWTH   1.1    // factor by which a full column grows
#define TALLEST  2.0    // times the height of the solid fraction

// Spheres in cells as wide as the largest of them: overlaps are within one cell around.
struct cells {
    double    low_m[3], edge_m;
    ptrdiff_t count[3];
    uint32_t *first; // [cells]
    uint32_t *next;  // [spheres]
};

// One size of body: a sphere, or a clump of them.
struct size_class {
    size_t bodies;
    double diameter_m;
};

struct pouring {
    const struct dig_scene *scene;
    struct dig_clump_shape  shape;
    size_t                  spheres; // of one body
    size_t                  size_classes;
    struct size_class       size_class[DIG_SIZES_MAX];
    double                  period_m; // along y; 0: walls
    struct dig_obstacles    obstacles;
    struct cells            cells;
    double                  inset_m;             // of where centres are drawn from the walls
    double                  low_m[3], high_m[3]; // where centres are drawn: box and column
    double                  tallest_m;
};

static void plan_size_classes(struct pouring *const p)
{
    const struct dig_scene *const scene    = p->scene;
    const struct dig_box *const   box      = &scene->box;
    const double                  height_m = dig_scene_ground_max_m(scene) - box->z_min_m;
    const double box_m3 = (box->x_max_m - box->x_min_m) * (box->y_max_m - box->y_min_m) * height_m;
    const struct dig_size one   = { scene->material.diameter_m, 1.0 };
    const size_t          sizes = scene->bed.sizes;
    p->size_classes             = sizes > 0 ? sizes : 1;
    for (size_t i = 0; i < p->size_classes; i++) {
        const struct dig_size size = sizes > 0 ? scene->bed.size[i] : one;
        const double          d_m  = size.diameter_m;
        const double          m3   = DIG_PI / 6.0 * d_m * d_m * d_m;
        const double bodies = floor(scene->packing.fill_factor * box_m3 * size.mass_fraction / m3);
        // More than MOST are refused, whatever their number.
        const struct size_class made = { (size_t)fmin(bodies, 2.0 * MOST), d_m };
        size_t                  k    = i;
        for (; k > 0 && p->size_class[k - 1].diameter_m < d_m; k--) {
            p->size_class[k] = p->size_class[k - 1];
        }
        p->size_class[k] = made;
    }

    // Plain gravel draws no centre that a wall refuses: its tables were made so.
    const struct dig_bed_plan *const bed = &scene->bed;
    if (sizes == 0 && bed->clump.spheres == 0 && bed->obstacles == 0 && !bed->periodic_y) {
        p->inset_m = 0.5 * scene->material.diameter_m;
    }
    p->low_m[0]  = box->x_min_m + p->inset_m;
    p->low_m[1]  = box->y_min_m + p->inset_m;
    p->low_m[2]  = box->z_min_m + p->inset_m;
    p->high_m[0] = box->x_max_m - p->inset_m;
    p->high_m[1] = box->y_max_m - p->inset_m;
    p->high_m[2] = box->z_min_m +
                   height_m * scene->packing.fill_factor / scene->packing.solid_fraction -
                   p->inset_m;
    p->tallest_m = p->low_m[2] + (p->high_m[2] - p->low_m[2]) * TALLEST;
    p->period_m  = dig_scene_period_m(scene);
}

static size_t count_spheres(const struct pouring *const p)
{
    size_t n = 0;
    for (size_t i = 0; i < p->size_classes; i++) {
        n += p->size_class[i].bodies * p->spheres;
    }
    return n;
}

static enum dig_status make_cells(struct pouring *const p, const size_t n)
{
    struct cells *const c     = &p->cells;
    double              most  = 0.5;
    double              total = 1.0;
    double              count[3];
    for (size_t k = 0; k < p->shape.spheres; k++) {
        most = k == 0 ? p->shape.radius[0] : fmax(most, p->shape.radius[k]);
    }
    c->edge_m = 2.0 * most * p->size_class[0].diameter_m;
    for (int a = 0; a < 3; a++) {
        if (!(p->high_m[a] > p->low_m[a])) {
            return DIG_EUNREACHABLE;
        }
        const double span_m = (a == 2 ? p->tallest_m : p->high_m[a]) - p->low_m[a];
        c->low_m[a]         = p->low_m[a];
        count[a]            = floor(span_m / c->edge_m) + 1.0;
        total *= count[a];
    }
    if (!(total <= MOST) || (double)n > MOST) {
        return DIG_EINVAL;
    }
    for (int a = 0; a < 3; a++) {
        c->count[a] = (ptrdiff_t)count[a];
    }
    c->first = malloc((size_t)total * sizeof *c->first);
    c->next  = malloc((n + 1) * sizeof *c->next);
    if (c->first == NULL || c->next == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < (size_t)total; i++) {
        c->first[i] = NO_SPHERE;
    }
    return DIG_OK;
}

static void find_cell(const struct cells *const c, const double at_m[3], ptrdiff_t cell[3])
{
    for (int a = 0; a < 3; a++) {
        const ptrdiff_t i = (ptrdiff_t)floor((at_m[a] - c->low_m[a]) / c->edge_m);
        cell[a]           = i < 0 ? 0 : i >= c->count[a] ? c->count[a] - 1 : i;
    }
}

static bool overlaps_one(const struct pouring *const p, const struct dig_bed *const bed,
                         const double at_m[3], const double radius_m, const ptrdiff_t cell)
{
    for (uint32_t g = p->cells.first[cell]; g != NO_SPHERE; g = p->cells.next[g]) {
        const double dx = at_m[0] - bed->x_m[g];
        const double dy = at_m[1] - bed->y_m[g];
        const double dz = at_m[2] - bed->z_m[g];
        const double s  = radius_m + bed->radius_m[g];
        if (dx * dx + dy * dy + dz * dz < s * s) {
            return true;
        }
    }
    return false;
}

// Most attempts fail, and soonest at what is nearest: cells, and images beyond periodic sides.
static const ptrdiff_t nearest_first[] = { 0, -1, 1 };

static bool overlaps(const struct pouring *const p, const struct dig_bed *const bed,
                     const double at_m[3], const double radius_m)
{
    ptrdiff_t              cell[3] = { 0 };
    const ptrdiff_t *const n       = p->cells.count;
    // An image beyond a periodic side is out of reach of most.
    const double reach_m = radius_m + 0.5 * p->cells.edge_m;
    const double y_m     = at_m[1] - p->cells.low_m[1];
    if (y_m < -reach_m || y_m > (double)n[1] * p->cells.edge_m + reach_m) {
        return false;
    }
    find_cell(&p->cells, at_m, cell);
    for (size_t k = 0; k < 3; k++) {
        const ptrdiff_t z = cell[2] + nearest_first[k];
        for (size_t j = 0; j < 3; j++) {
            const ptrdiff_t y = cell[1] + nearest_first[j];
            for (size_t i = 0; i < 3; i++) {
                const ptrdiff_t x = cell[0] + nearest_first[i];
                if (z >= 0 && z < n[2] && y >= 0 && y < n[1] && x >= 0 && x < n[0] &&
                    overlaps_one(p, bed, at_m, radius_m, x + n[0] * (y + n[1] * z))) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Inside the walls, clear of the obstacles and of every sphere so far, in every image.
static bool is_free(const struct pouring *const p, const struct dig_bed *const bed,
                    const double at_m[3], const double radius_m)
{
    for (int a = 0; a < 3; a++) {
        const double keep_m = a == 1 && p->period_m > 0.0 ? 0.0 : radius_m - p->inset_m;
        if (at_m[a] < p->low_m[a] + keep_m || at_m[a] > p->high_m[a] - keep_m) {
            return false;
        }
    }
    for (size_t r = 0; r < p->obstacles.rocks; r++) {
        double closest_m[3];
        if (dig_rock_surface_closest(&p->obstacles.rock[r].surface, at_m, closest_m) < radius_m) {
            return false;
        }
    }
    const size_t images = p->period_m > 0.0 ? 3 : 1;
    for (size_t k = 0; k < images; k++) {
        const double shown[3] = { at_m[0], at_m[1] + (double)nearest_first[k] * p->period_m,
                                  at_m[2] };
        if (overlaps(p, bed, shown, radius_m)) {
            return false;
        }
    }
    return true;
}

// A uniform random rotation (Shoemake, Graphics Gems III).
static void random_rotation(uint64_t *const random, double q[4])
{
    const double u = dig_chance_between(random, 0.0, 1.0);
    const double a = dig_chance_between(random, 0.0, 2.0 * DIG_PI);
    const double b = dig_chance_between(random, 0.0, 2.0 * DIG_PI);
    q[0]           = sqrt(1.0 - u) * sin(a);
    q[1]           = sqrt(1.0 - u) * cos(a);
    q[2]           = sqrt(u) * sin(b);
    q[3]           = sqrt(u) * cos(b);
}

// One attempt to insert a body of this diameter: positions of its spheres. False when it overlaps.
static bool try_body(const struct pouring *const p, const struct dig_bed *const bed,
                     const double diameter_m, uint64_t *const random, double at_m[][3])
{
    double centre_m[3];
    double q[4] = { 1.0, 0.0, 0.0, 0.0 };
    for (int a = 0; a < 3; a++) {
        centre_m[a] = dig_chance_between(random, p->low_m[a], p->high_m[a]);
    }
    if (p->shape.spheres > 0) {
        random_rotation(random, q);
    }
    for (size_t k = 0; k < p->spheres; k++) {
        double arm[3] = { 0.0, 0.0, 0.0 };
        double radius = 0.5;
        if (p->shape.spheres > 0) {
            dig_rigid_rotate(q, p->shape.at[k], arm);
            radius = p->shape.radius[k];
        }
        for (int a = 0; a < 3; a++) {
            at_m[k][a] = centre_m[a] + diameter_m * arm[a];
        }
        if (!is_free(p, bed, at_m[k], radius * diameter_m)) {
            return false;
        }
    }
    return true;
}

static void insert_body(struct pouring *const p, struct dig_bed *const bed, const size_t first,
                        const double diameter_m, const double at_m[][3])
{
    for (size_t k = 0; k < p->spheres; k++) {
        const size_t g   = first + k;
        bed->x_m[g]      = at_m[k][0];
        bed->y_m[g]      = at_m[k][1];
        bed->z_m[g]      = at_m[k][2];
        bed->radius_m[g] = diameter_m * (p->shape.spheres > 0 ? p->shape.radius[k] : 0.5);
        if (bed->clump != NULL) {
            bed->clump[g] = (uint32_t)(first / p->spheres + 1);
        }
        ptrdiff_t cell[3];
        find_cell(&p->cells, at_m[k], cell);
        const ptrdiff_t c = cell[0] + p->cells.count[0] * (cell[1] + p->cells.count[1] * cell[2]);
        p->cells.next[g]  = p->cells.first[c];
        p->cells.first[c] = (uint32_t)g;
    }
}

static enum dig_status insert(struct pouring *const p, const uint64_t seed,
                              struct dig_bed *const bed)
{
    uint64_t random = seed;
    size_t   first  = 0;
    for (size_t c = 0; c < p->size_classes; c++) {
        for (size_t i = 0; i < p->size_class[c].bodies;) {
            double at_m[DIG_CLUMP_MAX][3];
            int    attempt = 0;
            while (attempt < ATTEMPTS &&
                   !try_body(p, bed, p->size_class[c].diameter_m, &random, at_m)) {
                attempt++;
            }
            if (attempt == ATTEMPTS) {
                p->high_m[2] = p->low_m[2] + (p->high_m[2] - p->low_m[2]) * GROWTH;
                if (p->high_m[2] > p->tallest_m) {
                    return DIG_EUNREACHABLE;
                }
                continue;
            }
            insert_body(p, bed, first, p->size_class[c].diameter_m, (const double(*)[3])at_m);
            first += p->spheres;
            i++;
        }
    }
    return DIG_OK;
}

enum dig_status dig_packing_insert(const struct dig_scene *const scene, const uint64_t seed,
                                   struct dig_bed *const bed, struct dig_error *const error)
{
    struct pouring  p      = { .scene = scene, .obstacles = dig_obstacles_make(scene) };
    enum dig_status status = dig_clump_shape_make(&scene->bed.clump, &p.shape);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "bed.clump: no volume, expected some");
    }
    p.spheres = p.shape.spheres > 0 ? p.shape.spheres : 1;
    plan_size_classes(&p);
    const size_t   n    = count_spheres(&p);
    struct dig_bed made = { 0 };
    status              = make_cells(&p, n);
    if (status == DIG_OK) {
        status = dig_bed_create(n, false, p.shape.spheres > 0, &made);
    }
    if (status == DIG_OK) {
        status = insert(&p, seed, &made);
    }
    free(p.cells.first);
    free(p.cells.next);
    if (status != DIG_OK) {
        dig_bed_finish(&made);
        return status != DIG_EINVAL
                   ? dig_setup_explain(status, error)
                   : dig_error_set(
                         error, status,
                         "box_m: room for more than %.0f grains of material.diameter_m or "
                         "bed.sizes by packing, expected less",
                         MOST);
    }
    *bed = made;
    return DIG_OK;
}
