#include "estimator/wrench/statics.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

static const double gravity_mps2 = 9.81;

struct dig_front dig_front_place(const struct dig_machine *const machine,
                                 const double                    joint_rad[DIG_JOINTS])
{
    assert(machine != NULL && joint_rad != NULL);
    struct dig_front front;
    struct dig_vec2  pin     = { 0.0, 0.0 };
    double           sum_rad = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_link *const link = &machine->link[j];
        sum_rad += joint_rad[j];
        const struct dig_vec2 along  = { cos(sum_rad), sin(sum_rad) };
        const struct dig_vec2 across = { -along.y, along.x };

        front.attitude_rad[j] = sum_rad;
        front.pin_m[j]        = pin;
        front.com_m[j]        = dig_vec2_add_scaled(dig_vec2_add_scaled(pin, link->com_m.x, along),
                                                    link->com_m.y, across);
        pin                   = dig_vec2_add_scaled(pin, link->length_m, along);
    }
    return front;
}

struct dig_vec2 dig_statics_gravity_mps2(const double pitch_rad)
{
    return (struct dig_vec2){ -gravity_mps2 * sin(pitch_rad), -gravity_mps2 * cos(pitch_rad) };
}

void dig_statics_weight_Nm(const struct dig_machine *const machine,
                           const struct dig_front *const front, const double pitch_rad,
                           double moment_Nm[DIG_JOINTS])
{
    assert(machine != NULL && front != NULL && moment_Nm != NULL);
    const struct dig_vec2 gravity = dig_statics_gravity_mps2(pitch_rad);
    for (int j = 0; j < DIG_JOINTS; j++) {
        double sum_Nm = 0.0;
        for (int k = j; k < DIG_JOINTS; k++) {
            const struct dig_vec2 lever = dig_vec2_sub(front->com_m[k], front->pin_m[j]);
            sum_Nm += machine->link[k].mass_kg * dig_vec2_cross(lever, gravity);
        }
        moment_Nm[j] = sum_Nm;
    }
}
