#include "files/grid_yaml.h"

#include "core/did_you_mean.h"
#include "core/units.h"
#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define PACKINGS_MAX    1000
#define ATTACK_MOST_rad (DIG_APPROACH_ATTACK_MOST_rad * (1.0 + 1e-12))

struct name_text {
    char text[DIG_NAME_SIZE];
};

struct point_text {
    double   friction, rolling, density_kgpm3;
    double   depth, attack_deg; // depth 0: not given
    uint32_t packings;
};

enum design { DESIGN_CROSS, DESIGN_PRODUCT };

static const cyaml_strval_t designs[] = { { "cross", DESIGN_CROSS },
                                          { "product", DESIGN_PRODUCT } };

struct effect_text {
    char     name[DIG_NAME_SIZE];
    double   magnitudes[DIG_MAGNITUDES_MAX];
    uint32_t magnitudes_count;
};

struct grid_text {
    double             friction[DIG_AXIS_VALUES_MAX];
    double             rolling[DIG_AXIS_VALUES_MAX];
    double             density_kgpm3[DIG_AXIS_VALUES_MAX];
    uint32_t           friction_count, rolling_count, density_kgpm3_count;
    uint32_t           packings;
    double             depth[DIG_APPROACH_VALUES_MAX];
    double             attack_deg[DIG_APPROACH_VALUES_MAX];
    uint32_t           depth_count, attack_deg_count;
    enum design        design;
    uint32_t           varied_packings;
    struct point_text  points[DIG_GRID_POINTS_MAX];
    uint32_t           points_count;
    struct effect_text effects[DIG_GRID_EFFECTS_MAX];
    uint32_t           effects_count;
    struct name_text   trajectories[DIG_TRAJECTORY_MAX];
    uint32_t           trajectories_count;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };
static const cyaml_schema_value_t name   = { CYAML_VALUE_STRING(REQUIRED, struct name_text, 1,
                                                                DIG_NAME_SIZE - 1) };

