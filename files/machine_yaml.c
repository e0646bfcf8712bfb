#include "files/machine_yaml.h"

#include "core/geometry.h"
#include "core/units.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

// A machine of either kind, angles still in degrees; what the other kind has stays 0.
struct machine_text {
    struct dig_machine machine;
    char              *source;
};

static const cyaml_schema_field_t link_fields[] = {
    NUMBER(dig_link, length_m),
    NUMBER(dig_link, mass_kg),
    NUMBERS("com_m", REQUIRED, dig_link, com_m),
    NUMBER(dig_link, inertia_kgm2),
    CYAML_FIELD_FLOAT("min_deg", REQUIRED, struct dig_link, min_rad),
    CYAML_FIELD_FLOAT("max_deg", REQUIRED, struct dig_link, max_rad),
    SOURCE,
    CYAML_FIELD_END,
};

#define CYLINDER_FIELDS                                                                            \
    NUMBER(dig_cylinder, count), NUMBER(dig_cylinder, bore_m), NUMBER(dig_cylinder, rod_m),        \
        NUMBER(dig_cylinder, relief_Pa), NUMBER(dig_cylinder, back_Pa),                            \
        NUMBER(dig_cylinder, min_length_m), NUMBER(dig_cylinder, max_length_m),                    \
        NUMBERS("base_m", REQUIRED, dig_cylinder, base_m),                                         \
        NUMBER(dig_cylinder, pressure_sigma_Pa), SOURCE

static const cyaml_schema_field_t cylinder_fields[] = {
    CYLINDER_FIELDS,
    NUMBERS("eye_m", REQUIRED, dig_cylinder, eye_m),
    CYAML_FIELD_END,
};

// The bucket cylinder's eye is the joint of rocker and link, so it has no place of its own.
static const cyaml_schema_field_t bucket_cylinder_fields[] = {
    CYLINDER_FIELDS,
    CYAML_FIELD_END,
};

#define CYLINDER(key, joint, fields)                                                               \
    CYAML_FIELD_MAPPING(key, REQUIRED, struct dig_machine, cylinder[joint], fields)

static const cyaml_schema_field_t cylinders_fields[] = {
    CYLINDER("boom", DIG_JOINT_BOOM, cylinder_fields),
    CYLINDER("arm", DIG_JOINT_ARM, cylinder_fields),
    CYLINDER("bucket", DIG_JOINT_BUCKET, bucket_cylinder_fields),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t four_bar_fields[] = {
    NUMBERS("rocker_pin_m", REQUIRED, dig_four_bar, rocker_pin_m),
    NUMBER(dig_four_bar, rocker_m),
    NUMBER(dig_four_bar, link_m),
    NUMBERS("ear_m", REQUIRED, dig_four_bar, ear_m),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t sensors_fields[] = {
    NUMBER(dig_machine, pressure_step_Pa),
    NUMBER(dig_machine, angle_step_rad),
    NUMBER(dig_machine, angle_sigma_rad),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t tolerance_fields[] = {
    NUMBER(dig_tolerance, pin_m),
    NUMBER(dig_tolerance, mass_share),
    NUMBER(dig_tolerance, com_share),
    SOURCE,
    CYAML_FIELD_END,
};

// Without `tolerance` in the file; ours. A machine measured with a tape, its masses and centres
// estimated from drawings; a rig that was machined, and weighed.
static const struct dig_tolerance measured = { 2.0e-3, 0.05, 0.02 };
static const struct dig_tolerance machined = { 2.0e-4, 0.01, 0.01 };

static const cyaml_schema_field_t ground_fields[] = {
    NUMBER(dig_machine, weight_N),
    NUMBER(dig_machine, weight_X_m),
    NUMBER(dig_machine, tip_front_X_m),
    NUMBER(dig_machine, tip_rear_X_m),
    NUMBER(dig_machine, boom_foot_Z_m),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t force_sensor_fields[] = {
    NUMBERS("place_m", REQUIRED, dig_force_sensor, place_m),
    CYAML_FIELD_FLOAT("turn_deg", REQUIRED, struct dig_force_sensor, turn_rad),
    NUMBER(dig_force_sensor, limit_N),
    NUMBER(dig_force_sensor, limit_Nm),
    NUMBER(dig_force_sensor, step_N),
    NUMBER(dig_force_sensor, step_Nm),
    NUMBER(dig_force_sensor, sigma_N),
    NUMBER(dig_force_sensor, sigma_Nm),
    NUMBER(dig_force_sensor, path_sigma_m),
    SOURCE,
    CYAML_FIELD_END,
};

// A rig has no pressures.
static const cyaml_schema_field_t rig_sensors_fields[] = {
    NUMBER(dig_machine, angle_step_rad),
    NUMBER(dig_machine, angle_sigma_rad),
    SOURCE,
    CYAML_FIELD_END,
};

#define PART(key, member, fields)                                                                  \
    CYAML_FIELD_MAPPING(key, REQUIRED, struct machine_text, member, fields)

// What both kinds have.
#define NAME                                                                                       \
    CYAML_FIELD_STRING("name", REQUIRED, struct machine_text, machine.name, 1),                    \
        CYAML_FIELD_STRING_PTR("source", REQUIRED, struct machine_text, source, 1,                 \
                               CYAML_UNLIMITED)
#define BUCKET                                                                                     \
    PART("bucket", machine.link[DIG_JOINT_BUCKET], link_fields),                                   \
        CYAML_FIELD_FLOAT("bucket_width_m", REQUIRED, struct machine_text, machine.bucket_width_m)
#define TOLERANCE                                                                                  \
    CYAML_FIELD_MAPPING("tolerance", OPTIONAL, struct machine_text, machine.tolerance,             \
                        tolerance_fields)

static const cyaml_schema_field_t rig_fields[] = {
    NAME,
    BUCKET,
    PART("force_sensor", machine.sensor, force_sensor_fields),
    PART("sensors", machine, rig_sensors_fields),
    TOLERANCE,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t rig_schema = FILE_OF(machine_text, rig_fields);

static const cyaml_schema_field_t machine_fields[] = {
    NAME,
    PART("boom", machine.link[DIG_JOINT_BOOM], link_fields),
    PART("arm", machine.link[DIG_JOINT_ARM], link_fields),
    BUCKET,
    PART("cylinders", machine, cylinders_fields),
    PART("four_bar", machine.four_bar, four_bar_fields),
    PART("sensors", machine, sensors_fields),
    TOLERANCE,
    PART("ground", machine, ground_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t schema = FILE_OF(machine_text, machine_fields);

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    struct dig_machine machine = ((const struct machine_text *)loaded)->machine;
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine.link[j].min_rad *= DIG_RAD_PER_DEG;
        machine.link[j].max_rad *= DIG_RAD_PER_DEG;
    }
    machine.sensor.turn_rad *= DIG_RAD_PER_DEG;
    machine.sensor.fitted = dig_yaml_line(path, "force_sensor") > 0;
    if (dig_yaml_line(path, "tolerance") <= 0) {
        machine.tolerance = machine.sensor.fitted ? machined : measured;
    }

    c->status = dig_machine_check(&machine, c->error);
    if (c->status == DIG_OK) {
        c->status = dig_geometry_check(&machine, c->error);
    }
    if (c->status == DIG_OK) {
        *(struct dig_machine *)into = machine;
    }
}

enum dig_status dig_machine_read(const char *const path, struct dig_machine *const machine,
                                 struct dig_error *const error)
{
    const bool senses = dig_yaml_line(path, "force_sensor") > 0;
    return dig_yaml_read(path, senses ? &rig_schema : &schema, take, machine, error);
}
