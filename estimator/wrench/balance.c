#include "estimator/wrench/balance.h"

#include "estimator/wrench/dynamics.h"
#include "estimator/wrench/wrench.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Pressure of a chamber by its sensor's reading.
static double truth_Pa(const struct dig_correction *const correction, const int joint,
                       const enum dig_chamber chamber, const double read_Pa)
{
    return correction == NULL ? read_Pa
                              : (read_Pa - correction->offset_Pa[joint][chamber]) /
                                    (1.0 + correction->gain[joint][chamber]);
}

// Both chambers of a drive.
static enum dig_status take_push(const struct dig_machine *const    machine,
                                 const struct dig_correction *const correction,
                                 const struct dig_sample *const sample, const int j,
                                 struct dig_push *const push)
{
    const enum dig_signal head = (enum dig_signal)(DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j);
    const enum dig_signal rod  = (enum dig_signal)(head + 1);
    if (!sample->valid[head] || !sample->valid[rod]) {
        *push = (struct dig_push){ .valid = false };
        return DIG_OK;
    }
    return dig_cylinder_push(&machine->cylinder[j],
                             truth_Pa(correction, j, DIG_CHAMBER_HEAD, sample->value[head]),
                             truth_Pa(correction, j, DIG_CHAMBER_ROD, sample->value[rod]),
                             machine->pressure_step_Pa, push);
}

// Whether cylinders tell the moment. Where the bucket's pressures are read no sensor is what
// senses.
static bool has_bucket_drive(const bool valid[const DIG_SIGNALS])
{
    return valid[DIG_SIGNAL_BOOM_rad] && valid[DIG_SIGNAL_ARM_rad] &&
           valid[DIG_SIGNAL_BUCKET_rad] && valid[DIG_SIGNAL_BUCKET_HEAD_Pa] &&
           valid[DIG_SIGNAL_BUCKET_ROD_Pa];
}

enum dig_status dig_readings_take(const struct dig_machine *const    machine,
                                  const struct dig_correction *const correction,
                                  const struct dig_sample *const     sample,
                                  const struct dig_rates *const      rates,
                                  struct dig_readings *const         readings)
{
    assert(machine != NULL && sample != NULL && readings != NULL);
    assert(correction == NULL || rates != NULL);
    if (!has_bucket_drive(sample->valid)) {
        return DIG_ESTALE;
    }
    struct dig_readings r = {
        .pitch_rad = 0.0,
        .friction  = correction != NULL ? correction->friction : NULL,
        .rates     = rates,
        .inertia   = rates != NULL,
    };
    if (sample->valid[DIG_SIGNAL_PITCH_rad]) {
        r.pitch_rad = sample->value[DIG_SIGNAL_PITCH_rad];
    }
    r.pitch_rad += correction != NULL ? correction->level_rad : 0.0;
    enum dig_status status = isfinite(r.pitch_rad) ? DIG_OK : DIG_EINVAL;
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        r.joint_rad[j] = sample->value[DIG_SIGNAL_BOOM_rad + j] -
                         (correction != NULL ? correction->angle_rad[j] : 0.0);
        status = isfinite(r.joint_rad[j]) ? take_push(machine, correction, sample, j, &r.push[j])
                                          : DIG_EINVAL;
    }
    if (status == DIG_OK) {
        *readings = r;
    }
    return status;
}

double dig_friction_loss_N(const struct dig_friction *const friction, const double push_N,
                           const double rod_mps)
{
    if (!(fabs(friction->coulomb_N) + fabs(friction->stribeck_N) + fabs(friction->load_share) >
          0.0)) {
        return friction->viscous_Nspm * rod_mps;
    }
    const double crawl_N = friction->stribeck_mps > 0.0
                               ? friction->stribeck_N * exp(-fabs(rod_mps) / friction->stribeck_mps)
                               : 0.0;
    const double dry_N   = friction->coulomb_N + crawl_N + friction->load_share * fabs(push_N);
    return dry_N * tanh(rod_mps / DIG_FRICTION_STILL_mps) + friction->viscous_Nspm * rod_mps;
}