static const cyaml_schema_field_t point_fields[] = {
    CYAML_FIELD_FLOAT("friction", REQUIRED, struct point_text, friction),
    CYAML_FIELD_FLOAT("rolling", REQUIRED, struct point_text, rolling),
    CYAML_FIELD_FLOAT("density_kgpm3", REQUIRED, struct point_text, density_kgpm3),
    CYAML_FIELD_FLOAT("depth", OPTIONAL, struct point_text, depth),
    CYAML_FIELD_FLOAT("attack_deg", OPTIONAL, struct point_text, attack_deg),
    CYAML_FIELD_UINT("packings", REQUIRED, struct point_text, packings),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t point = { CYAML_VALUE_MAPPING(REQUIRED, struct point_text,
                                                                point_fields) };

static const cyaml_schema_field_t effect_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct effect_text, name, 1),
    CYAML_FIELD_SEQUENCE("magnitudes", REQUIRED, struct effect_text, magnitudes, &number, 1,
                         DIG_MAGNITUDES_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t effect = { CYAML_VALUE_MAPPING(REQUIRED, struct effect_text,
                                                                 effect_fields) };

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_SEQUENCE("friction", OPTIONAL, struct grid_text, friction, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_SEQUENCE("rolling", OPTIONAL, struct grid_text, rolling, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_SEQUENCE("density_kgpm3", OPTIONAL, struct grid_text, density_kgpm3, &number, 1,
                         DIG_AXIS_VALUES_MAX),
    CYAML_FIELD_UINT("packings", OPTIONAL, struct grid_text, packings),
    CYAML_FIELD_SEQUENCE("depth", OPTIONAL, struct grid_text, depth, &number, 1,
                         DIG_APPROACH_VALUES_MAX),
    CYAML_FIELD_SEQUENCE("attack_deg", OPTIONAL, struct grid_text, attack_deg, &number, 1,
                         DIG_APPROACH_VALUES_MAX),
    CYAML_FIELD_ENUM("design", OPTIONAL | CYAML_FLAG_STRICT, struct grid_text, design, designs,
                     sizeof designs / sizeof designs[0]),
    CYAML_FIELD_UINT("varied_packings", OPTIONAL, struct grid_text, varied_packings),
    CYAML_FIELD_SEQUENCE("points", OPTIONAL, struct grid_text, points, &point, 0,
                         DIG_GRID_POINTS_MAX),
    CYAML_FIELD_SEQUENCE("effects", OPTIONAL, struct grid_text, effects, &effect, 0,
                         DIG_GRID_EFFECTS_MAX),
    CYAML_FIELD_SEQUENCE("trajectories", OPTIONAL, struct grid_text, trajectories, &name, 0,
                         DIG_TRAJECTORY_MAX),
    CYAML_FIELD_IGNORE("source", OPTIONAL),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct grid_text, fields) };

// What a grain can be: frictionless up to interlocking, pumice up to ore.
static const struct {
    double least, most;
} domain[DIG_AXES] = {
    [DIG_AXIS_FRICTION]      = { 0.0, 3.0 },
    [DIG_AXIS_ROLLING]       = { 0.0, 3.0 },
    [DIG_AXIS_DENSITY_kgpm3] = { 100.0, 20000.0 },
};

static enum dig_status check_axis(const char *const path, const enum dig_axis axis,
                                  const struct dig_grid *const grid, struct dig_error *const error)
{
    const double *const value = grid->value[axis];
    for (size_t i = 0; i < grid->count[axis]; i++) {
        char key[64];
        (void)snprintf(key, sizeof key, "%s[%zu]", dig_axis_name(axis), i);
        if (!(value[i] >= domain[axis].least && value[i] <= domain[axis].most)) {
            return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", value[i],
                                   domain[axis].least, domain[axis].most);
        }
        if (i > 0 && !(value[i] > value[i - 1])) {
            return dig_yaml_refuse(path, key, error, "%g after %g, expected ascending values",
                                   value[i], value[i - 1]);
        }
    }
    return DIG_OK;
}

// Axes may be left out together where points stand in their place.
static enum dig_status check_present(const char *const path, const struct dig_grid *const grid,
                                     struct dig_error *const error)
{
    size_t axes = 0;
    for (int a = 0; a < DIG_AXES; a++) {
        axes += grid->count[a] > 0 ? 1 : 0;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        if (grid->count[a] == 0 && (axes > 0 || grid->points == 0)) {
            return dig_yaml_refuse(path, dig_axis_name((enum dig_axis)a), error,
                                   "missing, expected a list");
        }
    }
    if (axes > 0 && grid->packings == 0) {
        return dig_yaml_refuse(path, "packings", error, "%s, expected %s",
                               dig_yaml_line(path, "packings") > 0 ? "0" : "missing",
                               dig_yaml_line(path, "packings") > 0 ? "1 to 1000"
                                                                   : "a whole number");
    }
    return DIG_OK;
}

static enum dig_status check_packings(const char *const path, const char *const key,
                                      const size_t packings, struct dig_error *const error)
{
    return packings >= 1 && packings <= PACKINGS_MAX
               ? DIG_OK
               : dig_yaml_refuse(path, key, error, "%zu, expected 1 to %d", packings, PACKINGS_MAX);
}

static bool same_gravel(const struct dig_gravel *const a, const struct dig_gravel *const b)
{
    size_t equal = 0;
    for (int i = 0; i < DIG_AXES; i++) {
        equal += !(a->value[i] < b->value[i]) && !(a->value[i] > b->value[i]) ? 1 : 0;
    }
    return equal == DIG_AXES;
}

