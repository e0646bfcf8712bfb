#include "core/machine.h"

#include "core/name.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const char *const joint_names[DIG_JOINTS] = {
    [DIG_JOINT_BOOM]   = "boom",
    [DIG_JOINT_ARM]    = "arm",
    [DIG_JOINT_BUCKET] = "bucket",
};

const char *dig_joint_name(const enum dig_joint joint)
{
    assert(joint < DIG_JOINTS);
    return joint_names[joint];
}

double dig_cylinder_head_m2(const struct dig_cylinder *const cylinder)
{
    return 0.25 * DIG_PI * cylinder->bore_m * cylinder->bore_m;
}

double dig_cylinder_rod_m2(const struct dig_cylinder *const cylinder)
{
    return dig_cylinder_head_m2(cylinder) - 0.25 * DIG_PI * cylinder->rod_m * cylinder->rod_m;
}

// A value of the file, and whether it can be.
struct value {
    const char *key; // in its group
    double      found;
    bool        can_be;
    const char *expected;
};

#define COUNT(values) (sizeof(values) / sizeof(values)[0])

static bool is_positive(const double value)
{
    return value > 0.0 && isfinite(value);
}

static bool is_not_negative(const double value)
{
    return value >= 0.0 && isfinite(value);
}

// member: of the group; "": the group itself.
static void check_values(struct dig_conditions *const c, const char *const group,
                         const char *const member, const size_t count, const struct value value[])
{
    for (size_t i = 0; i < count; i++) {
        dig_require(c, value[i].can_be, "%s%s%s.%s: %g, expected %s", group,
                    member[0] == '\0' ? "" : ".", member, value[i].key, value[i].found,
                    value[i].expected);
    }
}

static void check_link(const struct dig_link *const link, const char *const name,
                       struct dig_conditions *const c)
{
    const double       most     = 2.0 * DIG_PI;
    const struct value values[] = {
        { "length_m", link->length_m, link->length_m > 0.0 && link->length_m < 100.0,
          "metres, > 0 and < 100" },
        { "mass_kg", link->mass_kg, is_positive(link->mass_kg), "a number > 0" },
        { "inertia_kgm2", link->inertia_kgm2, is_positive(link->inertia_kgm2), "a number > 0" },
        { "com_m", NAN, dig_vec2_is_finite(link->com_m), "two finite numbers" },
        { "min_deg", link->min_rad / DIG_RAD_PER_DEG, fabs(link->min_rad) <= most,
          "an angle within +-360" },
        { "max_deg", link->max_rad / DIG_RAD_PER_DEG,
          link->max_rad > link->min_rad && link->max_rad <= most,
          "an angle greater than min_deg, at most 360" },
    };
    check_values(c, name, "", COUNT(values), values);
}

static void check_cylinder(const struct dig_cylinder *const c, const enum dig_joint joint,
                           struct dig_conditions *const k)
{
    const bool         has_eye  = joint != DIG_JOINT_BUCKET;
    const struct value values[] = {
        { "count", c->count, c->count >= 1.0 && c->count <= 4.0, "1 to 4" },
        { "bore_m", c->bore_m, c->bore_m > 0.0 && c->bore_m < 1.0, "metres, > 0 and < 1" },
        { "rod_m", c->rod_m, c->rod_m > 0.0 && c->rod_m < c->bore_m, "> 0 and less than bore_m" },
        { "relief_Pa", c->relief_Pa, c->relief_Pa > 1e5 && c->relief_Pa < 1e8,
          "pascals, 1e5 to 1e8" },
        { "back_Pa", c->back_Pa, c->back_Pa >= 0.0 && c->back_Pa < c->relief_Pa,
          ">= 0 and less than relief_Pa" },
        { "min_length_m", c->min_length_m, is_positive(c->min_length_m), "a number > 0" },
        { "max_length_m", c->max_length_m,
          c->max_length_m > c->min_length_m && isfinite(c->max_length_m),
          "greater than min_length_m" },
        { "base_m", NAN, dig_vec2_is_finite(c->base_m), "two finite numbers" },
        { "eye_m", NAN, !has_eye || dig_vec2_is_finite(c->eye_m), "two finite numbers" },
        { "pressure_sigma_Pa", c->pressure_sigma_Pa, is_not_negative(c->pressure_sigma_Pa),
          ">= 0" },
    };
    check_values(k, "cylinders", dig_joint_name(joint), COUNT(values), values);
}

static void check_four_bar(const struct dig_four_bar *const bar, struct dig_conditions *const c)
{
    const struct value values[] = {
        { "rocker_m", bar->rocker_m, is_positive(bar->rocker_m), "a number > 0" },
        { "link_m", bar->link_m, is_positive(bar->link_m), "a number > 0" },
        { "rocker_pin_m", NAN, dig_vec2_is_finite(bar->rocker_pin_m), "two finite numbers" },
        { "ear_m", NAN, dig_vec2_is_finite(bar->ear_m) && dig_vec2_norm(bar->ear_m) > 0.0,
          "two finite numbers, not both 0" },
    };
    check_values(c, "four_bar", "", COUNT(values), values);
}

