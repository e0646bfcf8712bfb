// Transposes grains (rows) into contacts (columns), and back, for the law in single precision:
// eight contacts at a time. Motions and loads are doubles. What the law reads of two grains is
// first subtracted, then rounded; what it returns is summed in double precision. Inlined into the
// variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_ROWS_SINGLE_H
#define DIG_OFFLINE_DEM_KERNEL_ROWS_SINGLE_H

#include "offline_dem/kernel/rows.h"

typedef float four_single __attribute__((vector_size(16)));
typedef float eight_single __attribute__((vector_size(32)));

/// Operands of a block of contacts in single precision; the law leaves its results in their place.
struct block_single {
    _Alignas(64) double d_m[3][DIG_BLOCK]; // x_i - x_j
    union {
        _Alignas(64) float in[9][DIG_BLOCK]; // fields of struct dig_contact_motion_single, in order
        _Alignas(64) float out[9][DIG_BLOCK]; // fields of struct dig_contact_force_single, in order
    };
    _Alignas(64) float normal[4][DIG_BLOCK]; // fields of struct dig_contact_normal_single
};

/// The contacts of a block. At the end of a slab they are a copy: the block is filled up with
/// contacts of grains far apart, and in the list other contacts follow.
struct single_contacts {
    size_t          count;
    const uint32_t *i, *j;
    float          *history[DIG_HISTORY_VALUES];
    uint32_t        copy_i[DIG_BLOCK], copy_j[DIG_BLOCK];
    _Alignas(64) float copy[DIG_HISTORY_VALUES][DIG_BLOCK];
};

INLINED void begin_block(const struct dig_contacts *const list, const size_t first,
                         const size_t count, struct single_contacts *const contacts)
{
    contacts->count = count;
    contacts->i     = list->i + first;
    contacts->j     = list->j + first;
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        contacts->history[m] = list->single_history[m] + first;
    }
    if (count == DIG_BLOCK) {
        return;
    }
    for (size_t c = 0; c < DIG_BLOCK; c++) {
        const size_t from   = first + (c < count ? c : 0);
        contacts->copy_i[c] = list->i[from];
        contacts->copy_j[c] = list->j[from];
    }
    contacts->i = contacts->copy_i;
    contacts->j = contacts->copy_j;
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        memcpy(contacts->copy[m], list->single_history[m] + first, count * sizeof(float));
        contacts->history[m] = contacts->copy[m];
    }
}

INLINED void end_block(const struct single_contacts *const contacts, const size_t first,
                       struct dig_contacts *const list)
{
    for (int m = 0; m < DIG_HISTORY_VALUES && contacts->count < DIG_BLOCK; m++) {
        memcpy(list->single_history[m] + first, contacts->copy[m], contacts->count * sizeof(float));
    }
}

INLINED eight_single load_eight(const void *const row)
{
    eight_single v;
    memcpy(&v, row, sizeof v);
    return v;
}

INLINED void store_eight(void *const row, const eight_single *const v)
{
    memcpy(row, v, sizeof *v);
}

// Eight rows become eight columns: pairs, then fours, then halves of the vectors are interleaved.
INLINED void transpose_eight(const eight_single from[8], eight_single to[8])
{
    eight_single pair[8];
    eight_single quad[8];
#pragma GCC unroll 4
    for (size_t k = 0; k < 8; k += 2) {
        const eight_single a = from[k];
        const eight_single b = from[k + 1];
        pair[k]              = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
        pair[k + 1]          = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    }
#pragma GCC unroll 2
    for (size_t h = 0; h < 8; h += 4) {
#pragma GCC unroll 2
        for (size_t k = 0; k < 2; k++) {
            const eight_single a = pair[h + k];
            const eight_single b = pair[h + 2 + k];
            quad[h + 2 * k]      = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
            quad[h + 2 * k + 1]  = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
        }
    }
#pragma GCC unroll 4
    for (size_t k = 0; k < 4; k++) {
        const eight_single a = quad[k];
        const eight_single b = quad[k + 4];
        to[k]                = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
        to[k + 4]            = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

// Two vectors of three in a row: six columns.
INLINED void put_eight(const eight_single row[8], float (*const field)[DIG_BLOCK], const size_t c)
{
    eight_single column[8];
    transpose_eight(row, column);
#pragma GCC unroll 3
    for (size_t k = 0; k < 3; k++) {
        memcpy(&field[k][c], &column[k], sizeof column[k]);
        memcpy(&field[3 + k][c], &column[4 + k], sizeof column[4 + k]);
    }
}

// And back: forces in the columns of `force`, torques in those of `torque`.
INLINED void get_eight(float (*const force)[DIG_BLOCK], float (*const torque)[DIG_BLOCK],
                       const size_t c, const bool reaction, eight_single row[8])
{
    eight_single field[8] = { { 0.0F } };
#pragma GCC unroll 3
    for (size_t k = 0; k < 3; k++) {
        memcpy(&field[k], &force[k][c], sizeof field[k]);
        memcpy(&field[4 + k], &torque[k][c], sizeof field[4 + k]);
        field[k] = reaction ? -field[k] : field[k];
    }
    transpose_eight(field, row);
}

INLINED void add_load(struct dig_single_load *const load, const eight_single *const row)
{
    // Torques follow forces.
    const eight_single sum = load_eight(load) + *row;
    store_eight(load, &sum);
}

INLINED void gather_eight(const uint32_t *const i, const uint32_t *const j,
                          const struct dig_single_motion *const motion, const size_t c,
                          struct block_single *const block)
{
    const eight_single zero = { 0.0F };
    four               d[8];
    eight_single       v_wi[8];
    eight_single       wj[8];
#pragma GCC unroll 8
    for (size_t l = 0; l < 8; l++) {
        const struct dig_single_motion *const a  = &motion[i[l]];
        const struct dig_single_motion *const b  = &motion[j[l]];
        const eight_single                    vb = load_eight(b->v_mps);

        d[l]    = load_four(a->x_m) - load_four(b->x_m);
        wj[l]   = __builtin_shufflevector(vb, zero, 4, 5, 6, 7, 8, 8, 8, 8);
        v_wi[l] = load_eight(a->v_mps) - __builtin_shufflevector(vb, zero, 0, 1, 2, 3, 8, 8, 8, 8);
    }
    put_four(d, block->d_m, c);
    put_four(d + 4, block->d_m, c + 4);
    put_eight(v_wi, block->in, c);
    eight_single column[8];
    transpose_eight(wj, column);
#pragma GCC unroll 3
    for (size_t k = 0; k < 3; k++) {
        memcpy(&block->in[6 + k][c], &column[k], sizeof column[k]);
    }
}

INLINED void gather_single(const struct single_contacts *const   contacts,
                           const struct dig_single_motion *const motion,
                           struct block_single *const            block)
{
    for (size_t c = 0; c < contacts->count; c += 8) {
        gather_eight(contacts->i + c, contacts->j + c, motion, c, block);
    }
}

INLINED void scatter_single(const struct single_contacts *const contacts,
                            struct block_single *const block, struct dig_single_load *const load)
{
    for (size_t c = 0; c < contacts->count; c += 8) {
        eight_single on_i[8];
        eight_single on_j[8];
        get_eight(block->out, block->out + 3, c, false, on_i);
        get_eight(block->out, block->out + 6, c, true, on_j);
#pragma GCC unroll 8
        for (size_t l = 0; l < 8; l++) {
            add_load(&load[contacts->i[c + l]], &on_i[l]);
            add_load(&load[contacts->j[c + l]], &on_j[l]);
        }
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_ROWS_SINGLE_H
