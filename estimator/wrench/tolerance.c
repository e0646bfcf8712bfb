#include "estimator/wrench/tolerance.h"

#include "core/linkage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Adds one independent error, of these moments about the pins.
static void add_moments(const struct dig_balance *const balance,
                        const double moment_Nm[const DIG_JOINTS], double variance[const DIG_PARTS])
{
    for (int p = 0; p < DIG_PARTS; p++) {
        double by = 0.0;
        for (int j = 0; j < DIG_JOINTS; j++) {
            by += balance->by_moment[p][j] * moment_Nm[j];
        }
        variance[p] += by * by;
    }
}

// Adds the error by one length or coordinate of `near`: it changes the lever of a drive.
static void add_length(struct dig_machine *const near, double *const length_m, const int joint,
                       const struct dig_readings *const readings,
                       const struct dig_balance *const balance, double variance[const DIG_PARTS])
{
    const double     kept_m = *length_m;
    struct dig_lever lever;
    *length_m += near->tolerance.pin_m;
    if (dig_lever_solve(near, (enum dig_joint)joint, readings->joint_rad[joint], &lever) ==
        DIG_OK) {
        double moment_Nm[DIG_JOINTS] = { 0.0 };
        moment_Nm[joint] =
            readings->push[joint].push_N * (lever.arm_m - balance->lever[joint].arm_m);
        add_moments(balance, moment_Nm, variance);
    }
    *length_m = kept_m;
}

static void add_pins(const struct dig_machine *const  machine,
                     const struct dig_readings *const readings,
                     const struct dig_balance *const balance, double variance[const DIG_PARTS])
{
    struct dig_machine         near = *machine;
    struct dig_four_bar *const bar  = &near.four_bar;
    const struct {
        double *length_m;
        int     joint;
    } lengths[] = {
        { &near.cylinder[DIG_JOINT_BOOM].base_m.x, DIG_JOINT_BOOM },
        { &near.cylinder[DIG_JOINT_BOOM].base_m.y, DIG_JOINT_BOOM },
        { &near.cylinder[DIG_JOINT_BOOM].eye_m.x, DIG_JOINT_BOOM },
        { &near.cylinder[DIG_JOINT_BOOM].eye_m.y, DIG_JOINT_BOOM },
        { &near.cylinder[DIG_JOINT_ARM].base_m.x, DIG_JOINT_ARM },
        { &near.cylinder[DIG_JOINT_ARM].base_m.y, DIG_JOINT_ARM },
        { &near.cylinder[DIG_JOINT_ARM].eye_m.x, DIG_JOINT_ARM },
        { &near.cylinder[DIG_JOINT_ARM].eye_m.y, DIG_JOINT_ARM },
        { &near.cylinder[DIG_JOINT_BUCKET].base_m.x, DIG_JOINT_BUCKET },
        { &near.cylinder[DIG_JOINT_BUCKET].base_m.y, DIG_JOINT_BUCKET },
        { &bar->rocker_pin_m.x, DIG_JOINT_BUCKET },
        { &bar->rocker_pin_m.y, DIG_JOINT_BUCKET },
        { &bar->rocker_m, DIG_JOINT_BUCKET },
        { &bar->link_m, DIG_JOINT_BUCKET },
        { &bar->ear_m.x, DIG_JOINT_BUCKET },
        { &bar->ear_m.y, DIG_JOINT_BUCKET },
    };
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        const int joint = lengths[i].joint;
        if (balance->lever_ok[joint]) {
            add_length(&near, lengths[i].length_m, joint, readings, balance, variance);
        }
    }
}

// Adds the errors of a link's weight, by its mass and its centre of mass.
static void add_weights(const struct dig_machine *const machine, const double pitch_rad,
                        const struct dig_front *const   front,
                        const struct dig_balance *const balance, double variance[const DIG_PARTS])
{
    const struct dig_vec2 gravity = dig_statics_gravity_mps2(pitch_rad);
    for (int k = 0; k < DIG_JOINTS; k++) {
        const struct dig_link *const link   = &machine->link[k];
        const double                 off_kg = machine->tolerance.mass_share * link->mass_kg;
        const double off_kgm = machine->tolerance.com_share * link->length_m * link->mass_kg;
        double       by_mass[DIG_JOINTS] = { 0.0 };
        double       by_x[DIG_JOINTS]    = { 0.0 };
        double       by_z[DIG_JOINTS]    = { 0.0 };
        for (int j = 0; j <= k; j++) {
            const struct dig_vec2 lever = dig_vec2_sub(front->com_m[k], front->pin_m[j]);
            by_mass[j]                  = off_kg * dig_vec2_cross(lever, gravity);
            by_x[j]                     = off_kgm * gravity.y;
            by_z[j]                     = -off_kgm * gravity.x;
        }
        add_moments(balance, by_mass, variance);
        add_moments(balance, by_x, variance);
        add_moments(balance, by_z, variance);
    }
}

void dig_tolerance_variance(const struct dig_machine *const  machine,
                            const struct dig_readings *const readings,
                            const struct dig_front *const    front,
                            const struct dig_balance *const balance, double variance[DIG_PARTS])
{
    assert(machine != NULL && readings != NULL && front != NULL && balance != NULL);
    assert(variance != NULL);
    for (int p = 0; p < DIG_PARTS; p++) {
        variance[p] = 0.0;
    }
    if (machine->tolerance.pin_m > 0.0) {
        add_pins(machine, readings, balance, variance);
    }
    if (machine->tolerance.mass_share > 0.0 || machine->tolerance.com_share > 0.0) {
        add_weights(machine, readings->pitch_rad, front, balance, variance);
    }
}
