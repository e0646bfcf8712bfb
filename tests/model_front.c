#include "tests/model_front.h"

#include "core/units.h"

#include <math.h>

static const double gravity_mps2 = 9.81;

struct dig_machine model_machine(void)
{
    return (struct dig_machine){
        .name = "model",
        .link = {
            [DIG_JOINT_BOOM]   = { 5.65, 1900, { 2.6, 0.35 }, 5100, -0.77, 1.22 },
            [DIG_JOINT_ARM]    = { 2.89, 1000, { 0.85, 0.2 }, 1080, -2.65, -0.52 },
            [DIG_JOINT_BUCKET] = { 0.9, 330, { 0.4, 0.17 }, 28, -2.18, 0.57 },
        },
        .cylinder = {
            [DIG_JOINT_BOOM] = { .count = 2, .bore_m = 0.12, .rod_m = 0.085, .relief_Pa = 3.43e7,
                                 .back_Pa = 1e6, .min_length_m = 1.96, .max_length_m = 3.23,
                                 .base_m = { 0.42, -0.62 }, .eye_m = { 2.55, 0.6 } },
            [DIG_JOINT_ARM] = { .count = 1, .bore_m = 0.135, .rod_m = 0.095, .relief_Pa = 3.43e7,
                                .back_Pa = 1e6, .min_length_m = 2.8, .max_length_m = 4.34,
                                .base_m = { 2.4, 1.15 }, .eye_m = { -0.8, 0.46 } },
            [DIG_JOINT_BUCKET] = { .count = 1, .bore_m = 0.115, .rod_m = 0.08, .relief_Pa = 3.43e7,
                                   .back_Pa = 1e6, .min_length_m = 1.77, .max_length_m = 2.99,
                                   .base_m = { 0.27, 0.78 } },
        },
        .four_bar       = { .rocker_pin_m = { 2.56, -0.01 }, .rocker_m = 0.67, .link_m = 0.52,
                            .ear_m = { -0.08, 0.58 } },
        .bucket_width_m = 0.7,
        .weight_N       = 159900,
        .weight_X_m     = -0.85,
        .tip_front_X_m  = 1.585,
        .tip_rear_X_m   = -1.785,
        .boom_foot_Z_m  = 1.9,
    };
}

static double rotated_x(const struct dig_vec2 v, const double a)
{
    return v.x * cos(a) - v.y * sin(a);
}

static double rotated_y(const struct dig_vec2 v, const double a)
{
    return v.x * sin(a) + v.y * cos(a);
}

// By how much the link would have to be longer if the rocker stood at this angle.
static double link_misses_m(const struct dig_four_bar *const bar, const double rocker_rad,
                            const double kx, const double ky)
{
    const double mx = bar->rocker_pin_m.x + bar->rocker_m * cos(rocker_rad);
    const double my = bar->rocker_pin_m.y + bar->rocker_m * sin(rocker_rad);
    return hypot(kx - mx, ky - my) - bar->link_m;
}

static double bucket_cylinder_m(const struct dig_machine *const machine, const double angle_rad)
{
    const struct dig_four_bar *const bar = &machine->four_bar;

    const double kx = machine->link[DIG_JOINT_ARM].length_m + rotated_x(bar->ear_m, angle_rad);
    const double ky = rotated_y(bar->ear_m, angle_rad);

    // From the direction of K round to the opposite one the distance from M to K only grows.
    double low  = atan2(ky - bar->rocker_pin_m.y, kx - bar->rocker_pin_m.x);
    double high = low + DIG_PI;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (link_misses_m(bar, middle, kx, ky) > 0.0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    const struct dig_vec2 base = machine->cylinder[DIG_JOINT_BUCKET].base_m;
    return hypot(bar->rocker_pin_m.x + bar->rocker_m * cos(low) - base.x,
                 bar->rocker_pin_m.y + bar->rocker_m * sin(low) - base.y);
}

double model_cylinder_m(const struct dig_machine *const machine, const enum dig_joint joint,
                        const double angle_rad)
{
    if (joint == DIG_JOINT_BUCKET) {
        return bucket_cylinder_m(machine, angle_rad);
    }
    const struct dig_cylinder *const c = &machine->cylinder[joint];
    const double hinge_m = joint == DIG_JOINT_ARM ? machine->link[DIG_JOINT_BOOM].length_m : 0.0;
    return hypot(hinge_m + rotated_x(c->eye_m, angle_rad) - c->base_m.x,
                 rotated_y(c->eye_m, angle_rad) - c->base_m.y);
}

double model_slope_m(const struct dig_machine *const machine, const enum dig_joint joint,
                     const double angle_rad)
{
    const double h = 1e-5;
    return (model_cylinder_m(machine, joint, angle_rad + h) -
            model_cylinder_m(machine, joint, angle_rad - h)) /
           (2.0 * h);
}

// Work that load and weight have done on the way to these angles, as if both stayed as they are.
static double work_J(const struct dig_machine *const machine, const double joint_rad[DIG_JOINTS],
                     const double pitch_rad, const struct model_load *const load)
{
    double x_m = 0.0, z_m = 0.0, attitude_rad = 0.0, sum_J = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        attitude_rad += joint_rad[j];
        if (j == DIG_JOINT_BUCKET) {
            sum_J += load->FX_N * x_m + load->FZ_N * z_m + load->M_Nm * attitude_rad;
        }
        const struct dig_link *const link     = &machine->link[j];
        const double                 com_x_m  = x_m + rotated_x(link->com_m, attitude_rad);
        const double                 com_z_m  = z_m + rotated_y(link->com_m, attitude_rad);
        const double                 height_m = com_x_m * sin(pitch_rad) + com_z_m * cos(pitch_rad);
        sum_J -= link->mass_kg * gravity_mps2 * height_m;
        x_m += link->length_m * cos(attitude_rad);
        z_m += link->length_m * sin(attitude_rad);
    }
    return sum_J;
}

