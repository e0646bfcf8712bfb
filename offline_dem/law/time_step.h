// The longest time step the contact laws allow.

#ifndef DIG_OFFLINE_DEM_LAW_TIME_STEP_H
#define DIG_OFFLINE_DEM_LAW_TIME_STEP_H

#include "offline_dem/law/law.h"

/// Longest step, s, with which a bed of such grains stays as quiet as it is: the least of 0.14
/// Rayleigh times, a twentieth of a contact of two of them, and the step at which damping would
/// flip a grain's spin (formulas and sources: docs/numerics/dem.md). Hertz's contact is taken at
/// the characteristic velocity. In a mixed bed the smallest and lightest grains decide: ask for
/// every kind and law, take the least.
double dig_time_step_limit_s(const struct dig_law_material *material, double radius_m,
                             double density_kgpm3);

#endif // DIG_OFFLINE_DEM_LAW_TIME_STEP_H
