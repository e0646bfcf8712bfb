#include "estimator/wrench/wrench.h"

#include "estimator/wrench/balance.h"
#include "estimator/wrench/dynamics.h"
#include "estimator/wrench/tolerance.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Variances of the parts: total, and the part that does not average down.
struct variance {
    double all[DIG_PARTS], slow[DIG_PARTS];
};

static void add_push_variance(const struct dig_readings *const readings,
                              const struct dig_balance *const  balance,
                              struct variance *const           variance)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int p = 0; p < DIG_PARTS; p++) {
            const double by_push = balance->by_moment[p][j] * balance->lever[j].arm_m;
            variance->all[p] += pow(by_push * readings->push[j].sigma_N, 2.0);
            variance->slow[p] += pow(by_push * readings->push[j].slow_N, 2.0);
        }
    }
}

// Adds the variance of every part by one joint's angle. False when the pose one sigma away cannot
// be solved: too near a singularity.
static void add_angle_variance(const struct dig_machine *const  machine,
                               const struct dig_readings *const readings, const int joint,
                               struct dig_balance *const balance, struct variance *const variance)
{
    const double sigma_rad = dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad);
    const double slow_rad  = dig_reading_slow(machine->angle_step_rad, machine->angle_sigma_rad);
    const double h_rad     = fmax(sigma_rad, 1e-6);

    struct dig_readings more = *readings;
    struct dig_readings less = *readings;
    more.joint_rad[joint] += h_rad;
    less.joint_rad[joint] -= h_rad;
    const struct dig_front   front_more = dig_front_place(machine, more.joint_rad);
    const struct dig_front   front_less = dig_front_place(machine, less.joint_rad);
    const struct dig_balance high       = dig_balance_solve(machine, &more, &front_more);
    const struct dig_balance low        = dig_balance_solve(machine, &less, &front_less);

    balance->moment_ok = balance->moment_ok && high.moment_ok && low.moment_ok;
    balance->force_ok  = balance->force_ok && high.force_ok && low.force_ok;
    for (int p = 0; p < DIG_PARTS; p++) {
        const double by_rad = (high.part[p] - low.part[p]) / (2.0 * h_rad);
        variance->all[p] += by_rad * by_rad * sigma_rad * sigma_rad;
        variance->slow[p] += by_rad * by_rad * slow_rad * slow_rad;
    }
}

// The same check without variances: an angle changes its own joint's lever and no other,
// and the bucket's moves no pin.
static void check_angle(const struct dig_machine *const  machine,
                        const struct dig_readings *const readings, const int joint,
                        struct dig_balance *const balance)
{
    const double sigma_rad = dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad);
    const double h_rad     = fmax(sigma_rad, 1e-6);
    for (int side = -1; side <= 1; side += 2) {
        struct dig_readings near = *readings;
        struct dig_lever    lever;
        near.joint_rad[joint] += side * h_rad;
        const bool solved = dig_lever_solve(machine, (enum dig_joint)joint, near.joint_rad[joint],
                                            &lever) == DIG_OK;

        balance->force_ok = balance->force_ok && solved;
        if (joint == DIG_JOINT_BUCKET) {
            balance->moment_ok = balance->moment_ok && solved;
        } else if (balance->force_ok) {
            const struct dig_front front = dig_front_place(machine, near.joint_rad);
            balance->force_ok            = dig_balance_gives_force(&front);
        }
    }
}

// Adds the variance by the rates, through inertia and friction.
static void add_rate_variance(const struct dig_machine *const  machine,
                              const struct dig_front *const    front,
                              const struct dig_readings *const readings,
                              const struct dig_balance *const  balance,
                              struct variance *const           variance)
{
    const struct dig_rates *const rates = readings->rates;
    if (readings->inertia) {
        dig_balance_add_inertia_variance(machine, front, balance, rates->acceleration_sigma,
                                         variance->all);
    }
    for (int k = 0; k < DIG_JOINTS; k++) {
        const double arm_m  = balance->lever[k].arm_m;
        const double rod    = arm_m * rates->velocity_radps[k];
        const double by_rod = fabs(arm_m) * rates->velocity_sigma;
        const double push_N = readings->push[k].push_N;
        double       rubs_N = 0.0;
        if (readings->friction != NULL) {
            const struct dig_friction *const friction = &readings->friction[k];
            rubs_N = 0.5 * (dig_friction_loss_N(friction, push_N, rod + by_rod) -
                            dig_friction_loss_N(friction, push_N, rod - by_rod));
        }
        for (int p = 0; p < DIG_PARTS; p++) {
            variance->all[p] += pow(balance->by_moment[p][k] * arm_m * rubs_N, 2.0);
        }
    }
}

