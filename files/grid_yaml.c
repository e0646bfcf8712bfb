#include "files/grid_yaml.h"

#include "core/did_you_mean.h"
#include "core/text.h"
#include "core/units.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum design { DESIGN_CROSS, DESIGN_PRODUCT };

static const struct dig_yaml_word designs[] = { { "cross", DESIGN_CROSS },
                                                { "product", DESIGN_PRODUCT },
                                                { .word = NULL } };

struct effect_text {
    char                   name[DIG_NAME_SIZE];
    struct dig_grid_effect effect; // but for its id
};

// The grid, beside what makes its approaches.
struct grid_text {
    struct dig_grid    grid;
    double             depth[DIG_APPROACH_VALUES_MAX];
    double             attack_deg[DIG_APPROACH_VALUES_MAX];
    size_t             depths, attacks;
    enum design        design;
    struct effect_text effect[DIG_GRID_EFFECTS_MAX];
};

// What a grain can be: frictionless up to interlocking, pumice up to ore.
#define FRICTION .low = 0.0, .high = 3.0
#define DENSITY  .low = 100.0, .high = 20000.0
#define DEPTH    .low = DIG_APPROACH_DEPTH_LEAST, .high = DIG_APPROACH_DEPTH_MOST
#define ATTACK   .low = -45.0, .high = 45.0
#define PACKINGS .low = 1.0, .high = 1000.0

#define GRAVEL(key, axis, ...)                                                                     \
    FIELD(NUMBER, key, dig_grid_point, gravel.value[axis], REQUIRED, __VA_ARGS__)

static const struct dig_yaml_field point_fields[] = {
    GRAVEL("friction", DIG_AXIS_FRICTION, FRICTION),
    GRAVEL("rolling", DIG_AXIS_ROLLING, FRICTION),
    GRAVEL("density_kgpm3", DIG_AXIS_DENSITY_kgpm3, DENSITY),
    FIELD(NUMBER, "depth", dig_grid_point, approach.depth, OPTIONAL, DEPTH),
    FIELD(NUMBER, "attack_deg", dig_grid_point, approach.attack_rad, OPTIONAL, ATTACK,
          .factor = DIG_RAD_PER_DEG),
    FIELD(COUNT, "packings", dig_grid_point, packings, REQUIRED, PACKINGS),
    END,
};
static const struct dig_yaml_field point = ENTRY(dig_grid_point, point_fields);

static const struct dig_yaml_field effect_fields[] = {
    TEXT(effect_text, name),
    LIST("magnitudes", REQUIRED, effect_text, effect.magnitude, effect.magnitudes, &dig_yaml_number,
         1),
    END,
};
static const struct dig_yaml_field effect = ENTRY(effect_text, effect_fields);

static const struct dig_yaml_field friction_value = { .kind = DIG_YAML_NUMBER,
                                                      .size = sizeof(double),
                                                      FRICTION };
static const struct dig_yaml_field density_value  = { .kind = DIG_YAML_NUMBER,
                                                      .size = sizeof(double),
                                                      DENSITY };
static const struct dig_yaml_field depth_value    = { .kind = DIG_YAML_NUMBER,
                                                      .size = sizeof(double),
                                                      DEPTH };
static const struct dig_yaml_field attack_value   = { .kind = DIG_YAML_NUMBER,
                                                      .size = sizeof(double),
                                                      ATTACK };

#define AXIS(key, axis, entry)                                                                     \
    LIST(key, OPTIONAL, grid_text, grid.value[axis], grid.count[axis], entry, 1)

static const struct dig_yaml_field fields[] = {
    AXIS("friction", DIG_AXIS_FRICTION, &friction_value),
    AXIS("rolling", DIG_AXIS_ROLLING, &friction_value),
    AXIS("density_kgpm3", DIG_AXIS_DENSITY_kgpm3, &density_value),
    FIELD(COUNT, "packings", grid_text, grid.packings, OPTIONAL, PACKINGS),
    LIST("depth", OPTIONAL, grid_text, depth, depths, &depth_value, 1),
    LIST("attack_deg", OPTIONAL, grid_text, attack_deg, attacks, &attack_value, 1),
    FIELD(WORD, "design", grid_text, design, OPTIONAL, .word = designs),
    FIELD(COUNT, "varied_packings", grid_text, grid.varied_packings, OPTIONAL, PACKINGS),
    LIST("points", OPTIONAL, grid_text, grid.point, grid.points, &point, 0),
    LIST("effects", OPTIONAL, grid_text, effect, grid.effects, &effect, 0),
    LIST("trajectories", OPTIONAL, grid_text, grid.trajectory, grid.trajectories, &dig_yaml_name,
         0),
    SOURCE,
    END,
};