static enum dig_status check_point(const char *const path, const struct dig_grid *const grid,
                                   const size_t i, struct dig_error *const error)
{
    char key[64];
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = grid->point[i].gravel.value[a];
        (void)snprintf(key, sizeof key, "points[%zu].%s", i, dig_axis_name((enum dig_axis)a));
        if (!(value >= domain[a].least && value <= domain[a].most)) {
            return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", value,
                                   domain[a].least, domain[a].most);
        }
    }
    for (size_t k = 0; k < i; k++) {
        if (same_gravel(&grid->point[i].gravel, &grid->point[k].gravel) &&
            dig_approach_is_same(&grid->point[i].approach, &grid->point[k].approach)) {
            (void)snprintf(key, sizeof key, "points[%zu]", i);
            return dig_yaml_refuse(path, key, error, "the gravel of points[%zu], expected another",
                                   k);
        }
    }
    if (grid->point[i].states && grid->effects > 0) {
        (void)snprintf(key, sizeof key, "points[%zu]", i);
        return dig_yaml_refuse(path, key, error,
                               "depth or attack_deg, expected neither beside effects");
    }
    const double depth = grid->point[i].approach.depth;
    if (!(depth >= DIG_APPROACH_DEPTH_LEAST && depth <= DIG_APPROACH_DEPTH_MOST)) {
        (void)snprintf(key, sizeof key, "points[%zu].depth", i);
        return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", depth,
                               DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST);
    }
    if (!(fabs(grid->point[i].approach.attack_rad) <= ATTACK_MOST_rad)) {
        (void)snprintf(key, sizeof key, "points[%zu].attack_deg", i);
        return dig_yaml_refuse(path, key, error, "%g, expected -45 to 45",
                               grid->point[i].approach.attack_rad / DIG_RAD_PER_DEG);
    }
    (void)snprintf(key, sizeof key, "points[%zu].packings", i);
    return check_packings(path, key, grid->point[i].packings, error);
}

static enum dig_status check_effect(const char *const path, const struct dig_grid *const grid,
                                    const size_t i, struct dig_error *const error)
{
    char                                key[64];
    const struct dig_grid_effect *const e = &grid->effect[i];
    for (size_t k = 0; k < i; k++) {
        if (grid->effect[k].effect == e->effect) {
            (void)snprintf(key, sizeof key, "effects[%zu].name", i);
            return dig_yaml_refuse(path, key, error, "\"%s\" again, expected a new effect",
                                   dig_effect_name(e->effect));
        }
    }
    for (size_t m = 0; m < e->magnitudes; m++) {
        for (size_t k = 0; k < m; k++) {
            if (!(e->magnitude[k] < e->magnitude[m]) && !(e->magnitude[k] > e->magnitude[m])) {
                (void)snprintf(key, sizeof key, "effects[%zu].magnitudes[%zu]", i, m);
                return dig_yaml_refuse(path, key, error, "%g again, expected another",
                                       e->magnitude[m]);
            }
        }
    }
    return DIG_OK;
}

static enum dig_status check_trajectories(const char *const path, const struct dig_grid *const grid,
                                          struct dig_error *const error)
{
    for (size_t i = 0; i < grid->trajectories; i++) {
        for (size_t j = 0; j < i; j++) {
            if (strcmp(grid->trajectory[i], grid->trajectory[j]) == 0) {
                char key[64];
                (void)snprintf(key, sizeof key, "trajectories[%zu]", i);
                return dig_yaml_refuse(path, key, error, "\"%s\" again, expected a new name",
                                       grid->trajectory[i]);
            }
        }
    }
    return DIG_OK;
}

static enum dig_status check(const char *const path, const struct dig_grid *const grid,
                             struct dig_error *const error)
{
    enum dig_status status = check_present(path, grid, error);
    for (int a = 0; status == DIG_OK && a < DIG_AXES; a++) {
        status = check_axis(path, (enum dig_axis)a, grid, error);
    }
    if (status == DIG_OK && grid->count[0] > 0) {
        status = check_packings(path, "packings", grid->packings, error);
    }
    for (size_t i = 0; status == DIG_OK && i < grid->points; i++) {
        status = check_point(path, grid, i, error);
    }
    for (size_t i = 0; status == DIG_OK && i < grid->effects; i++) {
        status = check_effect(path, grid, i, error);
    }
    return status == DIG_OK ? check_trajectories(path, grid, error) : status;
}

