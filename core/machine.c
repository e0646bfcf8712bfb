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

static enum dig_status refuse(struct dig_error *const error, const char *const group,
                              const char *const member, const char *const key, const double found,
                              const char *const expected)
{
    const char *const dot = member[0] == '\0' ? "" : ".";
    return dig_error_set(error, DIG_EINVAL, "%s%s%s.%s: %g, expected %s", group, dot, member, key,
                         found, expected);
}

static enum dig_status check_link(const struct dig_link *const link, const char *const name,
                                  struct dig_error *const error)
{
    const struct {
        const char *key;
        double      value;
    } positive[] = {
        { "length_m", link->length_m },
        { "mass_kg", link->mass_kg },
        { "inertia_kgm2", link->inertia_kgm2 },
    };
    for (size_t i = 0; i < sizeof positive / sizeof positive[0]; i++) {
        if (!(isfinite(positive[i].value) && positive[i].value > 0.0)) {
            return refuse(error, name, "", positive[i].key, positive[i].value, "a number > 0");
        }
    }
    if (!dig_vec2_is_finite(link->com_m)) {
        return refuse(error, name, "", "com_m", NAN, "two finite numbers");
    }
    if (!(isfinite(link->min_rad) && fabs(link->min_rad) <= 2.0 * DIG_PI)) {
        return refuse(error, name, "", "min_deg", link->min_rad / DIG_RAD_PER_DEG,
                      "an angle within +-360");
    }
    if (!(link->max_rad > link->min_rad && link->max_rad <= 2.0 * DIG_PI)) {
        return refuse(error, name, "", "max_deg", link->max_rad / DIG_RAD_PER_DEG,
                      "an angle greater than min_deg, at most 360");
    }
    return DIG_OK;
}

static enum dig_status check_cylinder(const struct dig_cylinder *const cylinder,
                                      const enum dig_joint joint, struct dig_error *const error)
{
    const char *const group = "cylinders";
    const char *const name  = dig_joint_name(joint);
    if (!(cylinder->count >= 1.0 && cylinder->count <= 4.0)) {
        return refuse(error, group, name, "count", cylinder->count, "1 to 4");
    }
    if (!(cylinder->bore_m > 0.0 && cylinder->bore_m < 1.0)) {
        return refuse(error, group, name, "bore_m", cylinder->bore_m, "metres, > 0 and < 1");
    }
    if (!(cylinder->rod_m > 0.0 && cylinder->rod_m < cylinder->bore_m)) {
        return refuse(error, group, name, "rod_m", cylinder->rod_m, "> 0 and less than bore_m");
    }
    if (!(cylinder->relief_Pa > 1e5 && cylinder->relief_Pa < 1e8)) {
        return refuse(error, group, name, "relief_Pa", cylinder->relief_Pa, "pascals, 1e5 to 1e8");
    }
    if (!(cylinder->back_Pa >= 0.0 && cylinder->back_Pa < cylinder->relief_Pa)) {
        return refuse(error, group, name, "back_Pa", cylinder->back_Pa,
                      ">= 0 and less than relief_Pa");
    }
    if (!(cylinder->min_length_m > 0.0 && isfinite(cylinder->min_length_m))) {
        return refuse(error, group, name, "min_length_m", cylinder->min_length_m, "a number > 0");
    }
    if (!(cylinder->max_length_m > cylinder->min_length_m && isfinite(cylinder->max_length_m))) {
        return refuse(error, group, name, "max_length_m", cylinder->max_length_m,
                      "greater than min_length_m");
    }
    if (!dig_vec2_is_finite(cylinder->base_m)) {
        return refuse(error, group, name, "base_m", NAN, "two finite numbers");
    }
    if (joint != DIG_JOINT_BUCKET && !dig_vec2_is_finite(cylinder->eye_m)) {
        return refuse(error, group, name, "eye_m", NAN, "two finite numbers");
    }
    if (!(cylinder->pressure_sigma_Pa >= 0.0 && isfinite(cylinder->pressure_sigma_Pa))) {
        return refuse(error, group, name, "pressure_sigma_Pa", cylinder->pressure_sigma_Pa, ">= 0");
    }
    return DIG_OK;
}