static const struct dig_yaml_file schema = { .of   = fields,
                                             .size = sizeof(struct grid_text),
                                             .kept = sizeof(struct dig_grid) };

// A list at a key.
static void check_ascending(const char *const list, const size_t count, const double value[],
                            struct dig_conditions *const c)
{
    for (size_t i = 1; i < count; i++) {
        dig_require(c, value[i] > value[i - 1], "%s[%zu]: %g after %g, expected ascending values",
                    list, i, value[i], value[i - 1]);
    }
}

// Axes may be left out together where points stand in their place.
static void check_axes(const struct dig_grid *const grid, struct dig_conditions *const c)
{
    bool any = false;
    for (int a = 0; a < DIG_AXES; a++) {
        any = any || grid->count[a] > 0;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const char *const name = dig_axis_name((enum dig_axis)a);
        dig_require(c, grid->count[a] > 0 || (!any && grid->points > 0),
                    "%s: missing, expected a list", name);
        check_ascending(name, grid->count[a], grid->value[a], c);
    }
    dig_require(c, !any || grid->packings > 0, "packings: missing, expected a whole number");
}

static void check_point(const struct dig_grid *const grid, const size_t i,
                        struct dig_conditions *const c)
{
    const struct dig_grid_point *const p = &grid->point[i];
    for (size_t k = 0; k < i; k++) {
        dig_require(c,
                    !dig_gravel_is_same(&p->gravel, &grid->point[k].gravel) ||
                        !dig_approach_is_same(&p->approach, &grid->point[k].approach),
                    "points[%zu]: the gravel of points[%zu], expected another", i, k);
    }
    dig_require(c, !p->states || grid->effects == 0,
                "points[%zu]: depth or attack_deg, expected neither beside effects", i);
}

static void check_effect(const struct dig_grid *const grid, const size_t i,
                         struct dig_conditions *const c)
{
    const struct dig_grid_effect *const e = &grid->effect[i];
    for (size_t k = 0; k < i; k++) {
        dig_require(c, grid->effect[k].effect != e->effect,
                    "effects[%zu].name: \"%s\" again, expected a new effect", i,
                    dig_effect_name(e->effect));
    }
    for (size_t m = 0; m < e->magnitudes; m++) {
        for (size_t k = 0; k < m; k++) {
            dig_require(c, e->magnitude[k] < e->magnitude[m] || e->magnitude[k] > e->magnitude[m],
                        "effects[%zu].magnitudes[%zu]: %g again, expected another", i, m,
                        e->magnitude[m]);
        }
    }
}

static void check_grid(const struct dig_grid *const grid, struct dig_conditions *const c)
{
    check_axes(grid, c);
    for (size_t i = 0; i < grid->points; i++) {
        check_point(grid, i, c);
    }
    for (size_t i = 0; i < grid->effects; i++) {
        check_effect(grid, i, c);
    }
    for (size_t i = 0; i < grid->trajectories; i++) {
        for (size_t j = 0; j < i; j++) {
            dig_require(c, strcmp(grid->trajectory[i], grid->trajectory[j]) != 0,
                        "trajectories[%zu]: \"%s\" again, expected a new name", i,
                        grid->trajectory[i]);
        }
    }
}

static void convert_effects(const struct grid_text *const text, struct dig_grid *const grid,
                            struct dig_conditions *const c)
{
    for (size_t i = 0; i < text->grid.effects; i++) {
        const struct effect_text *const from  = &text->effect[i];
        const int                       found = dig_effect_find(from->name);
        char                            best[DIG_GUESS_SIZE];
        struct dig_guess                guess = dig_guess(from->name);
        for (int e = DIG_EFFECT_COHESION; e < DIG_EFFECT_UNLISTED; e++) {
            dig_guess_try(&guess, dig_effect_name((enum dig_effect_id)e));
        }
        dig_require(c,
                    found >= 0 && found != DIG_EFFECT_UNLISTED &&
                        !dig_effect_is_of_machine((enum dig_effect_id)found),
                    "effects[%zu].name: \"%s\", expected an effect of the soil%s", i, from->name,
                    dig_guess_text(&guess, "", best));
        grid->effect[i]        = from->effect;
        grid->effect[i].effect = (enum dig_effect_id)found;
    }
}

