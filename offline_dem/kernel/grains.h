// The grains of one simulation: state, loads and types. Indices are places in memory. They change
// when the neighbour list is rebuilt, so that neighbours in space are neighbours in memory; `id` is
// constant.

#ifndef DIG_OFFLINE_DEM_KERNEL_GRAINS_H
#define DIG_OFFLINE_DEM_KERNEL_GRAINS_H

#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_GRAIN_TYPES_MAX 16 // different radii, densities and materials in one bed

/// A grain's motion. Rows of four, the fourth unused: one load fetches a vector.
struct dig_motion {
    double x_m[4];
    double v_mps[4];
    double w_radps[4];
};

/// Force and torque on a grain during one step.
struct dig_load {
    double f_N[4];
    double t_Nm[4];
};

/// Constants of a grain type. A driven grain is part of a body: loads and gravity do not change its
/// velocity, which the body sets.
struct dig_grain_type {
    double radius_m, mass_kg, inertia_kgm2;
    bool   driven;
};

struct dig_grains {
    size_t                n;
    size_t                types;
    struct dig_grain_type type[DIG_GRAIN_TYPES_MAX];
    struct dig_motion    *motion;  // [n]
    struct dig_load      *load;    // [n]
    uint8_t              *type_of; // [n] type of each grain
    uint32_t             *id;      // [n]
    uint32_t             *clump;   // [n] clump of each grain, from 1; 0: none. NULL: no clumps
};

/// n grains at rest at (x, y, z), grain i of type[type_of[i]]. DIG_EINVAL for a type out of range,
/// a radius or mass that is not positive, or a position that is not finite; DIG_ENOMEM. Written on
/// success only.
DIG_MUST_CHECK enum dig_status dig_grains_create(size_t types, const struct dig_grain_type type[],
                                                 size_t n, const double x_m[], const double y_m[],
                                                 const double z_m[], const uint8_t type_of[],
                                                 struct dig_grains *grains);

/// Removes every grain for which drop is not 0; the others keep their order.
void dig_grains_drop(struct dig_grains *grains, const unsigned char drop[]);

/// Moves grain order[k] to index k. DIG_ENOMEM leaves all as it was.
DIG_MUST_CHECK enum dig_status dig_grains_reorder(struct dig_grains *grains,
                                                  const uint32_t     order[]);

void dig_grains_finish(struct dig_grains *grains);

/// Kinetic energy of the grains, J: translation and rotation.
double dig_grains_kinetic_J(const struct dig_grains *grains);

/// False where a grain moves its own radius within a step, or has a coordinate that is not finite:
/// the time step is too long, and further steps diverge.
bool dig_grains_are_sound(const struct dig_grains *grains, double dt_s);

#endif // DIG_OFFLINE_DEM_KERNEL_GRAINS_H
