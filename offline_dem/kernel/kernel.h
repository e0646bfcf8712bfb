// The hot loops: contact forces in blocks, and the step of the grains. Written in plain C; compiled
// for AVX-512, AVX2 and the baseline processor, and picked at run time. No multiply is fused with
// an add and no sum is reordered, so every variant gives the same bits.

#ifndef DIG_OFFLINE_DEM_KERNEL_KERNEL_H
#define DIG_OFFLINE_DEM_KERNEL_KERNEL_H

#include "offline_dem/kernel/contacts.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/law/law.h"
#include "offline_dem/law/wall.h"

#include <stdbool.h>
#include <stdint.h>

enum dig_isa { DIG_ISA_BASE, DIG_ISA_AVX2, DIG_ISA_AVX512 };

/// The best this processor can do.
enum dig_isa dig_kernel_best(void);

/// Operands of a block of contacts, filled by whoever knows the geometry; the law leaves its
/// results in their place.
struct dig_block {
    union {
        _Alignas(64) double in[12][DIG_BLOCK]; // the fields of struct dig_kinematics, in order
        _Alignas(64) double out[9][DIG_BLOCK]; // the fields of struct dig_contact_force, in order
    };
    // Between the stages of the plain law: distances, and whether a cap may hold.
    _Alignas(64) double d_m[DIG_BLOCK];
    _Alignas(64) int64_t may_cap[DIG_BLOCK];
};

/// The law on count <= DIG_BLOCK contacts, whose operands stand in block->in and whose memories
/// stand in memory; memories are updated, block->out is filled and block->in is gone.
void dig_kernel_block(enum dig_isa isa, const struct dig_law *law, double dt_s, size_t count,
                      double history[DIG_HISTORY_VALUES][DIG_BLOCK], struct dig_block *block);

/// Forces and torques of all contacts of a list of grain pairs, added to the loads. With period_y_m
/// > 0 grains meet their nearest images in y.
void dig_kernel_pairs(enum dig_isa isa, const struct dig_law *law, double dt_s, double period_y_m,
                      struct dig_contacts *list, struct dig_grains *grains);

/// Forces and torques of all contacts of a list of grains with walls, added to the loads; the
/// walls' reaction is added to on_walls_N.
void dig_kernel_walls(enum dig_isa isa, const struct dig_law *law, double dt_s,
                      const struct dig_wall wall[], struct dig_contacts *list,
                      struct dig_grains *grains, double on_walls_N[3]);

/// Kicks every grain over kick_s with its load and gravity, moves it over dt_s and clears its load.
/// at_m: where each grain stood when the contact lists were made, and its margin. True when a grain
/// has left its margin, or has a coordinate that is not a number.
bool dig_kernel_advance(enum dig_isa isa, const double gravity_mps2[3], double kick_s, double dt_s,
                        const double reference_m[][4], struct dig_grains *grains);

#endif // DIG_OFFLINE_DEM_KERNEL_KERNEL_H
