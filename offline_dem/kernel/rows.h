// Transposes grains (rows) into contacts (columns), and back: four contacts at a time, or eight
// where the processor has vectors of eight doubles (`wide`). Plain C with vector types, which the
// compiler splits where the processor has shorter ones. Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_ROWS_H
#define DIG_OFFLINE_DEM_KERNEL_ROWS_H

#include "offline_dem/kernel/contacts.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/kernel/kernel.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define DIG_LANES 8 // doubles of the widest vector; blocks are padded to it

#define INLINED __attribute__((always_inline)) static inline

// Every function below that passes vectors is inlined: the calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double  four __attribute__((vector_size(32)));
typedef int64_t four_index __attribute__((vector_size(32)));
typedef double  eight __attribute__((vector_size(64)));

INLINED four load_four(const double row[4])
{
    four v;
    memcpy(&v, row, sizeof v);
    return v;
}

INLINED void store_four(double row[4], const four *const v)
{
    memcpy(row, v, sizeof *v);
}

INLINED eight load_eight(const double row[8])
{
    eight v;
    memcpy(&v, row, sizeof v);
    return v;
}

INLINED void store_eight(double row[8], const eight *const v)
{
    memcpy(row, v, sizeof *v);
}

// Rows a b c d become columns: (a0 b0 c0 d0), (a1 b1 c1 d1), …
INLINED void transpose_four(const four row[4], four column[4])
{
    const four ab_even = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
    const four ab_odd  = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const four cd_even = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
    const four cd_odd  = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    column[0]          = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
    column[1]          = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
    column[2]          = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
    column[3]          = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

// Even and odd pairs of doubles of a, then of b.
INLINED eight even_pairs(const eight *const a, const eight *const b)
{
    return __builtin_shufflevector(*a, *b, 0, 1, 4, 5, 8, 9, 12, 13);
}

INLINED eight odd_pairs(const eight *const a, const eight *const b)
{
    return __builtin_shufflevector(*a, *b, 2, 3, 6, 7, 10, 11, 14, 15);
}

// The same for eight rows of eight.
INLINED void transpose_eight(const eight row[8], eight column[8])
{
    eight even[4];
    eight odd[4];
#pragma GCC unroll 4
    for (size_t k = 0; k < 4; k++) {
        const eight a = row[2 * k];
        const eight b = row[2 * k + 1];
        even[k]       = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
        odd[k]        = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    }
    const eight even_low[2]  = { even_pairs(&even[0], &even[1]), even_pairs(&even[2], &even[3]) };
    const eight even_high[2] = { odd_pairs(&even[0], &even[1]), odd_pairs(&even[2], &even[3]) };
    const eight odd_low[2]   = { even_pairs(&odd[0], &odd[1]), even_pairs(&odd[2], &odd[3]) };
    const eight odd_high[2]  = { odd_pairs(&odd[0], &odd[1]), odd_pairs(&odd[2], &odd[3]) };
    column[0]                = even_pairs(&even_low[0], &even_low[1]);
    column[1]                = even_pairs(&odd_low[0], &odd_low[1]);
    column[2]                = even_pairs(&even_high[0], &even_high[1]);
    column[3]                = even_pairs(&odd_high[0], &odd_high[1]);
    column[4]                = odd_pairs(&even_low[0], &even_low[1]);
    column[5]                = odd_pairs(&odd_low[0], &odd_low[1]);
    column[6]                = odd_pairs(&even_high[0], &even_high[1]);
    column[7]                = odd_pairs(&odd_high[0], &odd_high[1]);
}

INLINED void put_four(const four row[4], double (*const field)[DIG_BLOCK], const size_t c)
{
    four column[4];
    transpose_four(row, column);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        store_four(&field[k][c], &column[k]);
    }
}

// Two vectors of three in a row: six columns.
INLINED void put_eight(const eight row[8], double (*const field)[DIG_BLOCK], const size_t c)
{
    eight column[8];
    transpose_eight(row, column);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        store_eight(&field[k][c], &column[k]);
        store_eight(&field[3 + k][c], &column[4 + k]);
    }
}

INLINED void gather_four(const uint32_t *const i, const uint32_t *const j,
                         const struct dig_motion *const motion, const size_t c,
                         struct dig_block *const block)
{
    four d[4];
    four v[4];
    four wi[4];
    four wj[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; l++) {
        const struct dig_motion *const a = &motion[i[l]];
        const struct dig_motion *const b = &motion[j[l]];
        d[l]                             = load_four(a->x_m) - load_four(b->x_m);
        v[l]                             = load_four(a->v_mps) - load_four(b->v_mps);
        wi[l]                            = load_four(a->w_radps);
        wj[l]                            = load_four(b->w_radps);
    }
    put_four(d, block->in, c);
    put_four(v, block->in + 3, c);
    put_four(wi, block->in + 6, c);
    put_four(wj, block->in + 9, c);
}