// One list of depths or attacks: the plain value among them.
static void check_list(const char *const list, const size_t count, const double value[],
                       const double plain, struct dig_conditions *const c)
{
    bool has_plain = count == 0;
    for (size_t i = 0; i < count; i++) {
        has_plain = has_plain || !(value[i] < plain || value[i] > plain);
    }
    check_ascending(list, count, value, c);
    dig_require(c, has_plain,
                "%s: without %g, expected it among the values: the digs as the scene has them",
                list, plain);
}

static void check_approaches(const struct grid_text *const text, struct dig_conditions *const c)
{
    const bool lists = text->depths + text->attacks > 0;
    check_list("depth", text->depths, text->depth, 1.0, c);
    check_list("attack_deg", text->attacks, text->attack_deg, 0.0, c);
    dig_require(c, !lists || text->grid.effects == 0, "%s: beside effects, expected either",
                text->depths > 0 ? "depth" : "attack_deg");
    dig_require(c, lists || text->grid.varied_packings == 0,
                "varied_packings: without depth or attack_deg, expected one of them");
}

// The cross has one axis at a time, the product every combination.
static void convert_approaches(const struct grid_text *const text, struct dig_grid *const grid)
{
    const size_t depths  = text->depths > 0 ? text->depths : 1;
    const size_t attacks = text->attacks > 0 ? text->attacks : 1;
    for (size_t d = 0; d < depths; d++) {
        for (size_t a = 0; a < attacks; a++) {
            const struct dig_approach approach = {
                .depth      = text->depths > 0 ? text->depth[d] : 1.0,
                .attack_rad = (text->attacks > 0 ? text->attack_deg[a] : 0.0) * DIG_RAD_PER_DEG,
            };
            const struct dig_approach deep   = { .depth = approach.depth };
            const struct dig_approach turned = { .attack_rad = approach.attack_rad };
            const bool on_axis = dig_approach_is_plain(&deep) || dig_approach_is_plain(&turned);
            if (!dig_approach_is_plain(&approach) && (on_axis || text->design == DESIGN_PRODUCT)) {
                grid->approach[grid->approaches++] = approach;
            }
        }
    }
}

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct grid_text *const text = loaded;
    struct dig_grid *const  grid = &text->grid;
    (void)path;
    for (size_t i = 0; i < grid->points; i++) {
        struct dig_grid_point *const p = &grid->point[i];
        p->states   = fabs(p->approach.depth) > 0.0 || fabs(p->approach.attack_rad) > 0.0;
        p->approach = dig_approach_normalized(&p->approach);
    }
    convert_approaches(text, grid);
    convert_effects(text, grid, c);
    check_approaches(text, c);
    check_grid(grid, c);
}

enum dig_status dig_grid_read(const char *const path, struct dig_grid *const grid,
                              struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, grid, error);
}

// "simpleA, simpleB, actual"
static const char *names_of(const struct dig_scene *const scene, const size_t size,
                            char text[const])
{
    text[0] = '\0';
    for (size_t i = 0; i < scene->trajectories; i++) {
        dig_text_list(size, text, scene->trajectory[i].name);
    }
    return text;
}

enum dig_status dig_grid_trajectories(const char *const path, const struct dig_grid *const grid,
                                      const struct dig_scene *const scene, size_t *const count,
                                      size_t                  trajectory[const DIG_TRAJECTORY_MAX],
                                      struct dig_error *const error)
{
    assert(path != NULL && grid != NULL && scene != NULL && count != NULL);

    size_t found[DIG_TRAJECTORY_MAX] = { 0 };
    size_t n                         = grid->trajectories;
    for (size_t i = 0; i < n; i++) {
        const struct dig_trajectory *const t = dig_scene_find(scene, grid->trajectory[i]);
        if (t == NULL) {
            char names[DIG_TRAJECTORY_MAX * (DIG_NAME_SIZE + 2)];
            return dig_yaml_refuse(path, error,
                                   "trajectories[%zu]: \"%s\", expected one of the scene's: %s", i,
                                   grid->trajectory[i], names_of(scene, sizeof names, names));
        }
        found[i] = (size_t)(t - scene->trajectory);
    }
    for (size_t i = 0; grid->trajectories == 0 && i < scene->trajectories; i++) {
        found[n++] = i;
    }
    memcpy(trajectory, found, sizeof found);
    *count = n;
    return DIG_OK;
}