static enum dig_status check_four_bar(const struct dig_four_bar *const bar,
                                      struct dig_error *const          error)
{
    if (!(bar->rocker_m > 0.0 && isfinite(bar->rocker_m))) {
        return refuse(error, "four_bar", "", "rocker_m", bar->rocker_m, "a number > 0");
    }
    if (!(bar->link_m > 0.0 && isfinite(bar->link_m))) {
        return refuse(error, "four_bar", "", "link_m", bar->link_m, "a number > 0");
    }
    if (!dig_vec2_is_finite(bar->rocker_pin_m)) {
        return refuse(error, "four_bar", "", "rocker_pin_m", NAN, "two finite numbers");
    }
    if (!(dig_vec2_is_finite(bar->ear_m) && dig_vec2_norm(bar->ear_m) > 0.0)) {
        return refuse(error, "four_bar", "", "ear_m", NAN, "two finite numbers, not both 0");
    }
    return DIG_OK;
}

static enum dig_status check_sensor(const struct dig_machine *const machine,
                                    struct dig_error *const         error)
{
    static const double                  farthest = 10.0; // bucket lengths: beyond, a slip of units
    const char *const                    group    = "force_sensor";
    const struct dig_force_sensor *const sensor   = &machine->sensor;
    const double                         place_m  = dig_vec2_norm(sensor->place_m);
    if (!(place_m <= farthest * machine->link[DIG_JOINT_BUCKET].length_m)) {
        return refuse(error, group, "", "place_m", place_m, "at most ten bucket lengths away");
    }
    if (!(fabs(sensor->turn_rad) <= 2.0 * DIG_PI)) {
        return refuse(error, group, "", "turn_deg", sensor->turn_rad / DIG_RAD_PER_DEG,
                      "an angle within +-360");
    }
    const struct {
        const char *key;
        double      limit, step, sigma;
    } ranges[] = {
        { "limit_N", sensor->limit_N, sensor->step_N, sensor->sigma_N },
        { "limit_Nm", sensor->limit_Nm, sensor->step_Nm, sensor->sigma_Nm },
    };
    static const char *const step_key[]  = { "step_N", "step_Nm" };
    static const char *const sigma_key[] = { "sigma_N", "sigma_Nm" };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        if (!(ranges[i].limit > 0.0 && isfinite(ranges[i].limit))) {
            return refuse(error, group, "", ranges[i].key, ranges[i].limit, "a number > 0");
        }
        if (!(ranges[i].step >= 0.0 && ranges[i].step < ranges[i].limit)) {
            return refuse(error, group, "", step_key[i], ranges[i].step,
                          ">= 0 and less than the limit");
        }
        if (!(ranges[i].sigma >= 0.0 && ranges[i].sigma < ranges[i].limit)) {
            return refuse(error, group, "", sigma_key[i], ranges[i].sigma,
                          ">= 0 and less than the limit");
        }
    }
    if (!(sensor->path_sigma_m >= 0.0 && isfinite(sensor->path_sigma_m))) {
        return refuse(error, group, "", "path_sigma_m", sensor->path_sigma_m, ">= 0");
    }
    return DIG_OK;
}

