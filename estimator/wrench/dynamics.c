#include "estimator/wrench/dynamics.h"

#include <assert.h>

// v turned by +90 degrees: alpha times this is the tangential acceleration of a point at v.
static struct dig_vec2 across(const struct dig_vec2 v)
{
    return (struct dig_vec2){ -v.y, v.x };
}

// Acceleration of a point at r from one that accelerates with a, on a body turning as given.
static struct dig_vec2 carried(const struct dig_vec2 a, const struct dig_vec2 r,
                               const double omega_radps, const double alpha_radps2)
{
    const struct dig_vec2 tangential = dig_vec2_add_scaled(a, alpha_radps2, across(r));
    return dig_vec2_add_scaled(tangential, -omega_radps * omega_radps, r);
}

// Moments about the pins for rates of the joints under a gravity.
static void newton_euler(const struct dig_machine *const machine,
                         const struct dig_front *const front, const double velocity[DIG_JOINTS],
                         const double acceleration[DIG_JOINTS], const struct dig_vec2 gravity,
                         double moment_Nm[DIG_JOINTS])
{
    // Outward: the force each link needs at its centre of mass, and its turning.
    struct dig_vec2 force[DIG_JOINTS];
    double          turn_Nm[DIG_JOINTS];
    struct dig_vec2 pin_mps2 = { 0.0, 0.0 };
    double          omega    = 0.0;
    double          alpha    = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        omega += velocity[j];
        alpha += acceleration[j];
        const struct dig_link *const link     = &machine->link[j];
        const struct dig_vec2        to_com   = dig_vec2_sub(front->com_m[j], front->pin_m[j]);
        const struct dig_vec2        com_mps2 = carried(pin_mps2, to_com, omega, alpha);
        const struct dig_vec2        felt     = dig_vec2_sub(com_mps2, gravity);

        force[j]   = (struct dig_vec2){ link->mass_kg * felt.x, link->mass_kg * felt.y };
        turn_Nm[j] = link->inertia_kgm2 * alpha;
        if (j + 1 < DIG_JOINTS) {
            const struct dig_vec2 to_pin = dig_vec2_sub(front->pin_m[j + 1], front->pin_m[j]);
            pin_mps2                     = carried(pin_mps2, to_pin, omega, alpha);
        }
    }

    // Inward.
    struct dig_vec2 beyond_N  = { 0.0, 0.0 };
    double          beyond_Nm = 0.0;
    for (int j = DIG_JOINTS - 1; j >= 0; j--) {
        const struct dig_vec2 to_com    = dig_vec2_sub(front->com_m[j], front->pin_m[j]);
        double                needed_Nm = turn_Nm[j] + dig_vec2_cross(to_com, force[j]) + beyond_Nm;
        if (j + 1 < DIG_JOINTS) {
            const struct dig_vec2 to_pin = dig_vec2_sub(front->pin_m[j + 1], front->pin_m[j]);
            needed_Nm += dig_vec2_cross(to_pin, beyond_N);
        }
        beyond_N     = dig_vec2_add_scaled(force[j], 1.0, beyond_N);
        beyond_Nm    = needed_Nm;
        moment_Nm[j] = -needed_Nm;
    }
}

void dig_dynamics_Nm(const struct dig_machine *const machine, const struct dig_front *const front,
                     const struct dig_rates *const rates, const double pitch_rad,
                     double moment_Nm[DIG_JOINTS])
{
    assert(machine != NULL && front != NULL && rates != NULL && moment_Nm != NULL);
    const struct dig_vec2 gravity = dig_statics_gravity_mps2(pitch_rad);
    newton_euler(machine, front, rates->velocity_radps, rates->acceleration_radps2, gravity,
                 moment_Nm);
}

void dig_dynamics_inertia_kgm2(const struct dig_machine *const machine,
                               const struct dig_front *const   front,
                               double                          by[DIG_JOINTS][DIG_JOINTS])
{
    assert(machine != NULL && front != NULL && by != NULL);
    static const double still[DIG_JOINTS] = { 0.0 };
    for (int k = 0; k < DIG_JOINTS; k++) {
        double one[DIG_JOINTS] = { 0.0 };
        double moment_Nm[DIG_JOINTS];
        one[k] = 1.0;
        newton_euler(machine, front, still, one, (struct dig_vec2){ 0.0, 0.0 }, moment_Nm);
        for (int j = 0; j < DIG_JOINTS; j++) {
            by[j][k] = -moment_Nm[j];
        }
    }
}
