// Springs and dampings of a contact between like materials, and the time step that they bear.
// Formulas and sources: docs/numerics/dem.md.

#ifndef DIG_CORE_CONTACT_H
#define DIG_CORE_CONTACT_H

#include "core/scene.h"

/// With Hertz's law the springs are those at an overlap of 1 m and scale with its square root, the
/// dampings with its fourth root.
struct dig_contact_springs {
    double normal_Npm, damping_Nspm;
    double tangential_Npm, tangential_damping_Nspm;
};

/// For an effective radius and mass. The material's diameter is not read. Hooke: a spring that
/// stores at the characteristic velocity as much as Hertz's, tangential as normal. Hertz: Mindlin's
/// tangential spring, damped to the same restitution at any speed.
struct dig_contact_springs dig_contact_springs(const struct dig_material *material,
                                               enum dig_normal_law normal, double radius_m,
                                               double mass_kg);

/// Longest step, s, at which a bed of spheres of the material's diameter keeps no energy of its
/// own: the least of 0.14 Rayleigh times, a twentieth of a contact of two grains, and the step at
/// which damping flips a grain's spin. Hertz's contact is taken at the characteristic velocity. In
/// a mixed bed the smallest and lightest grains decide: take the least over all.
double dig_contact_step_s(const struct dig_material *material, enum dig_normal_law normal,
                          double density_kgpm3);

/// Exponent p of the stiffness of contacts under the gravel's weight, proportional to density^p: 1
/// where Young's modulus is proportional to density; else 1/5 for Hooke's spring, which a heavy
/// grain's impact stiffens, and 1/3 for Hertz's.
double dig_contact_stiffness_power(const struct dig_material *material, enum dig_normal_law normal);

#endif // DIG_CORE_CONTACT_H