// Moment of drive j about its joint.
static double drive_Nm(const struct dig_readings *const readings,
                       const struct dig_lever *const lever, const int j)
{
    double push_N = readings->push[j].push_N;
    if (readings->friction != NULL && readings->rates != NULL) {
        const double rod_mps = lever->arm_m * readings->rates->velocity_radps[j];
        push_N -= dig_friction_loss_N(&readings->friction[j], push_N, rod_mps);
    }
    return lever->arm_m * push_N;
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

static void add_force(struct dig_balance *const b, const struct dig_vec2 r_arm,
                      const struct dig_vec2 r_boom)
{
    const double          about_arm  = -b->rest_Nm[DIG_JOINT_ARM] - b->part[DIG_PART_MY];
    const double          about_boom = -b->rest_Nm[DIG_JOINT_BOOM] - b->part[DIG_PART_MY];
    const struct dig_vec2 force      = solve_force(r_arm, r_boom, about_arm, about_boom);

    // The rig's x is the machine's -X.
    b->part[DIG_PART_FX] = -force.x;
    b->part[DIG_PART_FZ] = force.y;

    const struct dig_vec2 by[DIG_JOINTS] = {
        [DIG_JOINT_BOOM]   = solve_force(r_arm, r_boom, 0.0, -1.0),
        [DIG_JOINT_ARM]    = solve_force(r_arm, r_boom, -1.0, 0.0),
        [DIG_JOINT_BUCKET] = solve_force(r_arm, r_boom, 1.0, 1.0),
    };
    for (int j = 0; j < DIG_JOINTS; j++) {
        b->by_moment[DIG_PART_FX][j] = -by[j].x;
        b->by_moment[DIG_PART_FZ][j] = by[j].y;
    }
}

bool dig_balance_gives_force(const struct dig_front *const front)
{
    assert(front != NULL);
    const struct dig_vec2 pin    = front->pin_m[DIG_JOINT_BUCKET];
    const struct dig_vec2 r_arm  = dig_vec2_sub(pin, front->pin_m[DIG_JOINT_ARM]);
    const struct dig_vec2 r_boom = dig_vec2_sub(pin, front->pin_m[DIG_JOINT_BOOM]);
    const double          sine =
        fabs(dig_vec2_cross(r_arm, r_boom)) / (dig_vec2_norm(r_arm) * dig_vec2_norm(r_boom));
    return sine >= DIG_WRENCH_MIN_SINE;
}

struct dig_balance dig_balance_solve(const struct dig_machine *const  machine,
                                     const struct dig_readings *const readings,
                                     const struct dig_front *const    front)
{
    assert(machine != NULL && readings != NULL && front != NULL);
    assert(!readings->inertia || readings->rates != NULL);
    struct dig_balance b = { .moment_ok = true, .force_ok = true };

    double mass_Nm[DIG_JOINTS];
    if (!readings->inertia) {
        dig_statics_weight_Nm(machine, front, readings->pitch_rad, mass_Nm);
    } else {
        dig_dynamics_Nm(machine, front, readings->rates, readings->pitch_rad, mass_Nm);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        b.lever_ok[j] = dig_lever_solve(machine, (enum dig_joint)j, readings->joint_rad[j],
                                        &b.lever[j]) == DIG_OK;
        b.force_ok    = b.force_ok && b.lever_ok[j];
        b.rest_Nm[j]  = (b.lever_ok[j] ? drive_Nm(readings, &b.lever[j], j) : 0.0) + mass_Nm[j];
    }
    b.moment_ok = b.lever_ok[DIG_JOINT_BUCKET];
    if (b.moment_ok) {
        b.part[DIG_PART_MY] = -b.rest_Nm[DIG_JOINT_BUCKET];

        b.by_moment[DIG_PART_MY][DIG_JOINT_BUCKET] = -1.0;
    }

    b.force_ok = b.force_ok && dig_balance_gives_force(front);
    if (b.force_ok) {
        const struct dig_vec2 pin = front->pin_m[DIG_JOINT_BUCKET];
        add_force(&b, dig_vec2_sub(pin, front->pin_m[DIG_JOINT_ARM]),
                  dig_vec2_sub(pin, front->pin_m[DIG_JOINT_BOOM]));
    }
    return b;
}

void dig_balance_add_inertia_variance(const struct dig_machine *const machine,
                                      const struct dig_front *const   front,
                                      const struct dig_balance *const balance,
                                      const double sigma_radps2, double variance[DIG_PARTS])
{
    assert(machine != NULL && front != NULL && balance != NULL && variance != NULL);
    double inertia_kgm2[DIG_JOINTS][DIG_JOINTS];
    dig_dynamics_inertia_kgm2(machine, front, inertia_kgm2);
    for (int k = 0; k < DIG_JOINTS; k++) {
        for (int p = 0; p < DIG_PARTS; p++) {
            double by_turn = 0.0;
            for (int j = 0; j < DIG_JOINTS; j++) {
                by_turn -= balance->by_moment[p][j] * inertia_kgm2[j][k];
            }
            variance[p] += pow(by_turn * sigma_radps2, 2.0);
        }
    }
}
