// As rows.h, for contacts of grains with flat walls: a wall's row is its normal and its offset.
// Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H
#define DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H

#include "offline_dem/kernel/block.h"
#include "offline_dem/kernel/rows.h"
#include "offline_dem/kernel/rows_single.h"
#include "offline_dem/law/wall.h"

// Distances of four grains from walls along the normals, which come out as columns. A grain pressed
// through a wall stays on its inner side.
INLINED four wall_distances(const four wall[4], const four x[4], const double least_m, four n[4])
{
    const four least = { least_m, least_m, least_m, least_m };
    four       at[4];
    transpose_four(wall, n);
    transpose_four(x, at);
    const four       h   = n[0] * at[0] + n[1] * at[1] + n[2] * at[2] - n[3];
    const four_index out = h > least;
    return (four)((out & (four_index)h) | (~out & (four_index)least));
}

INLINED void put_walls(const four wall[4], const four x[4], const double least_m,
                       double (*const in)[DIG_BLOCK], const size_t c)
{
    four       n[4];
    const four h = wall_distances(wall, x, least_m, n);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const four d = h * n[k];
        store_four(&in[k][c], &d);
    }
}

// Padding beyond the last contact names a grain and a wall that exist.
INLINED void gather_walls(const struct dig_contacts *const list, const struct dig_wall wall[],
                          const double radius_m, const struct dig_motion *const motion,
                          const size_t first, const size_t count, struct dig_block *const block)
{
    const four zero = { 0.0, 0.0, 0.0, 0.0 };
    for (size_t c = 0; c < count; c += 4) {
        four n[4];
        four x[4];
        four v[4];
        four w[4];
#pragma GCC unroll 4
        for (size_t l = 0; l < 4; l++) {
            const struct dig_motion *const m = &motion[list->i[first + c + l]];
            n[l] = load_four((const double *)&wall[list->j[first + c + l]]);
            x[l] = load_four(m->x_m);
            v[l] = load_four(m->v_mps);
            w[l] = load_four(m->w_radps);
        }
        put_walls(n, x, 1e-3 * radius_m, block->in, c);
        put_four(v, block->in + 3, c);
        put_four(w, block->in + 6, c);
#pragma GCC unroll 3
        for (int k = 0; k < 3; k++) {
            store_four(&block->in[9 + k][c], &zero);
        }
    }
}

// The walls' reaction is summed in the order of the contacts.
INLINED void scatter_walls(const struct dig_contacts *const list,
                           const struct dig_block *const block, const size_t first,
                           const size_t count, struct dig_load *const load, four *const on_walls_N)
{
    const double(*const out)[DIG_BLOCK] = (const double(*)[DIG_BLOCK])block->out;
    for (size_t c = 0; c < count; c += 4) {
        four f[4];
        four t[4];
        get_four(out, c, f);
        get_four(out + 3, c, t);
#pragma GCC unroll 4
        for (size_t l = 0; l < 4; l++) {
            struct dig_load *const to = &load[list->i[first + c + l]];
            add_four(to->f_N, &f[l]);
            add_four(to->t_Nm, &t[l]);
            *on_walls_N -= f[l];
        }
    }
}

// The normal is the wall's own. One worked out from the distance is off by its rounding, which
// leaves springs along the normal that fade into subnormal floats, and these are slow.
INLINED void put_walls_single(const four wall[4], const four x[4], const double least_m,
                              const double radius_m, float (*const normal)[DIG_BLOCK],
                              const size_t c)
{
    const four radius = { radius_m, radius_m, radius_m, radius_m };
    four       n[4];
    const four h = wall_distances(wall, x, least_m, n);
    n[3]         = radius - h;
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++) {
        const four_single value = __builtin_convertvector(n[k], four_single);
        memcpy(&normal[k][c], &value, sizeof value);
    }
}

// Padding beyond the last contact overlaps nothing.
INLINED void gather_walls_single(const struct single_contacts *const contacts,
                                 const struct dig_wall wall[], const double radius_m,
                                 const struct dig_single_motion *const motion,
                                 struct block_single *const            block)
{
    const eight_single zero = { 0.0F };
    for (size_t c = 0; c < contacts->count; c += 8) {
        four         n[8];
        four         x[8];
        eight_single v_w[8];
#pragma GCC unroll 8
        for (size_t l = 0; l < 8; l++) {
            const struct dig_single_motion *const m = &motion[contacts->i[c + l]];

            n[l]   = load_four((const double *)&wall[contacts->j[c + l]]);
            x[l]   = load_four(m->x_m);
            v_w[l] = load_eight(m->v_mps);
        }
        put_walls_single(n, x, 1e-3 * radius_m, radius_m, block->normal, c);
        put_walls_single(n + 4, x + 4, 1e-3 * radius_m, radius_m, block->normal, c + 4);
        put_eight(v_w, block->in, c);
#pragma GCC unroll 3
        for (size_t k = 0; k < 3; k++) {
            memcpy(&block->in[6 + k][c], &zero, sizeof zero);
        }
    }
    for (size_t c = contacts->count; c < round_up(contacts->count, LANES_SINGLE); c++) {
        block->normal[3][c] = -(float)FAR_m;
    }
}

INLINED void scatter_walls_single(const struct single_contacts *const contacts,
                                  struct block_single *const          block,
                                  struct dig_single_load *const load, four *const on_walls_N)
{
    for (size_t c = 0; c < contacts->count; c += 8) {
        eight_single row[8];
        get_eight(block->out, block->out + 3, c, false, row);
#pragma GCC unroll 8
        for (size_t l = 0; l < 8; l++) {
            const four_single f = __builtin_shufflevector(row[l], row[l], 0, 1, 2, 3);
            add_load(&load[contacts->i[c + l]], &row[l]);
            *on_walls_N -= __builtin_convertvector(f, four);
        }
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H
