// The hot loops: contact forces in blocks, and the integration of the grains. Plain C, compiled for
// AVX-512, AVX2 and the baseline processor, and selected at run time. No multiply is fused with an
// add and no sum is reordered, so every variant gives the same bits.

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
    // Between the stages of the plain law: distances, and whether a cap may apply.
    _Alignas(64) double d_m[DIG_BLOCK];
    _Alignas(64) int64_t may_cap[DIG_BLOCK];
};

/// The law on contacts first … first + count - 1 of a list, count <= DIG_BLOCK, whose operands
/// stand in block->in. Histories are updated, block->out is filled and block->in is gone.
void dig_kernel_block(enum dig_isa isa, const struct dig_law *law, double dt_s,
                      struct dig_contacts *list, size_t first, size_t count,
                      struct dig_block *block);

/// Adds forces and torques of a list of grain pairs to the loads. With period_y_m > 0 pairs are
/// nearest images in y.
void dig_kernel_pairs(enum dig_isa isa, const struct dig_law *law, double dt_s, double period_y_m,
                      struct dig_contacts *list, struct dig_grains *grains);

/// Adds forces and torques of a list of grains with walls to the loads, and the walls' reaction to
/// on_walls_N.
void dig_kernel_walls(enum dig_isa isa, const struct dig_law *law, double dt_s,
                      const struct dig_wall wall[], struct dig_contacts *list,
                      struct dig_grains *grains, double on_walls_N[3]);

/// Kicks every grain over kick_s with its load and gravity, moves it over dt_s and clears its load.
/// reference_m: position of each grain when the contact lists were made, and its margin. True when
/// a grain has left its margin, or has a coordinate that is not a number.
bool dig_kernel_advance(enum dig_isa isa, const double gravity_mps2[3], double kick_s, double dt_s,
                        const double reference_m[][4], struct dig_grains *grains);

#endif // DIG_OFFLINE_DEM_KERNEL_KERNEL_H
