#include "estimator/wrench.h"

#include "estimator/cylinder.h"
#include "estimator/linkage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { MY, FX, FZ, PARTS };

// What a sample says, gathered by joint.
struct readings {
    double          joint_rad[DIG_JOINTS];
    double          pitch_rad;
    struct dig_push push[DIG_JOINTS];
};

// One solution of the balance. Partials by the drives' moments T.
struct balance {
    double           part[PARTS]; // My, Fx, Fz
    double           by_moment[PARTS][DIG_JOINTS];
    struct dig_lever lever[DIG_JOINTS];
    bool             moment_ok, force_ok;
};

static double signal(const struct dig_sample *const sample, const enum dig_signal first,
                     const int offset)
{
    return sample->value[(int)first + offset];
}

static enum dig_status read_sample(const struct dig_machine *const machine,
                                   const struct dig_sample *const  sample,
                                   struct readings *const          readings)
{
    if (!dig_sample_is_complete(sample)) {
        return DIG_ESTALE;
    }
    struct readings r = { .pitch_rad = 0.0 };
    if (sample->valid[DIG_SIGNAL_PITCH_rad]) {
        r.pitch_rad = sample->value[DIG_SIGNAL_PITCH_rad];
    }
    enum dig_status status = isfinite(r.pitch_rad) ? DIG_OK : DIG_EINVAL;
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        r.joint_rad[j] = signal(sample, DIG_SIGNAL_BOOM_rad, j);
        status         = !isfinite(r.joint_rad[j])
                             ? DIG_EINVAL
                             : dig_cylinder_push(&machine->cylinder[j],
                                                 signal(sample, DIG_SIGNAL_BOOM_HEAD_Pa, 2 * j),
                                                 signal(sample, DIG_SIGNAL_BOOM_ROD_Pa, 2 * j),
                                                 machine->pressure_step_Pa, &r.push[j]);
    }
    if (status == DIG_OK) {
        *readings = r;
    }
    return status;
}

// The force that has moment about_arm about the arm pin and about_boom about the boom foot.
static struct dig_vec2 solve_force(const struct dig_vec2 r_arm, const struct dig_vec2 r_boom,
                                   const double about_arm, const double about_boom)
{
    const double det = dig_vec2_cross(r_arm, r_boom);
    return (struct dig_vec2){
        .x = (about_arm * r_boom.x - about_boom * r_arm.x) / det,
        .y = (about_arm * r_boom.y - about_boom * r_arm.y) / det,
    };
}

static struct balance solve_balance(const struct dig_machine *const machine,
                                    const struct readings *const    readings,
                                    const struct dig_front *const   front)
{
    struct balance b = { .moment_ok = true, .force_ok = true };

    double drive_Nm[DIG_JOINTS];
    for (int j = 0; j < DIG_JOINTS; j++) {
        const enum dig_status status =
            dig_lever_solve(machine, (enum dig_joint)j, readings->joint_rad[j], &b.lever[j]);
        b.force_ok  = b.force_ok && status == DIG_OK;
        drive_Nm[j] = status == DIG_OK ? b.lever[j].arm_m * readings->push[j].push_N : 0.0;
        if (j == DIG_JOINT_BUCKET) {
            b.moment_ok = status == DIG_OK;
        }
    }

    double weight_Nm[DIG_JOINTS];
    dig_statics_weight_Nm(machine, front, readings->pitch_rad, weight_Nm);
    if (b.moment_ok) {
        b.part[MY] = -drive_Nm[DIG_JOINT_BUCKET] - weight_Nm[DIG_JOINT_BUCKET];
        b.by_moment[MY][DIG_JOINT_BUCKET] = -1.0;
    }

    const struct dig_vec2 pin    = front->pin_m[DIG_JOINT_BUCKET];
    const struct dig_vec2 r_arm  = dig_vec2_sub(pin, front->pin_m[DIG_JOINT_ARM]);
    const struct dig_vec2 r_boom = dig_vec2_sub(pin, front->pin_m[DIG_JOINT_BOOM]);
    const double          sine =
        fabs(dig_vec2_cross(r_arm, r_boom)) / (dig_vec2_norm(r_arm) * dig_vec2_norm(r_boom));
    b.force_ok = b.force_ok && sine >= DIG_WRENCH_MIN_SINE;
    if (!b.force_ok) {
        return b;
    }

    const double about_arm  = -drive_Nm[DIG_JOINT_ARM] - weight_Nm[DIG_JOINT_ARM] - b.part[MY];
    const double about_boom = -drive_Nm[DIG_JOINT_BOOM] - weight_Nm[DIG_JOINT_BOOM] - b.part[MY];
    const struct dig_vec2 force = solve_force(r_arm, r_boom, about_arm, about_boom);

    // The rig's x is the machine's -X.
    b.part[FX] = -force.x;
    b.part[FZ] = force.y;

    const struct dig_vec2 by[DIG_JOINTS] = {
        [DIG_JOINT_BOOM]   = solve_force(r_arm, r_boom, 0.0, -1.0),
        [DIG_JOINT_ARM]    = solve_force(r_arm, r_boom, -1.0, 0.0),
        [DIG_JOINT_BUCKET] = solve_force(r_arm, r_boom, 1.0, 1.0),
    };
    for (int j = 0; j < DIG_JOINTS; j++) {
        b.by_moment[FX][j] = -by[j].x;
        b.by_moment[FZ][j] = by[j].y;
    }
    return b;
}