// What keeps a machine with cylinders on the ground.
static enum dig_status check_ground(const struct dig_machine *const machine,
                                    struct dig_error *const         error)
{
    if (!(machine->weight_N > 0.0 && isfinite(machine->weight_N))) {
        return refuse(error, "ground", "", "weight_N", machine->weight_N, "a number > 0");
    }
    if (!(machine->tip_front_X_m > machine->tip_rear_X_m && isfinite(machine->tip_front_X_m))) {
        return refuse(error, "ground", "", "tip_front_X_m", machine->tip_front_X_m,
                      "greater than tip_rear_X_m");
    }
    if (!(machine->weight_X_m > machine->tip_rear_X_m &&
          machine->weight_X_m < machine->tip_front_X_m)) {
        return refuse(error, "ground", "", "weight_X_m", machine->weight_X_m,
                      "between tip_rear_X_m and tip_front_X_m");
    }
    if (!isfinite(machine->boom_foot_Z_m)) {
        return refuse(error, "ground", "", "boom_foot_Z_m", machine->boom_foot_Z_m,
                      "a finite number");
    }
    return DIG_OK;
}

static enum dig_status check_tolerance(const struct dig_machine *const machine,
                                       struct dig_error *const         error)
{
    static const double               most      = 0.5; // beyond it the file says nothing
    const struct dig_tolerance *const tolerance = &machine->tolerance;
    const double                      bucket_m  = machine->link[DIG_JOINT_BUCKET].length_m;
    if (!(tolerance->pin_m >= 0.0 && tolerance->pin_m < most * bucket_m)) {
        return refuse(error, "tolerance", "", "pin_m", tolerance->pin_m,
                      ">= 0 and less than half the bucket's length");
    }
    if (!(tolerance->mass_share >= 0.0 && tolerance->mass_share < most)) {
        return refuse(error, "tolerance", "", "mass_share", tolerance->mass_share,
                      ">= 0 and less than 0.5");
    }
    if (!(tolerance->com_share >= 0.0 && tolerance->com_share < most)) {
        return refuse(error, "tolerance", "", "com_share", tolerance->com_share,
                      ">= 0 and less than 0.5");
    }
    return DIG_OK;
}

// Sensors of a machine of either kind, its tolerances and the bucket's width.
static enum dig_status check_rest(const struct dig_machine *const machine,
                                  struct dig_error *const         error)
{
    const struct {
        const char *key;
        double      value;
    } sensors[] = {
        { "pressure_step_Pa", machine->pressure_step_Pa },
        { "angle_step_rad", machine->angle_step_rad },
        { "angle_sigma_rad", machine->angle_sigma_rad },
    };
    for (size_t i = 0; i < sizeof sensors / sizeof sensors[0]; i++) {
        if (!(sensors[i].value >= 0.0 && isfinite(sensors[i].value))) {
            return refuse(error, "sensors", "", sensors[i].key, sensors[i].value, ">= 0");
        }
    }
    if (!(machine->bucket_width_m > 0.0 && isfinite(machine->bucket_width_m))) {
        return dig_error_set(error, DIG_EINVAL, "bucket_width_m: %g, expected a number > 0",
                             machine->bucket_width_m);
    }
    return check_tolerance(machine, error);
}

enum dig_status dig_machine_check(const struct dig_machine *const machine,
                                  struct dig_error *const         error)
{
    assert(machine != NULL);

    if (!dig_label_ok(machine->name)) {
        return dig_error_set(error, DIG_EINVAL, "name: \"%s\", expected " DIG_LABEL_RULE,
                             machine->name);
    }
    enum dig_status status = DIG_OK;
    if (machine->sensor.fitted) {
        status = check_link(&machine->link[DIG_JOINT_BUCKET], "bucket", error);
        status = status == DIG_OK ? check_sensor(machine, error) : status;
        return status == DIG_OK ? check_rest(machine, error) : status;
    }
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = check_link(&machine->link[j], dig_joint_name((enum dig_joint)j), error);
    }
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = check_cylinder(&machine->cylinder[j], (enum dig_joint)j, error);
    }
    if (status == DIG_OK) {
        status = check_four_bar(&machine->four_bar, error);
    }
    status = status == DIG_OK ? check_rest(machine, error) : status;
    return status == DIG_OK ? check_ground(machine, error) : status;
}