void model_pushes_N(const struct dig_machine *const machine, const double joint_rad[DIG_JOINTS],
                    const double pitch_rad, const struct model_load *const load,
                    double push_N[DIG_JOINTS])
{
    const double h = 1e-4;
    for (int j = 0; j < DIG_JOINTS; j++) {
        double more[DIG_JOINTS], less[DIG_JOINTS];
        for (int k = 0; k < DIG_JOINTS; k++) {
            more[k] = joint_rad[k] + (k == j ? h : 0.0);
            less[k] = joint_rad[k] - (k == j ? h : 0.0);
        }
        const double turn_Nm =
            (work_J(machine, more, pitch_rad, load) - work_J(machine, less, pitch_rad, load)) /
            (2.0 * h);
        push_N[j] = -turn_Nm / model_slope_m(machine, (enum dig_joint)j, joint_rad[j]);
    }
}

struct dig_sample model_sample(const struct dig_machine *const machine,
                               const double joint_rad[DIG_JOINTS], const double pitch_rad,
                               const struct model_load *const load, const double back_Pa,
                               const int64_t time_ns)
{
    struct dig_sample sample = { .time_ns = time_ns };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = s != DIG_SIGNAL_TEMPERATURE_degC;
    }
    sample.value[DIG_SIGNAL_PITCH_rad] = pitch_rad;

    // Each drive has a return pressure of its own, so that a test that varies back_Pa varies where
    // between its steps each chamber reads, independently.
    const double share[DIG_JOINTS] = { 1.0, 0.618, 1.414 };
    double       push_N[DIG_JOINTS];
    model_pushes_N(machine, joint_rad, pitch_rad, load, push_N);
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double                     return_Pa = share[j] * back_Pa;
        const struct dig_cylinder *const c         = &machine->cylinder[j];
        const double                     head_m2   = DIG_PI * pow(0.5 * c->bore_m, 2.0);
        const double                     rod_m2    = head_m2 - DIG_PI * pow(0.5 * c->rod_m, 2.0);
        const double                     one_N     = push_N[j] / c->count;
        const double                     head_Pa   = (one_N + return_Pa * rod_m2) / head_m2;
        const double                     rod_Pa    = (return_Pa * head_m2 - one_N) / rod_m2;

        sample.value[DIG_SIGNAL_BOOM_rad + j]             = joint_rad[j];
        sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j]     = fmax(head_Pa, return_Pa);
        sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + 1] = fmax(rod_Pa, return_Pa);
    }
    return sample;
}

void model_joints(const struct dig_machine *const machine, const double X_m, const double Z_m,
                  const double phi_rad, double joint_rad[DIG_JOINTS])
{
    const double boom_m  = machine->link[DIG_JOINT_BOOM].length_m;
    const double arm_m   = machine->link[DIG_JOINT_ARM].length_m;
    const double reach2  = X_m * X_m + Z_m * Z_m;
    const double cos_arm = (reach2 - boom_m * boom_m - arm_m * arm_m) / (2.0 * boom_m * arm_m);

    // The arm folds down: its angle against the boom is negative.
    const double arm_rad = -acos(cos_arm);
    const double boom_rad =
        atan2(Z_m, X_m) - atan2(arm_m * sin(arm_rad), boom_m + arm_m * cos(arm_rad));
    joint_rad[DIG_JOINT_BOOM]   = boom_rad;
    joint_rad[DIG_JOINT_ARM]    = arm_rad;
    joint_rad[DIG_JOINT_BUCKET] = phi_rad - boom_rad - arm_rad;
}

double model_uniform(uint64_t *const seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return ((double)(*seed >> 11) + 0.5) / 9007199254740992.0;
}

double model_normal(uint64_t *const seed)
{
    const double u = model_uniform(seed);
    return sqrt(-2.0 * log(u)) * cos(2.0 * DIG_PI * model_uniform(seed));
}

double model_reading(const double value, const double sigma, const double step,
                     uint64_t *const seed)
{
    const double noisy = value + sigma * model_normal(seed);
    return step > 0.0 ? step * floor(noisy / step + 0.5) : noisy;
}

void model_sense(const struct dig_machine *const machine, struct dig_sample *const sample,
                 uint64_t *const seed)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        double *const angle    = &sample->value[DIG_SIGNAL_BOOM_rad + j];
        double *const pressure = &sample->value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j];
        const double  sigma_Pa = machine->cylinder[j].pressure_sigma_Pa;

        *angle = model_reading(*angle, machine->angle_sigma_rad, machine->angle_step_rad, seed);
        for (int side = 0; side < 2; side++) {
            pressure[side] =
                model_reading(pressure[side], sigma_Pa, machine->pressure_step_Pa, seed);
        }
    }
}
