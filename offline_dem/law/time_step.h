// The longest stable time step of the contact laws.

#ifndef DIG_OFFLINE_DEM_LAW_TIME_STEP_H
#define DIG_OFFLINE_DEM_LAW_TIME_STEP_H

#include "offline_dem/law/law.h"

/// Longest step, s, at which a bed of such grains keeps no energy of its own: the least of 0.14
/// Rayleigh times, a twentieth of a contact of two grains, and the step at which damping flips a
/// grain's spin (formulas and sources: docs/numerics/dem.md). Hertz's contact is taken at the
/// characteristic velocity. In a mixed bed the smallest and lightest grains decide: take the least
/// over all types and laws.
double dig_time_step_limit_s(const struct dig_law_material *material, double radius_m,
                             double density_kgpm3);

#endif // DIG_OFFLINE_DEM_LAW_TIME_STEP_H
