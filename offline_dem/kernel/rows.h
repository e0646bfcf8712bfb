// Transposes grains (rows) into contacts (columns), and back, in double precision: four contacts at
// a time. Plain C with vector types, which the compiler splits where the processor has shorter
// ones. Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_ROWS_H
#define DIG_OFFLINE_DEM_KERNEL_ROWS_H

#include "offline_dem/kernel/contacts.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/kernel/kernel.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define INLINED __attribute__((always_inline)) static inline

// Every function below that passes vectors is inlined: the calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef double  four __attribute__((vector_size(32)));
typedef int64_t four_index __attribute__((vector_size(32)));

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

INLINED void put_four(const four row[4], double (*const field)[DIG_BLOCK], const size_t c)
{
    four column[4];
    transpose_four(row, column);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        store_four(&field[k][c], &column[k]);
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

// Padding beyond the last contact names grains that exist.
INLINED void gather(const struct dig_contacts *const list, const struct dig_motion *const motion,
                    const size_t first, const size_t count, struct dig_block *const block)
{
    for (size_t c = 0; c < count; c += 4) {
        gather_four(list->i + first + c, list->j + first + c, motion, c, block);
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

INLINED void scatter(const struct dig_contacts *const list, const struct dig_block *const block,
                     const size_t first, const size_t count, struct dig_load *const load)
{
    const double(*const out)[DIG_BLOCK] = (const double(*)[DIG_BLOCK])block->out;
    for (size_t c = 0; c < count; c += 4) {
        scatter_four(list->i + first + c, list->j + first + c, out, c, load);
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_ROWS_H