// Adds what an error of one joint's angle does to every part. A pose that cannot be solved a sigma
// away is too near a singularity to be told.
static void add_angle_variance(const struct dig_machine *const machine,
                               const struct readings *const readings, const int joint,
                               const double sigma_rad, const double slow_rad,
                               struct balance *const balance, double variance[PARTS],
                               double slow_variance[PARTS])
{
    const double    h_rad = fmax(sigma_rad, 1e-6);
    struct readings more  = *readings;
    struct readings less  = *readings;
    more.joint_rad[joint] += h_rad;
    less.joint_rad[joint] -= h_rad;
    const struct dig_front front_more = dig_front_place(machine, more.joint_rad);
    const struct dig_front front_less = dig_front_place(machine, less.joint_rad);
    const struct balance   high       = solve_balance(machine, &more, &front_more);
    const struct balance   low        = solve_balance(machine, &less, &front_less);

    balance->moment_ok = balance->moment_ok && high.moment_ok && low.moment_ok;
    balance->force_ok  = balance->force_ok && high.force_ok && low.force_ok;
    for (int p = 0; p < PARTS; p++) {
        const double by_rad = (high.part[p] - low.part[p]) / (2.0 * h_rad);
        variance[p] += by_rad * by_rad * sigma_rad * sigma_rad;
        slow_variance[p] += by_rad * by_rad * slow_rad * slow_rad;
    }
}

enum dig_status dig_wrench_solve(const struct dig_machine *const machine,
                                 const struct dig_sample *const  sample,
                                 struct dig_wrench *const wrench, struct dig_front *const front)
{
    assert(machine != NULL && sample != NULL && wrench != NULL && front != NULL);
    struct readings       readings;
    const enum dig_status status = read_sample(machine, sample, &readings);
    if (status != DIG_OK) {
        return status;
    }

    const struct dig_front placed  = dig_front_place(machine, readings.joint_rad);
    struct balance         balance = solve_balance(machine, &readings, &placed);

    double variance[PARTS]      = { 0 };
    double slow_variance[PARTS] = { 0 };
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int p = 0; p < PARTS; p++) {
            const double by_push = balance.by_moment[p][j] * balance.lever[j].arm_m;
            variance[p] += pow(by_push * readings.push[j].sigma_N, 2.0);
            slow_variance[p] += pow(by_push * readings.push[j].slow_N, 2.0);
        }
    }
    const double sigma_rad = dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad);
    const double slow_rad  = dig_reading_slow(machine->angle_step_rad, machine->angle_sigma_rad);
    for (int j = 0; j < DIG_JOINTS; j++) {
        add_angle_variance(machine, &readings, j, sigma_rad, slow_rad, &balance, variance,
                           slow_variance);
    }

    // A stop carries load past the pressures; a valve lets oil past them.
    bool clear[DIG_JOINTS];
    for (int j = 0; j < DIG_JOINTS; j++) {
        clear[j] = readings.push[j].valid &&
                   dig_cylinder_is_clear(&machine->cylinder[j], balance.lever[j].length_m);
    }

    struct dig_wrench w = {
        .moment_valid = balance.moment_ok && clear[DIG_JOINT_BUCKET],
        .force_valid  = balance.force_ok && clear[DIG_JOINT_BOOM] && clear[DIG_JOINT_ARM] &&
                       clear[DIG_JOINT_BUCKET],
    };
    if (w.moment_valid) {
        w.My_Nm            = balance.part[MY];
        w.sigma_My_Nm      = sqrt(variance[MY]);
        w.slow_sigma_My_Nm = sqrt(slow_variance[MY]);
    }
    if (w.force_valid) {
        w.Fx_N       = balance.part[FX];
        w.Fz_N       = balance.part[FZ];
        w.sigma_Fx_N = sqrt(variance[FX]);
        w.sigma_Fz_N = sqrt(variance[FZ]);
    }
    *wrench = w;
    *front  = placed;
    return DIG_OK;
}
