#include "files/scene_yaml.h"

#include "core/units.h"
#include "files/bed_yaml.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

// A scene, angles still in degrees, beside what is put into it afterwards.
struct scene_text {
    struct dig_scene      scene;
    struct dig_yaml_point profile_m[DIG_PROFILE_MAX];
    struct bed_text       bed;
};

static const cyaml_schema_field_t phase_fields[] = {
    TEXT(dig_phase, name),
    NUMBER(dig_phase, duration_s),
    NUMBER(dig_phase, vx_mps),
    NUMBER(dig_phase, vz_mps),
    CYAML_FIELD_FLOAT("omega_degps", REQUIRED, struct dig_phase, omega_radps),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t phase = ENTRY(dig_phase, phase_fields);

static const cyaml_schema_field_t trajectory_fields[] = {
    TEXT(dig_trajectory, name),
    CYAML_FIELD_FLOAT("theta0_deg", REQUIRED, struct dig_trajectory, theta0_rad),
    PAIR("start_pin_m", dig_trajectory, start_x_m, start_z_m),
    LIST("phases", REQUIRED, dig_trajectory, phase, phases, &phase, 1, DIG_PHASES_MAX),
    SOURCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t trajectory = ENTRY(dig_trajectory, trajectory_fields);

static const cyaml_schema_field_t bucket_fields[] = {
    CYAML_FIELD_FLOAT("width_m", REQUIRED, struct scene_text, scene.bucket.width_m),
    LIST("profile_m", REQUIRED, scene_text, profile_m, scene.bucket.points, &dig_yaml_point, 3,
         DIG_PROFILE_MAX),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t box_fields[] = {
    PAIR("x", dig_box, x_min_m, x_max_m),
    PAIR("y", dig_box, y_min_m, y_max_m),
    PAIR("z", dig_box, z_min_m, z_max_m),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t packing_fields[] = {
    NUMBER(dig_packing, solid_fraction),
    NUMBER(dig_packing, fill_factor),
    NUMBER(dig_packing, fall_mps),
    NUMBER(dig_packing, settle_s),
    NUMBER(dig_packing, relax_s),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t material_fields[] = {
    NUMBER(dig_material, diameter_m),
    NUMBER(dig_material, young_Pa),
    NUMBER(dig_material, poisson),
    NUMBER(dig_material, restitution),
    NUMBER(dig_material, characteristic_velocity_mps),
    CYAML_FIELD_FLOAT("young_at_kgpm3", OPTIONAL, struct dig_material, young_at_kgpm3),
    SOURCE,
    CYAML_FIELD_END,
};

#define PART(member, flags, fields)                                                                \
    CYAML_FIELD_MAPPING(#member, flags, struct scene_text, scene.member, fields)

static const cyaml_schema_field_t scene_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct scene_text, scene.name, 1),
    ACROSS("bucket", REQUIRED, scene_text, bucket_fields),
    CYAML_FIELD_MAPPING("box_m", REQUIRED, struct scene_text, scene.box, box_fields),
    PART(packing, REQUIRED, packing_fields),
    PART(material, REQUIRED, material_fields),
    CYAML_FIELD_FLOAT("gravity_mps2", REQUIRED, struct scene_text, scene.gravity_mps2),
    CYAML_FIELD_FLOAT("time_step_s", REQUIRED, struct scene_text, scene.time_step_s),
    CYAML_FIELD_BOOL("may_tremble", OPTIONAL, struct scene_text, scene.may_tremble),
    CYAML_FIELD_FLOAT("output_s", REQUIRED, struct scene_text, scene.output_s),
    LIST("trajectories", REQUIRED, scene_text, scene.trajectory, scene.trajectories, &trajectory, 1,
         DIG_TRAJECTORY_MAX),
    PART(laws, OPTIONAL, dig_laws_fields),
    CYAML_FIELD_MAPPING("bed", OPTIONAL, struct scene_text, bed, dig_bed_fields),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(scene_text, scene_fields);

static struct dig_scene convert(const struct scene_text *const text)
{
    struct dig_scene scene = text->scene;
    for (size_t i = 0; i < scene.bucket.points; i++) {
        scene.bucket.x_m[i] = text->profile_m[i].xz_m[0];
        scene.bucket.z_m[i] = text->profile_m[i].xz_m[1];
    }
    for (size_t t = 0; t < scene.trajectories; t++) {
        scene.trajectory[t].theta0_rad *= DIG_RAD_PER_DEG;
        for (size_t i = 0; i < scene.trajectory[t].phases; i++) {
            scene.trajectory[t].phase[i].omega_radps *= DIG_RAD_PER_DEG;
        }
    }
    return scene;
}

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    const struct scene_text *const text  = loaded;
    struct dig_scene               scene = convert(text);
    (void)path;
    c->status = dig_bed_convert(&text->bed, &scene.bed, c->error);
    if (c->status == DIG_OK) {
        c->status = dig_scene_check(&scene, c->error);
    }
    if (c->status == DIG_OK) {
        *(struct dig_scene *)into = scene;
    }
}

enum dig_status dig_scene_read(const char *const path, struct dig_scene *const scene,
                               struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, scene, error);
}
