#include "files/scene_yaml.h"

#include "core/units.h"
#include "files/bed_yaml.h"
#include "files/yaml.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

// The file as it is written: degrees and lists, in the order of docs/formats.md.
struct phase_text {
    char   name[DIG_NAME_SIZE];
    double duration_s, vx_mps, vz_mps, omega_degps;
};

struct trajectory_text {
    char              name[DIG_NAME_SIZE];
    double            theta0_deg;
    double            start_pin_m[2];
    struct phase_text phases[DIG_PHASES_MAX];
    uint32_t          phases_count;
};

struct point_text {
    double xz_m[2];
};

struct bucket_text {
    double            width_m;
    struct point_text profile_m[DIG_PROFILE_MAX];
    uint32_t          profile_m_count;
};

struct box_text {
    double x[2], y[2], z[2];
};

struct scene_text {
    char                   name[DIG_NAME_SIZE];
    struct bucket_text     bucket;
    struct box_text        box_m;
    struct dig_packing     packing;
    struct dig_material    material;
    double                 gravity_mps2, time_step_s, output_s;
    bool                   may_tremble;
    struct trajectory_text trajectories[DIG_TRAJECTORY_MAX];
    uint32_t               trajectories_count;
    struct laws_text       laws;
    struct bed_text        bed;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define SOURCE   CYAML_FIELD_IGNORE("source", CYAML_FLAG_OPTIONAL)

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };
static const cyaml_schema_value_t point  = { CYAML_VALUE_SEQUENCE_FIXED(REQUIRED, double, &number,
                                                                        2) };

static const cyaml_schema_field_t phase_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct phase_text, name, 1),
    CYAML_FIELD_FLOAT("duration_s", REQUIRED, struct phase_text, duration_s),
    CYAML_FIELD_FLOAT("vx_mps", REQUIRED, struct phase_text, vx_mps),
    CYAML_FIELD_FLOAT("vz_mps", REQUIRED, struct phase_text, vz_mps),
    CYAML_FIELD_FLOAT("omega_degps", REQUIRED, struct phase_text, omega_degps),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t phase = { CYAML_VALUE_MAPPING(REQUIRED, struct phase_text,
                                                                phase_fields) };

static const cyaml_schema_field_t trajectory_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct trajectory_text, name, 1),
    CYAML_FIELD_FLOAT("theta0_deg", REQUIRED, struct trajectory_text, theta0_deg),
    CYAML_FIELD_SEQUENCE_FIXED("start_pin_m", REQUIRED, struct trajectory_text, start_pin_m,
                               &number, 2),
    CYAML_FIELD_SEQUENCE("phases", REQUIRED, struct trajectory_text, phases, &phase, 1,
                         DIG_PHASES_MAX),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t trajectory = { CYAML_VALUE_MAPPING(
    REQUIRED, struct trajectory_text, trajectory_fields) };

static const cyaml_schema_field_t bucket_fields[] = {
    CYAML_FIELD_FLOAT("width_m", REQUIRED, struct bucket_text, width_m),
    CYAML_FIELD_SEQUENCE("profile_m", REQUIRED, struct bucket_text, profile_m, &point, 3,
                         DIG_PROFILE_MAX),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t box_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("x", REQUIRED, struct box_text, x, &number, 2),
    CYAML_FIELD_SEQUENCE_FIXED("y", REQUIRED, struct box_text, y, &number, 2),
    CYAML_FIELD_SEQUENCE_FIXED("z", REQUIRED, struct box_text, z, &number, 2),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t packing_fields[] = {
    CYAML_FIELD_FLOAT("solid_fraction", REQUIRED, struct dig_packing, solid_fraction),
    CYAML_FIELD_FLOAT("fill_factor", REQUIRED, struct dig_packing, fill_factor),
    CYAML_FIELD_FLOAT("fall_mps", REQUIRED, struct dig_packing, fall_mps),
    CYAML_FIELD_FLOAT("settle_s", REQUIRED, struct dig_packing, settle_s),
    CYAML_FIELD_FLOAT("relax_s", REQUIRED, struct dig_packing, relax_s),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t material_fields[] = {
    CYAML_FIELD_FLOAT("diameter_m", REQUIRED, struct dig_material, diameter_m),
    CYAML_FIELD_FLOAT("young_Pa", REQUIRED, struct dig_material, young_Pa),
    CYAML_FIELD_FLOAT("poisson", REQUIRED, struct dig_material, poisson),
    CYAML_FIELD_FLOAT("restitution", REQUIRED, struct dig_material, restitution),
    CYAML_FIELD_FLOAT("characteristic_velocity_mps", REQUIRED, struct dig_material,
                      characteristic_velocity_mps),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t scene_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct scene_text, name, 1),
    CYAML_FIELD_MAPPING("bucket", REQUIRED, struct scene_text, bucket, bucket_fields),
    CYAML_FIELD_MAPPING("box_m", REQUIRED, struct scene_text, box_m, box_fields),
    CYAML_FIELD_MAPPING("packing", REQUIRED, struct scene_text, packing, packing_fields),
    CYAML_FIELD_MAPPING("material", REQUIRED, struct scene_text, material, material_fields),
    CYAML_FIELD_FLOAT("gravity_mps2", REQUIRED, struct scene_text, gravity_mps2),
    CYAML_FIELD_FLOAT("time_step_s", REQUIRED, struct scene_text, time_step_s),
    CYAML_FIELD_BOOL("may_tremble", CYAML_FLAG_OPTIONAL, struct scene_text, may_tremble),
    CYAML_FIELD_FLOAT("output_s", REQUIRED, struct scene_text, output_s),
    CYAML_FIELD_SEQUENCE("trajectories", REQUIRED, struct scene_text, trajectories, &trajectory, 1,
                         DIG_TRAJECTORY_MAX),
    CYAML_FIELD_MAPPING("laws", CYAML_FLAG_OPTIONAL, struct scene_text, laws, dig_laws_fields),
    CYAML_FIELD_MAPPING("bed", CYAML_FLAG_OPTIONAL, struct scene_text, bed, dig_bed_fields),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct scene_text, scene_fields) };