static bool is_below(const double value, const double limit)
{
    return value >= 0.0 && value < limit;
}

static void check_sensor(const struct dig_machine *const machine, struct dig_conditions *const c)
{
    static const double                  farthest = 10.0; // bucket lengths: beyond, a slip of units
    const struct dig_force_sensor *const s        = &machine->sensor;
    const double                         place_m  = dig_vec2_norm(s->place_m);
    const double                         bucket_m = machine->link[DIG_JOINT_BUCKET].length_m;
    const char *const                    smaller  = ">= 0 and less than the limit";
    const struct value                   values[] = {
                          { "place_m", place_m, place_m <= farthest * bucket_m, "at most ten bucket lengths away" },
                          { "turn_deg", s->turn_rad / DIG_RAD_PER_DEG, fabs(s->turn_rad) <= 2.0 * DIG_PI,
                            "an angle within +-360" },
                          { "limit_N", s->limit_N, is_positive(s->limit_N), "a number > 0" },
                          { "step_N", s->step_N, is_below(s->step_N, s->limit_N), smaller },
                          { "sigma_N", s->sigma_N, is_below(s->sigma_N, s->limit_N), smaller },
                          { "limit_Nm", s->limit_Nm, is_positive(s->limit_Nm), "a number > 0" },
                          { "step_Nm", s->step_Nm, is_below(s->step_Nm, s->limit_Nm), smaller },
                          { "sigma_Nm", s->sigma_Nm, is_below(s->sigma_Nm, s->limit_Nm), smaller },
                          { "path_sigma_m", s->path_sigma_m, is_not_negative(s->path_sigma_m), ">= 0" },
    };
    check_values(c, "force_sensor", "", COUNT(values), values);
}

// What keeps a machine with cylinders on the ground.
static void check_ground(const struct dig_machine *const m, struct dig_conditions *const c)
{
    const struct value values[] = {
        { "weight_N", m->weight_N, is_positive(m->weight_N), "a number > 0" },
        { "tip_front_X_m", m->tip_front_X_m,
          m->tip_front_X_m > m->tip_rear_X_m && isfinite(m->tip_front_X_m),
          "greater than tip_rear_X_m" },
        { "weight_X_m", m->weight_X_m,
          m->weight_X_m > m->tip_rear_X_m && m->weight_X_m < m->tip_front_X_m,
          "between tip_rear_X_m and tip_front_X_m" },
        { "boom_foot_Z_m", m->boom_foot_Z_m, isfinite(m->boom_foot_Z_m), "a finite number" },
    };
    check_values(c, "ground", "", COUNT(values), values);
}

static void check_tolerance(const struct dig_machine *const machine, struct dig_conditions *const c)
{
    static const double               most     = 0.5; // beyond it the file says nothing
    const struct dig_tolerance *const t        = &machine->tolerance;
    const double                      bucket_m = machine->link[DIG_JOINT_BUCKET].length_m;
    const struct value                values[] = {
                       { "pin_m", t->pin_m, is_below(t->pin_m, most * bucket_m),
                         ">= 0 and less than half the bucket's length" },
                       { "mass_share", t->mass_share, is_below(t->mass_share, most), ">= 0 and less than 0.5" },
                       { "com_share", t->com_share, is_below(t->com_share, most), ">= 0 and less than 0.5" },
    };
    check_values(c, "tolerance", "", COUNT(values), values);
}

// Sensors of a machine of either kind, its tolerances and the bucket's width.
static void check_rest(const struct dig_machine *const m, struct dig_conditions *const c)
{
    const struct value values[] = {
        { "pressure_step_Pa", m->pressure_step_Pa, is_not_negative(m->pressure_step_Pa), ">= 0" },
        { "angle_step_rad", m->angle_step_rad, is_not_negative(m->angle_step_rad), ">= 0" },
        { "angle_sigma_rad", m->angle_sigma_rad, is_not_negative(m->angle_sigma_rad), ">= 0" },
    };
    check_values(c, "sensors", "", COUNT(values), values);
    dig_require(c, is_positive(m->bucket_width_m), "bucket_width_m: %g, expected a number > 0",
                m->bucket_width_m);
    check_tolerance(m, c);
}

enum dig_status dig_machine_check(const struct dig_machine *const machine,
                                  struct dig_error *const         error)
{
    assert(machine != NULL);

    struct dig_conditions c = { .error = error };
    dig_require(&c, dig_label_ok(machine->name), "name: \"%s\", expected " DIG_LABEL_RULE,
                machine->name);
    if (machine->sensor.fitted) {
        check_link(&machine->link[DIG_JOINT_BUCKET], "bucket", &c);
        check_sensor(machine, &c);
        check_rest(machine, &c);
        return c.status;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        check_link(&machine->link[j], dig_joint_name((enum dig_joint)j), &c);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        check_cylinder(&machine->cylinder[j], (enum dig_joint)j, &c);
    }
    check_four_bar(&machine->four_bar, &c);
    check_rest(machine, &c);
    check_ground(machine, &c);
    return c.status;
}