// Pin-to-pin length by the file's geometry: the file's lengths at the stops belong to it, and a
// corrected pin does not move the angles of the stops.
static void draw_lengths(const struct dig_machine *const    corrected,
                         const struct dig_correction *const correction,
                         const struct dig_readings *const readings, struct dig_balance *const b)
{
    const struct dig_machine drawn = dig_correction_drawn(corrected, correction);
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_lever lever;
        if (dig_lever_solve(&drawn, (enum dig_joint)j, readings->joint_rad[j], &lever) == DIG_OK) {
            b->lever[j].length_m = lever.length_m;
        }
    }
}

// A stop carries load that the pressures do not show; an open valve lets oil through.
static bool is_trusted(const struct dig_machine *const  machine,
                       const struct dig_readings *const readings,
                       const struct dig_balance *const balance, const int j)
{
    return readings->push[j].valid &&
           dig_cylinder_is_clear(&machine->cylinder[j], balance->lever[j].length_m);
}

// All variances; false when a pose within the errors cannot be solved.
static void add_variances(const struct dig_machine *const  machine,
                          const struct dig_readings *const readings,
                          const struct dig_front *const placed, struct dig_balance *const balance,
                          struct variance *const variance, double geometry[DIG_PARTS])
{
    add_push_variance(readings, balance, variance);
    for (int j = 0; j < DIG_JOINTS; j++) {
        add_angle_variance(machine, readings, j, balance, variance);
    }
    if (readings->rates != NULL) {
        add_rate_variance(machine, placed, readings, balance, variance);
    }
    dig_tolerance_variance(machine, readings, placed, balance, geometry);
}

static enum dig_status solve(const struct dig_machine *const    machine,
                             const struct dig_correction *const correction,
                             const struct dig_sample *const     sample,
                             const struct dig_rates *const rates, const unsigned with,
                             struct dig_wrench *const wrench, struct dig_front *const front)
{
    struct dig_readings   readings;
    const enum dig_status status = dig_readings_take(machine, correction, sample, rates, &readings);
    if (status != DIG_OK) {
        return status;
    }
    const bool with_sigma = (with & DIG_WITH_SIGMA) != 0;
    readings.inertia      = (with & DIG_WITH_INERTIA) != 0;

    const struct dig_front placed  = dig_front_place(machine, readings.joint_rad);
    struct dig_balance     balance = dig_balance_solve(machine, &readings, &placed);

    struct variance variance            = { .all = { 0.0 } };
    double          geometry[DIG_PARTS] = { 0.0 };
    if (with_sigma) {
        add_variances(machine, &readings, &placed, &balance, &variance, geometry);
    }
    for (int j = 0; j < DIG_JOINTS && !with_sigma; j++) {
        check_angle(machine, &readings, j, &balance);
    }
    if (correction != NULL && dig_correction_is_geometric(correction)) {
        draw_lengths(machine, correction, &readings, &balance);
    }
    const bool bucket = is_trusted(machine, &readings, &balance, DIG_JOINT_BUCKET);
    const bool others = is_trusted(machine, &readings, &balance, DIG_JOINT_BOOM) &&
                        is_trusted(machine, &readings, &balance, DIG_JOINT_ARM);
    *wrench =
        dig_wrench_of_parts(balance.part, variance.all, variance.slow, geometry,
                            balance.moment_ok && bucket, balance.force_ok && bucket && others);
    *front = placed;
    return DIG_OK;
}

enum dig_status dig_wrench_solve(const struct dig_machine *const machine,
                                 const struct dig_sample *const  sample,
                                 struct dig_wrench *const wrench, struct dig_front *const front)
{
    assert(machine != NULL && sample != NULL && wrench != NULL && front != NULL);
    return solve(machine, NULL, sample, NULL, DIG_WITH_SIGMA, wrench, front);
}

enum dig_status dig_wrench_correct(const struct dig_machine *const    corrected,
                                   const struct dig_correction *const correction,
                                   const struct dig_sample *const     sample,
                                   const struct dig_rates *const rates, const unsigned with,
                                   struct dig_wrench *const wrench, struct dig_front *const front)
{
    assert(corrected != NULL && correction != NULL && sample != NULL && rates != NULL);
    assert(wrench != NULL && front != NULL);
    return solve(corrected, correction, sample, rates, with, wrench, front);
}
