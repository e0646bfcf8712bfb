// The grains of one simulation: state, loads and types. Indices are places in memory. They change
// when the neighbour list is rebuilt, so that neighbours in space are neighbours in memory; `id` is
// constant.

#ifndef DIG_OFFLINE_DEM_KERNEL_GRAINS_H
#define DIG_OFFLINE_DEM_KERNEL_GRAINS_H

#include "core/status.h"
#include "offline_dem/law/law.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_crew;

#define DIG_GRAIN_TYPES_MAX 16 // different radii, densities and materials in one bed

/// A grain's motion. Rows of four, the fourth unused: one load fetches a vector.
struct dig_motion {
    double x_m[4];
    double v_mps[4];
    double w_radps[4];
};

/// Relative state of two grains that touch; x and z are not periodic, and y is not folded.
DIG_BOTH static inline struct dig_kinematics dig_motion_between(const struct dig_motion *const i,
                                                                const struct dig_motion *const j)
{
    const struct dig_kinematics between = {
        i->x_m[0] - j->x_m[0],
        i->x_m[1] - j->x_m[1],
        i->x_m[2] - j->x_m[2],
        i->v_mps[0] - j->v_mps[0],
        i->v_mps[1] - j->v_mps[1],
        i->v_mps[2] - j->v_mps[2],
        i->w_radps[0],
        i->w_radps[1],
        i->w_radps[2],
        j->w_radps[0],
        j->w_radps[1],
        j->w_radps[2],
    };
    return between;
}

/// Force and torque on a grain during one step.
struct dig_load {
    double f_N[4];
    double t_Nm[4];
};

/// The same in single precision, but for the position: a cache line. Velocities, and force and
/// torque, are a vector of eight.
struct dig_single_motion {
    double x_m[4];
    float  v_mps[4];
    float  w_radps[4];
};

struct dig_single_load {
    float f_N[4];
    float t_Nm[4];
};

/// Constants of a grain type. A driven grain is part of a body: loads and gravity do not change its
/// velocity, which the body sets.
struct dig_grain_type {
    double radius_m, mass_kg, inertia_kgm2;
    bool   driven;
};

/// Consecutive grains whose contacts are computed together, and may be by a thread of their own.
/// The contacts that grains of a slab list reach at most `halo` grains into the slabs beside it.
struct dig_slabs {
    size_t count;  // >= 1; more than one in single precision only
    size_t grains; // of each but the last, >= 2 halo
    size_t halo;   // 0 for one slab
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

    // Between dig_grains_begin_single() and _end_single() in place of motion and load.
    bool                      in_single;
    struct dig_single_motion *single_motion; // [n]
    struct dig_single_load   *single_load;   // of the slabs, see dig_grains_slab_load()
    size_t                    single_load_room;
    struct dig_slabs          slabs;
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

/// Moves grain order[k] to index k; the crew shares the work. DIG_ENOMEM leaves all as it was.
DIG_MUST_CHECK enum dig_status dig_grains_reorder(struct dig_grains *grains, const uint32_t order[],
                                                  struct dig_crew *crew);

void dig_grains_finish(struct dig_grains *grains);

/// Kinetic energy of the grains, J: translation and rotation.
double dig_grains_kinetic_J(const struct dig_grains *grains);

/// Motions and loads are from now on in single precision. All loads must be zero. Without effect
/// where they are already. DIG_ENOMEM leaves all as it was.
DIG_MUST_CHECK enum dig_status dig_grains_begin_single(struct dig_grains *grains);

/// Copies the motions back, for those who read them.
void dig_grains_read_single(struct dig_grains *grains);

/// The same, and motion and load count again, for those who write them.
void dig_grains_end_single(struct dig_grains *grains);

/// Splits the grains into slabs, or none, where contacts reach so many grains. Not while motions
/// are in single precision.
void dig_grains_set_slabs(struct dig_grains *grains, size_t reach);

static inline size_t dig_grains_slab_first(const struct dig_grains *const grains, const size_t slab)
{
    return slab < grains->slabs.count ? slab * grains->slabs.grains : grains->n;
}

/// Loads from the contacts of a slab, to be indexed by grain: its own, and `halo` on either side.
/// Every slab has its own halos, so that slabs do not write where others do.
static inline struct dig_single_load *dig_grains_slab_load(const struct dig_grains *const grains,
                                                           const size_t                   slab)
{
    return grains->single_load + grains->slabs.halo * (2 * slab + 1);
}

/// Position of a grain in either precision.
static inline const double *dig_grains_position(const struct dig_grains *const grains,
                                                const size_t                   i)
{
    return grains->in_single ? grains->single_motion[i].x_m : grains->motion[i].x_m;
}

/// Motion of a grain in either precision.
static inline struct dig_motion dig_grains_motion(const struct dig_grains *const grains,
                                                  const size_t                   i)
{
    if (!grains->in_single) {
        return grains->motion[i];
    }
    const struct dig_single_motion *const m = &grains->single_motion[i];
    return (struct dig_motion){
        .x_m     = { m->x_m[0], m->x_m[1], m->x_m[2] },
        .v_mps   = { m->v_mps[0], m->v_mps[1], m->v_mps[2] },
        .w_radps = { m->w_radps[0], m->w_radps[1], m->w_radps[2] },
    };
}

/// Adds to the load of a grain in either precision.
static inline void dig_grains_add_load(struct dig_grains *const grains, const size_t i,
                                       const double f_N[3], const double t_Nm[3])
{
    if (!grains->in_single) {
        for (int k = 0; k < 3; k++) {
            grains->load[i].f_N[k] += f_N[k];
            grains->load[i].t_Nm[k] += t_Nm[k];
        }
        return;
    }
    struct dig_single_load *const load = dig_grains_slab_load(grains, i / grains->slabs.grains) + i;
    for (int k = 0; k < 3; k++) {
        load->f_N[k] += (float)f_N[k];
        load->t_Nm[k] += (float)t_Nm[k];
    }
}

/// False where a grain moves its own radius within a step, or has a coordinate that is not finite:
/// the time step is too long, and further steps diverge.
bool dig_grains_are_sound(const struct dig_grains *grains, double dt_s, struct dig_crew *crew);

#endif // DIG_OFFLINE_DEM_KERNEL_GRAINS_H