static struct dig_trajectory convert_trajectory(const struct trajectory_text *const text)
{
    struct dig_trajectory t = {
        .theta0_rad = text->theta0_deg * DIG_RAD_PER_DEG,
        .start_x_m  = text->start_pin_m[0],
        .start_z_m  = text->start_pin_m[1],
        .phases     = text->phases_count,
    };
    memcpy(t.name, text->name, sizeof t.name);
    for (size_t i = 0; i < t.phases; i++) {
        const struct phase_text *const p = &text->phases[i];
        t.phase[i]                       = (struct dig_phase){
                                  .duration_s  = p->duration_s,
                                  .vx_mps      = p->vx_mps,
                                  .vz_mps      = p->vz_mps,
                                  .omega_radps = p->omega_degps * DIG_RAD_PER_DEG,
        };
        memcpy(t.phase[i].name, p->name, sizeof t.phase[i].name);
    }
    return t;
}

static struct dig_scene convert(const struct scene_text *const text)
{
    struct dig_scene scene = {
        .bucket = { .points = text->bucket.profile_m_count, .width_m = text->bucket.width_m },
        .box = {
            .x_min_m = text->box_m.x[0],
            .x_max_m = text->box_m.x[1],
            .y_min_m = text->box_m.y[0],
            .y_max_m = text->box_m.y[1],
            .z_min_m = text->box_m.z[0],
            .z_max_m = text->box_m.z[1],
        },
        .packing      = text->packing,
        .material     = text->material,
        .gravity_mps2 = text->gravity_mps2,
        .time_step_s  = text->time_step_s,
        .may_tremble  = text->may_tremble,
        .output_s     = text->output_s,
        .trajectories = text->trajectories_count,
    };
    memcpy(scene.name, text->name, sizeof scene.name);
    for (size_t i = 0; i < scene.bucket.points; i++) {
        scene.bucket.x_m[i] = text->bucket.profile_m[i].xz_m[0];
        scene.bucket.z_m[i] = text->bucket.profile_m[i].xz_m[1];
    }
    for (size_t i = 0; i < scene.trajectories; i++) {
        scene.trajectory[i] = convert_trajectory(&text->trajectories[i]);
    }
    return scene;
}

enum dig_status dig_scene_read(const char *const path, struct dig_scene *const scene,
                               struct dig_error *const error)
{
    assert(path != NULL && scene != NULL);

    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    const struct scene_text *const text   = data;
    struct dig_scene               loaded = convert(text);
    struct dig_error               found  = { "" };
    status = dig_bed_convert(&text->laws, &text->bed, &loaded, &found);
    dig_yaml_free(&schema, data);
    if (status == DIG_OK) {
        status = dig_scene_check(&loaded, &found);
    }
    if (status != DIG_OK) {
        return dig_yaml_refuse_checked(path, status, &found, error);
    }
    *scene = loaded;
    return DIG_OK;
}