static enum dig_status convert_effects(const char *const path, const struct grid_text *const text,
                                       struct dig_grid *const grid, struct dig_error *const error)
{
    for (size_t i = 0; i < text->effects_count; i++) {
        const struct effect_text *const from  = &text->effects[i];
        const int                       found = dig_effect_find(from->name);
        if (found < 0 || found == DIG_EFFECT_UNLISTED ||
            dig_effect_is_of_machine((enum dig_effect_id)found)) {
            char key[64];
            (void)snprintf(key, sizeof key, "effects[%zu].name", i);
            char             best[DIG_GUESS_SIZE];
            struct dig_guess guess = dig_guess(from->name);
            for (int e = DIG_EFFECT_COHESION; e < DIG_EFFECT_UNLISTED; e++) {
                dig_guess_try(&guess, dig_effect_name((enum dig_effect_id)e));
            }
            return dig_yaml_refuse(path, key, error, "\"%s\", expected an effect of the soil%s",
                                   from->name, dig_guess_text(&guess, "", best));
        }
        struct dig_grid_effect *const to = &grid->effect[i];
        to->effect                       = (enum dig_effect_id)found;
        to->magnitudes                   = from->magnitudes_count;
        memcpy(to->magnitude, from->magnitudes, sizeof to->magnitude);
    }
    grid->effects = text->effects_count;
    return DIG_OK;
}

// One list of depths or attacks: ascending, within the range, the plain value among them.
static enum dig_status check_list(const char *const path, const char *const list,
                                  const size_t count, const double value[], const double plain,
                                  const double least, const double most,
                                  struct dig_error *const error)
{
    bool has_plain = count == 0;
    for (size_t i = 0; i < count; i++) {
        char key[64];
        (void)snprintf(key, sizeof key, "%s[%zu]", list, i);
        if (!(value[i] >= least && value[i] <= most)) {
            return dig_yaml_refuse(path, key, error, "%g, expected %g to %g", value[i], least,
                                   most);
        }
        if (i > 0 && !(value[i] > value[i - 1])) {
            return dig_yaml_refuse(path, key, error, "%g after %g, expected ascending values",
                                   value[i], value[i - 1]);
        }
        has_plain = has_plain || !(value[i] < plain || value[i] > plain);
    }
    return has_plain ? DIG_OK
                     : dig_yaml_refuse(path, list, error,
                                       "without %g, expected it among the values: the digs as the "
                                       "scene has them",
                                       plain);
}

static enum dig_status check_approaches(const char *const path, const struct grid_text *const text,
                                        struct dig_error *const error)
{
    enum dig_status status = check_list(path, "depth", text->depth_count, text->depth, 1.0,
                                        DIG_APPROACH_DEPTH_LEAST, DIG_APPROACH_DEPTH_MOST, error);
    if (status == DIG_OK) {
        status = check_list(path, "attack_deg", text->attack_deg_count, text->attack_deg, 0.0,
                            -45.0, 45.0, error);
    }
    const bool lists = text->depth_count + text->attack_deg_count > 0;
    if (status == DIG_OK && lists && text->effects_count > 0) {
        return dig_yaml_refuse(path, text->depth_count > 0 ? "depth" : "attack_deg", error,
                               "beside effects, expected either");
    }
    if (status == DIG_OK && dig_yaml_line(path, "varied_packings") > 0) {
        return lists ? check_packings(path, "varied_packings", text->varied_packings, error)
                     : dig_yaml_refuse(path, "varied_packings", error,
                                       "without depth or attack_deg, expected one of them");
    }
    return status;
}

