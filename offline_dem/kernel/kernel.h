// The hot loops: contact forces in blocks, and the integration of the grains. Plain C, compiled for
// AVX-512, AVX2 and the baseline processor, and selected at run time. No multiply is fused with an
// add and no sum is reordered, so every variant gives the same bits.
//
// A list of contacts under the plain law may be in single precision (contacts.h): the law is then
// computed in floats from differences of doubles, and its forces are summed in doubles.

#ifndef DIG_OFFLINE_DEM_KERNEL_KERNEL_H
#define DIG_OFFLINE_DEM_KERNEL_KERNEL_H

#include "offline_dem/kernel/contacts.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/law/law.h"
#include "offline_dem/law/wall.h"

#include <stdbool.h>
#include <stdint.h>

enum dig_isa { DIG_ISA_BASE, DIG_ISA_AVX2, DIG_ISA_AVX512 };

/// The best instruction set of this processor.
enum dig_isa dig_kernel_best(void);

/// Operands of a block of contacts, filled by the caller; the law leaves its results in their
/// place.
struct dig_block {
    union {
        _Alignas(64) double in[12][DIG_BLOCK]; // the fields of struct dig_kinematics, in order
        _Alignas(64) double out[9][DIG_BLOCK]; // the fields of struct dig_contact_force, in order
    };
};

/// The law on contacts first … first + count - 1 of a list in double precision, count <= DIG_BLOCK,
/// whose operands stand in block->in. Histories are updated, block->out is filled and block->in is
/// gone.
void dig_kernel_block(enum dig_isa isa, const struct dig_law *law, double dt_s,
                      struct dig_contacts *list, size_t first, size_t count,
                      struct dig_block *block);

/// Adds forces and torques of a slab's contacts in a list of grain pairs to the loads. With
/// period_y_m > 0 pairs are nearest images in y.
void dig_kernel_pairs(enum dig_isa isa, const struct dig_law *law, double dt_s, double period_y_m,
                      struct dig_contacts *list, size_t slab, struct dig_grains *grains);

/// Adds forces and torques of a slab's contacts in a list of grains with walls to the loads, and
/// the walls' reaction to on_walls_N.
void dig_kernel_walls(enum dig_isa isa, const struct dig_law *law, double dt_s,
                      const struct dig_wall wall[], struct dig_contacts *list, size_t slab,
                      struct dig_grains *grains, double on_walls_N[3]);

/// Kicks every grain of a slab over kick_s with its load and gravity, moves it over dt_s and clears
/// its load. The contacts of this slab and of those beside it must be done. reference_m: position
/// of each grain when the contact lists were made, and its margin. True when a grain has left its
/// margin, or has a coordinate that is not a number.
bool dig_kernel_advance(enum dig_isa isa, const double gravity_mps2[3], double kick_s, double dt_s,
                        const double reference_m[][4], size_t slab, struct dig_grains *grains);

#define DIG_NEAR_PADDING 8

/// Grains in the order of their cells. The arrays go on for DIG_NEAR_PADDING entries of any value.
struct dig_near_grains {
    double   *x_m, *y_m, *z_m, *radius_m, *margin_m;
    uint32_t *grain;
};

/// A grain, or its image beyond a periodic side, around which others are searched for.
struct dig_near_query {
    double   x_m[3];
    double   own_m; // radius and margin
    double   margin_m;
    double   half_m; // of the period: farther images in y are not the nearest
    uint32_t grain;
};

/// Grains first … end - 1 of a struct dig_near_grains.
struct dig_near_row {
    size_t first, end;
};

/// Grains in these rows that are listed under the query's (neighbour.h), clumps apart. Returns how
/// many; `other` has room for all of the rows.
size_t dig_kernel_near(enum dig_isa isa, const struct dig_near_query *query,
                       const struct dig_near_grains *in, size_t rows,
                       const struct dig_near_row row[], uint32_t other[]);

#endif // DIG_OFFLINE_DEM_KERNEL_KERNEL_H
