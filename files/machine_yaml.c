#include "files/machine_yaml.h"

#include "core/geometry.h"
#include "core/units.h"
#include "files/yaml.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

// The file as it is written: degrees, and points as lists.
struct link_text {
    double length_m, mass_kg, com_m[2], inertia_kgm2, min_deg, max_deg;
};

struct cylinder_text {
    double count, bore_m, rod_m, relief_Pa, back_Pa, min_length_m, max_length_m;
    double base_m[2], eye_m[2], pressure_sigma_Pa;
};

struct cylinders_text {
    struct cylinder_text boom, arm, bucket;
};

struct four_bar_text {
    double rocker_pin_m[2], rocker_m, link_m, ear_m[2];
};

struct sensors_text {
    double pressure_step_Pa, angle_step_rad, angle_sigma_rad;
};

struct force_sensor_text {
    double place_m[2], turn_deg, limit_N, limit_Nm, step_N, step_Nm, sigma_N, sigma_Nm;
    double path_sigma_m;
};

struct tolerance_text {
    double pin_m, mass_share, com_share;
};

struct ground_text {
    double weight_N, weight_X_m, tip_front_X_m, tip_rear_X_m, boom_foot_Z_m;
};

// Of either kind; what the other has stays 0.
struct machine_text {
    char                     name[sizeof((struct dig_machine *)NULL)->name];
    char                    *source;
    struct link_text         boom, arm, bucket;
    double                   bucket_width_m;
    struct cylinders_text    cylinders;
    struct four_bar_text     four_bar;
    struct sensors_text      sensors;
    struct tolerance_text    tolerance;
    struct ground_text       ground;
    struct force_sensor_text force_sensor;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define SOURCE   CYAML_FIELD_IGNORE("source", CYAML_FLAG_OPTIONAL)

static const cyaml_schema_value_t number = { CYAML_VALUE_FLOAT(REQUIRED, double) };

static const cyaml_schema_field_t link_fields[] = {
    CYAML_FIELD_FLOAT("length_m", REQUIRED, struct link_text, length_m),
    CYAML_FIELD_FLOAT("mass_kg", REQUIRED, struct link_text, mass_kg),
    CYAML_FIELD_SEQUENCE_FIXED("com_m", REQUIRED, struct link_text, com_m, &number, 2),
    CYAML_FIELD_FLOAT("inertia_kgm2", REQUIRED, struct link_text, inertia_kgm2),
    CYAML_FIELD_FLOAT("min_deg", REQUIRED, struct link_text, min_deg),
    CYAML_FIELD_FLOAT("max_deg", REQUIRED, struct link_text, max_deg),
    SOURCE,
    CYAML_FIELD_END,
};

#define CYLINDER_FIELDS                                                                            \
    CYAML_FIELD_FLOAT("count", REQUIRED, struct cylinder_text, count),                             \
        CYAML_FIELD_FLOAT("bore_m", REQUIRED, struct cylinder_text, bore_m),                       \
        CYAML_FIELD_FLOAT("rod_m", REQUIRED, struct cylinder_text, rod_m),                         \
        CYAML_FIELD_FLOAT("relief_Pa", REQUIRED, struct cylinder_text, relief_Pa),                 \
        CYAML_FIELD_FLOAT("back_Pa", REQUIRED, struct cylinder_text, back_Pa),                     \
        CYAML_FIELD_FLOAT("min_length_m", REQUIRED, struct cylinder_text, min_length_m),           \
        CYAML_FIELD_FLOAT("max_length_m", REQUIRED, struct cylinder_text, max_length_m),           \
        CYAML_FIELD_SEQUENCE_FIXED("base_m", REQUIRED, struct cylinder_text, base_m, &number, 2),  \
        CYAML_FIELD_FLOAT("pressure_sigma_Pa", REQUIRED, struct cylinder_text, pressure_sigma_Pa), \
        SOURCE

static const cyaml_schema_field_t cylinder_fields[] = {
    CYLINDER_FIELDS,
    CYAML_FIELD_SEQUENCE_FIXED("eye_m", REQUIRED, struct cylinder_text, eye_m, &number, 2),
    CYAML_FIELD_END,
};

// The bucket cylinder's eye is the joint of rocker and link, so it has no place of its own.
static const cyaml_schema_field_t bucket_cylinder_fields[] = {
    CYLINDER_FIELDS,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t cylinders_fields[] = {
    CYAML_FIELD_MAPPING("boom", REQUIRED, struct cylinders_text, boom, cylinder_fields),
    CYAML_FIELD_MAPPING("arm", REQUIRED, struct cylinders_text, arm, cylinder_fields),
    CYAML_FIELD_MAPPING("bucket", REQUIRED, struct cylinders_text, bucket, bucket_cylinder_fields),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t four_bar_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("rocker_pin_m", REQUIRED, struct four_bar_text, rocker_pin_m,
                               &number, 2),
    CYAML_FIELD_FLOAT("rocker_m", REQUIRED, struct four_bar_text, rocker_m),
    CYAML_FIELD_FLOAT("link_m", REQUIRED, struct four_bar_text, link_m),
    CYAML_FIELD_SEQUENCE_FIXED("ear_m", REQUIRED, struct four_bar_text, ear_m, &number, 2),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t sensors_fields[] = {
    CYAML_FIELD_FLOAT("pressure_step_Pa", REQUIRED, struct sensors_text, pressure_step_Pa),
    CYAML_FIELD_FLOAT("angle_step_rad", REQUIRED, struct sensors_text, angle_step_rad),
    CYAML_FIELD_FLOAT("angle_sigma_rad", REQUIRED, struct sensors_text, angle_sigma_rad),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t tolerance_fields[] = {
    CYAML_FIELD_FLOAT("pin_m", REQUIRED, struct tolerance_text, pin_m),
    CYAML_FIELD_FLOAT("mass_share", REQUIRED, struct tolerance_text, mass_share),
    CYAML_FIELD_FLOAT("com_share", REQUIRED, struct tolerance_text, com_share),
    SOURCE,
    CYAML_FIELD_END,
};

// Without `tolerance` in the file; ours. A machine measured with a tape, its masses and centres
// estimated from drawings; a rig that was machined, and weighed.
static const struct dig_tolerance measured = { 2.0e-3, 0.05, 0.02 };
static const struct dig_tolerance machined = { 2.0e-4, 0.01, 0.01 };

static const cyaml_schema_field_t ground_fields[] = {
    CYAML_FIELD_FLOAT("weight_N", REQUIRED, struct ground_text, weight_N),
    CYAML_FIELD_FLOAT("weight_X_m", REQUIRED, struct ground_text, weight_X_m),
    CYAML_FIELD_FLOAT("tip_front_X_m", REQUIRED, struct ground_text, tip_front_X_m),
    CYAML_FIELD_FLOAT("tip_rear_X_m", REQUIRED, struct ground_text, tip_rear_X_m),
    CYAML_FIELD_FLOAT("boom_foot_Z_m", REQUIRED, struct ground_text, boom_foot_Z_m),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t force_sensor_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("place_m", REQUIRED, struct force_sensor_text, place_m, &number, 2),
    CYAML_FIELD_FLOAT("turn_deg", REQUIRED, struct force_sensor_text, turn_deg),
    CYAML_FIELD_FLOAT("limit_N", REQUIRED, struct force_sensor_text, limit_N),
    CYAML_FIELD_FLOAT("limit_Nm", REQUIRED, struct force_sensor_text, limit_Nm),
    CYAML_FIELD_FLOAT("step_N", REQUIRED, struct force_sensor_text, step_N),
    CYAML_FIELD_FLOAT("step_Nm", REQUIRED, struct force_sensor_text, step_Nm),
    CYAML_FIELD_FLOAT("sigma_N", REQUIRED, struct force_sensor_text, sigma_N),
    CYAML_FIELD_FLOAT("sigma_Nm", REQUIRED, struct force_sensor_text, sigma_Nm),
    CYAML_FIELD_FLOAT("path_sigma_m", REQUIRED, struct force_sensor_text, path_sigma_m),
    SOURCE,
    CYAML_FIELD_END,
};

// A rig has no pressures.
static const cyaml_schema_field_t rig_sensors_fields[] = {
    CYAML_FIELD_FLOAT("angle_step_rad", REQUIRED, struct sensors_text, angle_step_rad),
    CYAML_FIELD_FLOAT("angle_sigma_rad", REQUIRED, struct sensors_text, angle_sigma_rad),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t rig_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct machine_text, name, 1),
    CYAML_FIELD_STRING_PTR("source", REQUIRED, struct machine_text, source, 1, CYAML_UNLIMITED),
    CYAML_FIELD_MAPPING("bucket", REQUIRED, struct machine_text, bucket, link_fields),
    CYAML_FIELD_FLOAT("bucket_width_m", REQUIRED, struct machine_text, bucket_width_m),
    CYAML_FIELD_MAPPING("force_sensor", REQUIRED, struct machine_text, force_sensor,
                        force_sensor_fields),
    CYAML_FIELD_MAPPING("sensors", REQUIRED, struct machine_text, sensors, rig_sensors_fields),
    CYAML_FIELD_MAPPING("tolerance", CYAML_FLAG_OPTIONAL, struct machine_text, tolerance,
                        tolerance_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t rig_schema = { CYAML_VALUE_MAPPING(
    CYAML_FLAG_POINTER, struct machine_text, rig_fields) };

static const cyaml_schema_field_t machine_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct machine_text, name, 1),
    CYAML_FIELD_STRING_PTR("source", REQUIRED, struct machine_text, source, 1, CYAML_UNLIMITED),
    CYAML_FIELD_MAPPING("boom", REQUIRED, struct machine_text, boom, link_fields),
    CYAML_FIELD_MAPPING("arm", REQUIRED, struct machine_text, arm, link_fields),
    CYAML_FIELD_MAPPING("bucket", REQUIRED, struct machine_text, bucket, link_fields),
    CYAML_FIELD_FLOAT("bucket_width_m", REQUIRED, struct machine_text, bucket_width_m),
    CYAML_FIELD_MAPPING("cylinders", REQUIRED, struct machine_text, cylinders, cylinders_fields),
    CYAML_FIELD_MAPPING("four_bar", REQUIRED, struct machine_text, four_bar, four_bar_fields),
    CYAML_FIELD_MAPPING("sensors", REQUIRED, struct machine_text, sensors, sensors_fields),
    CYAML_FIELD_MAPPING("tolerance", CYAML_FLAG_OPTIONAL, struct machine_text, tolerance,
                        tolerance_fields),
    CYAML_FIELD_MAPPING("ground", REQUIRED, struct machine_text, ground, ground_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(
    CYAML_FLAG_POINTER, struct machine_text, machine_fields) };

static struct dig_vec2 vec2(const double xy[const 2])
{
    return (struct dig_vec2){ xy[0], xy[1] };
}

static struct dig_link convert_link(const struct link_text *const text)
{
    return (struct dig_link){
        .length_m     = text->length_m,
        .mass_kg      = text->mass_kg,
        .com_m        = vec2(text->com_m),
        .inertia_kgm2 = text->inertia_kgm2,
        .min_rad      = text->min_deg * DIG_RAD_PER_DEG,
        .max_rad      = text->max_deg * DIG_RAD_PER_DEG,
    };
}

static struct dig_cylinder convert_cylinder(const struct cylinder_text *const text)
{
    return (struct dig_cylinder){
        .count             = text->count,
        .bore_m            = text->bore_m,
        .rod_m             = text->rod_m,
        .relief_Pa         = text->relief_Pa,
        .back_Pa           = text->back_Pa,
        .min_length_m      = text->min_length_m,
        .max_length_m      = text->max_length_m,
        .base_m            = vec2(text->base_m),
        .eye_m             = vec2(text->eye_m),
        .pressure_sigma_Pa = text->pressure_sigma_Pa,
    };
}

static struct dig_force_sensor convert_sensor(const struct force_sensor_text *const text)
{
    return (struct dig_force_sensor){
        .fitted       = true,
        .place_m      = vec2(text->place_m),
        .turn_rad     = text->turn_deg * DIG_RAD_PER_DEG,
        .limit_N      = text->limit_N,
        .limit_Nm     = text->limit_Nm,
        .step_N       = text->step_N,
        .step_Nm      = text->step_Nm,
        .sigma_N      = text->sigma_N,
        .sigma_Nm     = text->sigma_Nm,
        .path_sigma_m = text->path_sigma_m,
    };
}

static struct dig_machine convert(const struct machine_text *const text, const bool senses)
{
    struct dig_machine machine = {
        .link = {
            [DIG_JOINT_BOOM]   = convert_link(&text->boom),
            [DIG_JOINT_ARM]    = convert_link(&text->arm),
            [DIG_JOINT_BUCKET] = convert_link(&text->bucket),
        },
        .cylinder = {
            [DIG_JOINT_BOOM]   = convert_cylinder(&text->cylinders.boom),
            [DIG_JOINT_ARM]    = convert_cylinder(&text->cylinders.arm),
            [DIG_JOINT_BUCKET] = convert_cylinder(&text->cylinders.bucket),
        },
        .four_bar = {
            .rocker_pin_m = vec2(text->four_bar.rocker_pin_m),
            .rocker_m     = text->four_bar.rocker_m,
            .link_m       = text->four_bar.link_m,
            .ear_m        = vec2(text->four_bar.ear_m),
        },
        .tolerance        = { .pin_m      = text->tolerance.pin_m,
                              .mass_share = text->tolerance.mass_share,
                              .com_share  = text->tolerance.com_share },
        .bucket_width_m   = text->bucket_width_m,
        .pressure_step_Pa = text->sensors.pressure_step_Pa,
        .angle_step_rad   = text->sensors.angle_step_rad,
        .angle_sigma_rad  = text->sensors.angle_sigma_rad,
        .weight_N         = text->ground.weight_N,
        .weight_X_m       = text->ground.weight_X_m,
        .tip_front_X_m    = text->ground.tip_front_X_m,
        .tip_rear_X_m     = text->ground.tip_rear_X_m,
        .boom_foot_Z_m    = text->ground.boom_foot_Z_m,
    };
    if (senses) {
        machine.sensor = convert_sensor(&text->force_sensor);
    }
    memcpy(machine.name, text->name, sizeof machine.name);
    return machine;
}

enum dig_status dig_machine_read(const char *const path, struct dig_machine *const machine,
                                 struct dig_error *const error)
{
    assert(path != NULL && machine != NULL);

    const bool                        senses = dig_yaml_line(path, "force_sensor") > 0;
    const cyaml_schema_value_t *const kind   = senses ? &rig_schema : &schema;
    cyaml_data_t                     *data   = NULL;
    enum dig_status                   status = dig_yaml_load(path, kind, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_machine loaded = convert(data, senses);
    if (dig_yaml_line(path, "tolerance") <= 0) {
        loaded.tolerance = senses ? machined : measured;
    }
    dig_yaml_free(kind, data);

    struct dig_error found = { "" };
    status                 = dig_machine_check(&loaded, &found);
    status                 = status == DIG_OK ? dig_geometry_check(&loaded, &found) : status;
    if (status != DIG_OK) {
        return dig_yaml_refuse_checked(path, status, &found, error);
    }
    *machine = loaded;
    return DIG_OK;
}
