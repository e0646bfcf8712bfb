#include "files/grid_yaml.h"

#include "core/did_you_mean.h"
#include "core/text.h"
#include "core/units.h"
#include "files/grid_check.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum design { DESIGN_CROSS, DESIGN_PRODUCT };

static const cyaml_strval_t designs[] = { { "cross", DESIGN_CROSS },
                                          { "product", DESIGN_PRODUCT } };

struct effect_text {
    char                   name[DIG_NAME_SIZE];
    struct dig_grid_effect effect; // but for its id
};

// The grid, attacks of its points in degrees, beside what makes its approaches.
struct grid_text {
    struct dig_grid    grid;
    double             depth[DIG_APPROACH_VALUES_MAX];
    double             attack_deg[DIG_APPROACH_VALUES_MAX];
    size_t             depths, attacks;
    enum design        design;
    struct effect_text effect[DIG_GRID_EFFECTS_MAX];
};

#define GRAVEL(key, axis)                                                                          \
    CYAML_FIELD_FLOAT(key, REQUIRED, struct dig_grid_point, gravel.value[axis])

static const cyaml_schema_field_t point_fields[] = {
    GRAVEL("friction", DIG_AXIS_FRICTION),
    GRAVEL("rolling", DIG_AXIS_ROLLING),
    GRAVEL("density_kgpm3", DIG_AXIS_DENSITY_kgpm3),
    CYAML_FIELD_FLOAT("depth", OPTIONAL, struct dig_grid_point, approach.depth),
    CYAML_FIELD_FLOAT("attack_deg", OPTIONAL, struct dig_grid_point, approach.attack_rad),
    CYAML_FIELD_UINT("packings", REQUIRED, struct dig_grid_point, packings),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t point = ENTRY(dig_grid_point, point_fields);

static const cyaml_schema_field_t effect_fields[] = {
    TEXT(effect_text, name),
    LIST("magnitudes", REQUIRED, effect_text, effect.magnitude, effect.magnitudes, &dig_yaml_number,
         1, DIG_MAGNITUDES_MAX),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t effect = ENTRY(effect_text, effect_fields);

#define AXIS(key, axis)                                                                            \
    LIST(key, OPTIONAL, grid_text, grid.value[axis], grid.count[axis], &dig_yaml_number, 1,        \
         DIG_AXIS_VALUES_MAX)
#define VALUES(member, count)                                                                      \
    LIST(#member, OPTIONAL, grid_text, member, count, &dig_yaml_number, 1, DIG_APPROACH_VALUES_MAX)

static const cyaml_schema_field_t fields[] = {
    AXIS("friction", DIG_AXIS_FRICTION),
    AXIS("rolling", DIG_AXIS_ROLLING),
    AXIS("density_kgpm3", DIG_AXIS_DENSITY_kgpm3),
    CYAML_FIELD_UINT("packings", OPTIONAL, struct grid_text, grid.packings),
    VALUES(depth, depths),
    VALUES(attack_deg, attacks),
    CYAML_FIELD_ENUM("design", OPTIONAL | CYAML_FLAG_STRICT, struct grid_text, design, designs,
                     sizeof designs / sizeof designs[0]),
    CYAML_FIELD_UINT("varied_packings", OPTIONAL, struct grid_text, grid.varied_packings),
    LIST("points", OPTIONAL, grid_text, grid.point, grid.points, &point, 0, DIG_GRID_POINTS_MAX),
    LIST("effects", OPTIONAL, grid_text, effect, grid.effects, &effect, 0, DIG_GRID_EFFECTS_MAX),
    LIST("trajectories", OPTIONAL, grid_text, grid.trajectory, grid.trajectories, &dig_yaml_name, 0,
         DIG_TRAJECTORY_MAX),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(grid_text, fields);

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

// One list of depths or attacks: ascending, within the range, the plain value among them.
static void check_list(const char *const list, const size_t count, const double value[],
                       const double plain, const double least, const double most,
                       struct dig_conditions *const c)
{
    dig_grid_check_values(list, count, value, least, most, c);
    bool has_plain = count == 0;
    for (size_t i = 0; i < count; i++) {
        has_plain = has_plain || !(value[i] < plain || value[i] > plain);
    }
    dig_require(c, has_plain,
                "%s: without %g, expected it among the values: the digs as the scene has them",
                list, plain);
}

static void check_approaches(const char *const path, const struct grid_text *const text,
                             struct dig_conditions *const c)
{
    check_list("depth", text->depths, text->depth, 1.0, DIG_APPROACH_DEPTH_LEAST,
               DIG_APPROACH_DEPTH_MOST, c);
    check_list("attack_deg", text->attacks, text->attack_deg, 0.0, -45.0, 45.0, c);
    const bool lists = text->depths + text->attacks > 0;
    dig_require(c, !lists || text->grid.effects == 0, "%s: beside effects, expected either",
                text->depths > 0 ? "depth" : "attack_deg");
    if (dig_yaml_line(path, "varied_packings") > 0) {
        dig_require(c, lists, "varied_packings: without depth or attack_deg, expected one of them");
        dig_grid_check_packings("varied_packings", text->grid.varied_packings, c);
    }
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

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    const struct grid_text *const text = loaded;
    struct dig_grid               grid = text->grid;
    for (size_t i = 0; i < grid.points; i++) {
        struct dig_grid_point *const p = &grid.point[i];
        p->states = fabs(p->approach.depth) > 0.0 || fabs(p->approach.attack_rad) > 0.0;
        p->approach.attack_rad *= DIG_RAD_PER_DEG;
        p->approach = dig_approach_normalized(&p->approach);
    }
    convert_approaches(text, &grid);
    convert_effects(text, &grid, c);
    check_approaches(path, text, c);
    if (c->status == DIG_OK) {
        dig_grid_check(path, &grid, c);
    }
    if (c->status == DIG_OK) {
        *(struct dig_grid *)into = grid;
    }
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