INLINED void gather_eight(const uint32_t *const i, const uint32_t *const j,
                          const struct dig_motion *const motion, const size_t c,
                          struct dig_block *const block)
{
    eight dv[8];
    eight w[8];
#pragma GCC unroll 8
    for (int l = 0; l < 8; l++) {
        const struct dig_motion *const a  = &motion[i[l]];
        const struct dig_motion *const b  = &motion[j[l]];
        const four                     wi = load_four(a->w_radps);
        const four                     wj = load_four(b->w_radps);
        // Velocities follow positions.
        dv[l] = load_eight((const double *)a) - load_eight((const double *)b);
        w[l]  = __builtin_shufflevector(wi, wj, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    put_eight(dv, block->in, c);
    put_eight(w, block->in + 6, c);
}

// Padding beyond the last contact names grains that exist.
INLINED void gather(const bool wide, const struct dig_contacts *const list,
                    const struct dig_motion *const motion, const size_t first, const size_t count,
                    struct dig_block *const block)
{
    const uint32_t *const i = list->i + first;
    const uint32_t *const j = list->j + first;
    if (wide) {
        for (size_t c = 0; c < count; c += 8) {
            gather_eight(i + c, j + c, motion, c, block);
        }
    } else {
        for (size_t c = 0; c < count; c += 4) {
            gather_four(i + c, j + c, motion, c, block);
        }
    }
}

INLINED void get_four(const double (*const field)[DIG_BLOCK], const size_t c, four row[4])
{
    const four zero      = { 0.0, 0.0, 0.0, 0.0 };
    const four column[4] = { load_four(&field[0][c]), load_four(&field[1][c]),
                             load_four(&field[2][c]), zero };
    transpose_four(column, row);
}

INLINED void add_four(double row[4], const four *const v)
{
    const four sum = load_four(row) + *v;
    store_four(row, &sum);
}

INLINED void add_eight(double row[8], const eight *const v)
{
    const eight sum = load_eight(row) + *v;
    store_eight(row, &sum);
}

INLINED void scatter_four(const uint32_t *const i, const uint32_t *const     j,
                          const double (*const out)[DIG_BLOCK], const size_t c,
                          struct dig_load *const load)
{
    four f[4];
    four ti[4];
    four tj[4];
    get_four(out, c, f);
    get_four(out + 3, c, ti);
    get_four(out + 6, c, tj);
#pragma GCC unroll 4
    for (int l = 0; l < 4; l++) {
        struct dig_load *const a        = &load[i[l]];
        struct dig_load *const b        = &load[j[l]];
        const four             reaction = -f[l];
        add_four(a->f_N, &f[l]);
        add_four(a->t_Nm, &ti[l]);
        add_four(b->f_N, &reaction);
        add_four(b->t_Nm, &tj[l]);
    }
}

// Torques follow forces.
INLINED void scatter_eight(const uint32_t *const i, const uint32_t *const     j,
                           const double (*const out)[DIG_BLOCK], const size_t c,
                           struct dig_load *const load)
{
    const eight zero = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
    const eight f[3] = { load_eight(&out[0][c]), load_eight(&out[1][c]), load_eight(&out[2][c]) };
    const eight to_i[8] = { f[0],
                            f[1],
                            f[2],
                            zero,
                            load_eight(&out[3][c]),
                            load_eight(&out[4][c]),
                            load_eight(&out[5][c]),
                            zero };
    const eight to_j[8] = { -f[0],
                            -f[1],
                            -f[2],
                            zero,
                            load_eight(&out[6][c]),
                            load_eight(&out[7][c]),
                            load_eight(&out[8][c]),
                            zero };
    eight       at_i[8];
    eight       at_j[8];
    transpose_eight(to_i, at_i);
    transpose_eight(to_j, at_j);
#pragma GCC unroll 8
    for (int l = 0; l < 8; l++) {
        add_eight((double *)&load[i[l]], &at_i[l]);
        add_eight((double *)&load[j[l]], &at_j[l]);
    }
}

INLINED void scatter(const bool wide, const struct dig_contacts *const list,
                     const struct dig_block *const block, const size_t first, const size_t count,
                     struct dig_load *const load)
{
    const double(*const out)[DIG_BLOCK] = (const double(*)[DIG_BLOCK])block->out;
    const uint32_t *const i             = list->i + first;
    const uint32_t *const j             = list->j + first;
    if (wide) {
        for (size_t c = 0; c < count; c += 8) {
            scatter_eight(i + c, j + c, out, c, load);
        }
    } else {
        for (size_t c = 0; c < count; c += 4) {
            scatter_four(i + c, j + c, out, c, load);
        }
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_ROWS_H
