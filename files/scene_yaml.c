#include "files/scene_yaml.h"

#include "core/units.h"
#include "files/bed_yaml.h"
#include "files/yaml/yaml.h"

// A scene, beside what is put into it afterwards.
struct scene_text {
    struct dig_scene      scene;
    struct dig_yaml_point profile_m[DIG_PROFILE_MAX];
    struct bed_text       bed;
};

static const struct dig_yaml_field phase_fields[] = {
    TEXT(dig_phase, name),
    NUMBER(dig_phase, duration_s),
    NUMBER(dig_phase, vx_mps),
    NUMBER(dig_phase, vz_mps),
    FIELD(NUMBER, "omega_degps", dig_phase, omega_radps, REQUIRED, .factor = DIG_RAD_PER_DEG),
    SOURCE,
    END,
};
static const struct dig_yaml_field phase = ENTRY(dig_phase, phase_fields);

static const struct dig_yaml_field trajectory_fields[] = {
    TEXT(dig_trajectory, name),
    FIELD(NUMBER, "theta0_deg", dig_trajectory, theta0_rad, REQUIRED, .factor = DIG_RAD_PER_DEG),
    PAIR("start_pin_m", dig_trajectory, start_x_m, start_z_m),
    LIST("phases", REQUIRED, dig_trajectory, phase, phases, &phase, 1),
    SOURCE,
    END,
};
static const struct dig_yaml_field trajectory = ENTRY(dig_trajectory, trajectory_fields);

static const struct dig_yaml_field bucket_fields[] = {
    FIELD(NUMBER, "width_m", scene_text, scene.bucket.width_m, REQUIRED),
    LIST("profile_m", REQUIRED, scene_text, profile_m, scene.bucket.points, &dig_yaml_point, 3),
    SOURCE,
    END,
};

static const struct dig_yaml_field box_fields[] = {
    PAIR("x", dig_box, x_min_m, x_max_m),
    PAIR("y", dig_box, y_min_m, y_max_m),
    PAIR("z", dig_box, z_min_m, z_max_m),
    SOURCE,
    END,
};

static const struct dig_yaml_field packing_fields[] = {
    NUMBER(dig_packing, solid_fraction),
    NUMBER(dig_packing, fill_factor),
    NUMBER(dig_packing, fall_mps),
    NUMBER(dig_packing, settle_s),
    NUMBER(dig_packing, relax_s),
    SOURCE,
    END,
};

static const struct dig_yaml_field material_fields[] = {
    NUMBER(dig_material, diameter_m),
    NUMBER(dig_material, young_Pa),
    NUMBER(dig_material, poisson),
    NUMBER(dig_material, restitution),
    NUMBER(dig_material, characteristic_velocity_mps),
    FIELD(NUMBER, "young_at_kgpm3", dig_material, young_at_kgpm3, OPTIONAL),
    SOURCE,
    END,
};

#define OF_SCENE(kind, member, ...) FIELD(kind, #member, scene_text, scene.member, __VA_ARGS__)

static const struct dig_yaml_field scene_fields[] = {
    OF_SCENE(TEXT, name, REQUIRED, .least = 1),
    ACROSS("bucket", REQUIRED, bucket_fields),
    PART("box_m", REQUIRED, scene_text, scene.box, box_fields),
    OF_SCENE(MAPPING, packing, REQUIRED, .of = packing_fields),
    OF_SCENE(MAPPING, material, REQUIRED, .of = material_fields),
    OF_SCENE(NUMBER, gravity_mps2, REQUIRED),
    OF_SCENE(NUMBER, time_step_s, REQUIRED),
    OF_SCENE(BOOL, may_tremble, OPTIONAL),
    OF_SCENE(NUMBER, output_s, REQUIRED),
    LIST("trajectories", REQUIRED, scene_text, scene.trajectory, scene.trajectories, &trajectory,
         1),
    OF_SCENE(MAPPING, laws, OPTIONAL, .of = dig_laws_fields),
    PART("bed", OPTIONAL, scene_text, bed, dig_bed_fields),
    SOURCE,
    END,
};

static const struct dig_yaml_file schema = { .of   = scene_fields,
                                             .size = sizeof(struct scene_text),
                                             .kept = sizeof(struct dig_scene) };

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct scene_text *const text  = loaded;
    struct dig_scene *const  scene = &text->scene;
    (void)path;
    dig_bed_polyline(scene->bucket.points, text->profile_m, scene->bucket.x_m, scene->bucket.z_m);
    c->status = dig_bed_convert(&text->bed, &scene->bed, c->error);
    if (c->status == DIG_OK) {
        c->status = dig_scene_check(scene, c->error);
    }
}

enum dig_status dig_scene_read(const char *const path, struct dig_scene *const scene,
                               struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, scene, error);
}