// The cross has one axis at a time, the product every combination.
static void convert_approaches(const struct grid_text *const text, struct dig_grid *const grid)
{
    const size_t depths  = text->depth_count > 0 ? text->depth_count : 1;
    const size_t attacks = text->attack_deg_count > 0 ? text->attack_deg_count : 1;
    for (size_t d = 0; d < depths; d++) {
        for (size_t a = 0; a < attacks; a++) {
            const struct dig_approach approach = {
                .depth = text->depth_count > 0 ? text->depth[d] : 1.0,
                .attack_rad =
                    (text->attack_deg_count > 0 ? text->attack_deg[a] : 0.0) * DIG_RAD_PER_DEG,
            };
            const struct dig_approach deep   = { .depth = approach.depth };
            const struct dig_approach turned = { .attack_rad = approach.attack_rad };
            const bool on_axis = dig_approach_is_plain(&deep) || dig_approach_is_plain(&turned);
            if (!dig_approach_is_plain(&approach) && (on_axis || text->design == DESIGN_PRODUCT)) {
                grid->approach[grid->approaches++] = approach;
            }
        }
    }
    grid->varied_packings = text->varied_packings;
}

static void convert(const struct grid_text *const text, struct dig_grid *const grid)
{
    *grid = (struct dig_grid){
        .count        = { text->friction_count, text->rolling_count, text->density_kgpm3_count },
        .packings     = text->packings,
        .points       = text->points_count,
        .trajectories = text->trajectories_count,
    };
    memcpy(grid->value[DIG_AXIS_FRICTION], text->friction, sizeof text->friction);
    memcpy(grid->value[DIG_AXIS_ROLLING], text->rolling, sizeof text->rolling);
    memcpy(grid->value[DIG_AXIS_DENSITY_kgpm3], text->density_kgpm3, sizeof text->density_kgpm3);
    for (size_t i = 0; i < grid->points; i++) {
        const struct point_text *const p = &text->points[i];
        grid->point[i]                   = (struct dig_grid_point){
                              .gravel   = { { p->friction, p->rolling, p->density_kgpm3 } },
                              .packings = p->packings,
                              .states   = fabs(p->depth) > 0.0 || fabs(p->attack_deg) > 0.0,
                              .approach = { p->depth, p->attack_deg * DIG_RAD_PER_DEG },
        };
        grid->point[i].approach = dig_approach_normalized(&grid->point[i].approach);
    }
    for (size_t i = 0; i < grid->trajectories; i++) {
        memcpy(grid->trajectory[i], text->trajectories[i].text, DIG_NAME_SIZE);
    }
    convert_approaches(text, grid);
}

enum dig_status dig_grid_read(const char *const path, struct dig_grid *const grid,
                              struct dig_error *const error)
{
    assert(path != NULL && grid != NULL);

    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_grid loaded;
    convert(data, &loaded);
    status = convert_effects(path, data, &loaded, error);
    if (status == DIG_OK) {
        status = check_approaches(path, data, error);
    }
    dig_yaml_free(&schema, data);
    if (status == DIG_OK) {
        status = check(path, &loaded, error);
    }
    if (status == DIG_OK) {
        *grid = loaded;
    }
    return status;
}

// "simpleA, simpleB, actual"
static const char *names_of(const struct dig_scene *const scene, const size_t size,
                            char text[const])
{
    size_t used = 0;
    for (size_t i = 0; i < scene->trajectories && used < size; i++) {
        const int n = snprintf(text + used, size - used, "%s%s", i == 0 ? "" : ", ",
                               scene->trajectory[i].name);
        used += n > 0 ? (size_t)n : 0;
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
            char key[64];
            char names[DIG_TRAJECTORY_MAX * (DIG_NAME_SIZE + 2)];
            (void)snprintf(key, sizeof key, "trajectories[%zu]", i);
            return dig_yaml_refuse(path, key, error, "\"%s\", expected one of the scene's: %s",
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
