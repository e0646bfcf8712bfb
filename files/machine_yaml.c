#include "files/machine_yaml.h"

#include "core/geometry.h"
#include "core/units.h"
#include "files/yaml/yaml.h"

// A machine of either kind; what the other kind has stays 0.
struct machine_text {
    struct dig_machine machine;
    bool               has_tolerance;
};

#define ANGLE(key, type, member)                                                                   \
    FIELD(NUMBER, key, type, member, REQUIRED, .factor = DIG_RAD_PER_DEG)

static const struct dig_yaml_field link_fields[] = {
    NUMBER(dig_link, length_m),
    NUMBER(dig_link, mass_kg),
    NUMBERS("com_m", REQUIRED, dig_link, com_m),
    NUMBER(dig_link, inertia_kgm2),
    ANGLE("min_deg", dig_link, min_rad),
    ANGLE("max_deg", dig_link, max_rad),
    SOURCE,
    END,
};

#define CYLINDER_FIELDS                                                                            \
    NUMBER(dig_cylinder, count), NUMBER(dig_cylinder, bore_m), NUMBER(dig_cylinder, rod_m),        \
        NUMBER(dig_cylinder, relief_Pa), NUMBER(dig_cylinder, back_Pa),                            \
        NUMBER(dig_cylinder, min_length_m), NUMBER(dig_cylinder, max_length_m),                    \
        NUMBERS("base_m", REQUIRED, dig_cylinder, base_m),                                         \
        NUMBER(dig_cylinder, pressure_sigma_Pa), SOURCE

static const struct dig_yaml_field cylinder_fields[] = {
    CYLINDER_FIELDS,
    NUMBERS("eye_m", REQUIRED, dig_cylinder, eye_m),
    END,
};

// The bucket cylinder's eye is the joint of rocker and link, so it has no place of its own.
static const struct dig_yaml_field bucket_cylinder_fields[] = {
    CYLINDER_FIELDS,
    END,
};

#define CYLINDER(key, joint, fields) PART(key, REQUIRED, dig_machine, cylinder[joint], fields)

static const struct dig_yaml_field cylinders_fields[] = {
    CYLINDER("boom", DIG_JOINT_BOOM, cylinder_fields),
    CYLINDER("arm", DIG_JOINT_ARM, cylinder_fields),
    CYLINDER("bucket", DIG_JOINT_BUCKET, bucket_cylinder_fields),
    SOURCE,
    END,
};

static const struct dig_yaml_field four_bar_fields[] = {
    NUMBERS("rocker_pin_m", REQUIRED, dig_four_bar, rocker_pin_m),
    NUMBER(dig_four_bar, rocker_m),
    NUMBER(dig_four_bar, link_m),
    NUMBERS("ear_m", REQUIRED, dig_four_bar, ear_m),
    SOURCE,
    END,
};

static const struct dig_yaml_field sensors_fields[] = {
    NUMBER(dig_machine, pressure_step_Pa),
    NUMBER(dig_machine, angle_step_rad),
    NUMBER(dig_machine, angle_sigma_rad),
    SOURCE,
    END,
};

static const struct dig_yaml_field tolerance_fields[] = {
    NUMBER(dig_tolerance, pin_m),
    NUMBER(dig_tolerance, mass_share),
    NUMBER(dig_tolerance, com_share),
    SOURCE,
    END,
};

// Without `tolerance` in the file; ours. A machine measured with a tape, its masses and centres
// estimated from drawings; a rig that was machined, and weighed.
static const struct dig_tolerance measured = { 2.0e-3, 0.05, 0.02 };
static const struct dig_tolerance machined = { 2.0e-4, 0.01, 0.01 };

static const struct dig_yaml_field ground_fields[] = {
    NUMBER(dig_machine, weight_N),
    NUMBER(dig_machine, weight_X_m),
    NUMBER(dig_machine, tip_front_X_m),
    NUMBER(dig_machine, tip_rear_X_m),
    NUMBER(dig_machine, boom_foot_Z_m),
    SOURCE,
    END,
};

