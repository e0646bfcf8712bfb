// As rows.h, for contacts of grains with flat walls: a wall's row is its normal and its offset.
// Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H
#define DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H

#include "offline_dem/kernel/rows.h"
#include "offline_dem/law/wall.h"

// d of grains at x from walls: the distance along the normal. A grain pressed through a wall stays
// on its inner side.
INLINED void put_walls(const four wall[4], const four x[4], const double least_m,
                       double (*const in)[DIG_BLOCK], const size_t c)
{
    const four least = { least_m, least_m, least_m, least_m };
    four       n[4];
    four       at[4];
    transpose_four(wall, n);
    transpose_four(x, at);
    const four       h    = n[0] * at[0] + n[1] * at[1] + n[2] * at[2] - n[3];
    const four_index out  = h > least;
    const four       safe = (four)((out & (four_index)h) | (~out & (four_index)least));
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const four d = safe * n[k];
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

#endif // DIG_OFFLINE_DEM_KERNEL_WALL_ROWS_H