static const struct dig_yaml_field force_sensor_fields[] = {
    NUMBERS("place_m", REQUIRED, dig_force_sensor, place_m),
    ANGLE("turn_deg", dig_force_sensor, turn_rad),
    NUMBER(dig_force_sensor, limit_N),
    NUMBER(dig_force_sensor, limit_Nm),
    NUMBER(dig_force_sensor, step_N),
    NUMBER(dig_force_sensor, step_Nm),
    NUMBER(dig_force_sensor, sigma_N),
    NUMBER(dig_force_sensor, sigma_Nm),
    NUMBER(dig_force_sensor, path_sigma_m),
    SOURCE,
    END,
};

// A rig has no pressures.
static const struct dig_yaml_field rig_sensors_fields[] = {
    NUMBER(dig_machine, angle_step_rad),
    NUMBER(dig_machine, angle_sigma_rad),
    SOURCE,
    END,
};

#define OF_MACHINE(key, member, fields) PART(key, REQUIRED, machine_text, machine.member, fields)
#define WHOLE(key, fields)              PART(key, REQUIRED, machine_text, machine, fields)

// What both kinds have.
#define NAME                                                                                       \
    FIELD(TEXT, "name", machine_text, machine.name, REQUIRED, .least = 1),                         \
    {                                                                                              \
        .key = "source", .kind = DIG_YAML_TEXT, .least = 1                                         \
    }
#define BUCKET                                                                                     \
    OF_MACHINE("bucket", link[DIG_JOINT_BUCKET], link_fields),                                     \
        FIELD(NUMBER, "bucket_width_m", machine_text, machine.bucket_width_m, REQUIRED)
#define TOLERANCE                                                                                  \
    FIELD(MAPPING, "tolerance", machine_text, machine.tolerance, OPTIONAL, .of = tolerance_fields, \
          GIVEN(machine_text, has_tolerance))

static const struct dig_yaml_field rig_fields[] = {
    NAME,
    BUCKET,
    FIELD(MAPPING, "force_sensor", machine_text, machine.sensor, REQUIRED,
          .of = force_sensor_fields, GIVEN(machine_text, machine.sensor.fitted)),
    WHOLE("sensors", rig_sensors_fields),
    TOLERANCE,
    END,
};
static const struct dig_yaml_file rig = { .of   = rig_fields,
                                          .size = sizeof(struct machine_text),
                                          .kept = sizeof(struct dig_machine) };

static const struct dig_yaml_field machine_fields[] = {
    NAME,
    OF_MACHINE("boom", link[DIG_JOINT_BOOM], link_fields),
    OF_MACHINE("arm", link[DIG_JOINT_ARM], link_fields),
    BUCKET,
    WHOLE("cylinders", cylinders_fields),
    OF_MACHINE("four_bar", four_bar, four_bar_fields),
    WHOLE("sensors", sensors_fields),
    TOLERANCE,
    WHOLE("ground", ground_fields),
    END,
};
static const struct dig_yaml_file digger = { .of   = machine_fields,
                                             .size = sizeof(struct machine_text),
                                             .kept = sizeof(struct dig_machine) };

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct machine_text *const text    = loaded;
    struct dig_machine *const  machine = &text->machine;
    (void)path;
    if (!text->has_tolerance) {
        machine->tolerance = machine->sensor.fitted ? machined : measured;
    }
    c->status = dig_machine_check(machine, c->error);
    if (c->status == DIG_OK) {
        c->status = dig_geometry_check(machine, c->error);
    }
}

enum dig_status dig_machine_read(const char *const path, struct dig_machine *const machine,
                                 struct dig_error *const error)
{
    const bool senses = dig_yaml_line(path, "force_sensor") > 0;
    return dig_yaml_read(path, senses ? &rig : &digger, take, machine, error);
}
