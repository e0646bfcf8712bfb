// The law on a block of contacts. The plain law goes through its stages (law.h) with all contacts
// of the block at one stage before the next begins. Columns of the block, as the stages leave them:
//
//              0..2   3..5   6         7      8      9       10       11       d_m    may_cap
//   filled     d      v      w_i ...          ...    w_j ...          ...
//   lines      n      .      .         .      .      .       .        .        |d|
//   strains    n      slip   F_n       |xi|^2 |M|^2  1       1        1        |d|    0, 1
//   caps       n      slip   F_n       .      .      spring  damping  torque   |d|
//   pushes     f_i    t_i    t_j: 6..8
//
// For kernel.c, whose variants inline it.

#ifndef DIG_OFFLINE_DEM_KERNEL_STAGES_H
#define DIG_OFFLINE_DEM_KERNEL_STAGES_H

#include "offline_dem/kernel/kernel.h"
#include "offline_dem/kernel/rows.h"
#include "offline_dem/law/law_general.h"

// Lanes beyond the last contact: bodies far apart, which the law answers with zeros.
BODY size_t pad(const size_t count, struct dig_block *const block)
{
    const size_t padded = (count + DIG_LANES - 1) / DIG_LANES * DIG_LANES;
    for (size_t c = count; c < padded; c++) {
        for (int k = 0; k < 12; k++) {
            block->in[k][c] = 1e3;
        }
    }
    return padded;
}

BODY struct dig_memory recall(double *const memories[DIG_MEMORIES], const size_t c)
{
    return (struct dig_memory){ memories[0][c], memories[1][c], memories[2][c],
                                memories[3][c], memories[4][c], memories[5][c] };
}

BODY void remember(double *const memories[DIG_MEMORIES], const size_t c,
                   const struct dig_memory memory)
{
    memories[0][c] = memory.sx_m;
    memories[1][c] = memory.sy_m;
    memories[2][c] = memory.sz_m;
    memories[3][c] = memory.mx_Nm;
    memories[4][c] = memory.my_Nm;
    memories[5][c] = memory.mz_Nm;
}

BODY void put_push(double (*const out)[DIG_BLOCK], const size_t c, const struct dig_push push)
{
    out[0][c] = push.fx_N;
    out[1][c] = push.fy_N;
    out[2][c] = push.fz_N;
    out[3][c] = push.ix_Nm;
    out[4][c] = push.iy_Nm;
    out[5][c] = push.iz_Nm;
    out[6][c] = push.jx_Nm;
    out[7][c] = push.jy_Nm;
    out[8][c] = push.jz_Nm;
}

BODY struct dig_touch get_touch(double (*const in)[DIG_BLOCK], const size_t c)
{
    return (struct dig_touch){ in[0][c], in[1][c], in[2][c], in[3][c], in[4][c],  in[5][c],
                               in[6][c], in[7][c], in[8][c], in[9][c], in[10][c], in[11][c] };
}

BODY void find_lines(const size_t padded, double (*const col)[DIG_BLOCK], double d_m[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_line n = dig_law_line(col[0][c], col[1][c], col[2][c]);
        col[0][c]               = n.nx;
        col[1][c]               = n.ny;
        col[2][c]               = n.nz;
        d_m[c]                  = n.d_m;
    }
}

BODY void find_strains(const struct dig_law law, const double dt_s, const size_t padded,
                       double *const memories[DIG_MEMORIES], double (*const col)[DIG_BLOCK],
                       const double d_m[], int64_t may_cap[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_line   n      = { col[0][c], col[1][c], col[2][c], d_m[c] };
        struct dig_memory       memory = recall(memories, c);
        const struct dig_strain strain = dig_law_strain(law, dt_s, n, get_touch(col, c), &memory);
        remember(memories, c, memory);
        col[3][c]  = strain.vx_mps;
        col[4][c]  = strain.vy_mps;
        col[5][c]  = strain.vz_mps;
        col[6][c]  = strain.normal_N;
        col[7][c]  = strain.spring2_m2;
        col[8][c]  = strain.torque2_Nm2;
        col[9][c]  = 1.0;
        col[10][c] = 1.0;
        col[11][c] = 1.0;
        may_cap[c] = dig_law_may_cap(law, strain) & (n.d_m < law.reach_m);
    }
}

// Roots and quotients only for the contacts that may need them, one in six of a bed at rest: these
// are brought side by side.
BODY void find_caps(const struct dig_law law, const size_t padded, double (*const col)[DIG_BLOCK],
                    const int64_t may_cap[])
{
    uint32_t which[DIG_BLOCK + DIG_LANES];
    size_t   n = 0;
    for (size_t c = 0; c < padded; c++) {
        which[n] = (uint32_t)c;
        n += may_cap[c] != 0;
    }
    for (size_t k = n; k % DIG_LANES != 0; k++) {
        which[k] = which[n - 1];
    }
    for (size_t k = 0; k < n; k += DIG_LANES) {
        _Alignas(64) double side[6][DIG_LANES];
        for (size_t l = 0; l < DIG_LANES; l++) {
            side[0][l] = col[6][which[k + l]];
            side[1][l] = col[7][which[k + l]];
            side[2][l] = col[8][which[k + l]];
        }
#pragma omp simd simdlen(8)
        for (size_t l = 0; l < DIG_LANES; l++) {
            const struct dig_strain strain = { .normal_N    = side[0][l],
                                               .spring2_m2  = side[1][l],
                                               .torque2_Nm2 = side[2][l] };
            const struct dig_caps   caps   = dig_law_caps(law, strain);
            side[3][l]                     = caps.spring;
            side[4][l]                     = caps.damping;
            side[5][l]                     = caps.torque;
        }
        for (size_t l = 0; l < DIG_LANES; l++) {
            col[9][which[k + l]]  = side[3][l];
            col[10][which[k + l]] = side[4][l];
            col[11][which[k + l]] = side[5][l];
        }
    }
}

BODY void find_pushes(const struct dig_law law, const size_t padded,
                      double *const memories[DIG_MEMORIES], double (*const col)[DIG_BLOCK],
                      const double  d_m[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_line   n      = { col[0][c], col[1][c], col[2][c], d_m[c] };
        const struct dig_strain strain = {
            .normal_N = col[6][c], .vx_mps = col[3][c], .vy_mps = col[4][c], .vz_mps = col[5][c]
        };
        const struct dig_caps caps   = { col[9][c], col[10][c], col[11][c] };
        struct dig_memory     memory = recall(memories, c);
        const struct dig_push push   = dig_law_push(law, n, strain, caps, &memory);
        remember(memories, c, memory);
        put_push(col, c, push);
    }
}

BODY void block_plain(const struct dig_law law, const double dt_s, const size_t count,
                      double *const memories[DIG_MEMORIES], struct dig_block *const block)
{
    const size_t padded = pad(count, block);
    find_lines(padded, block->in, block->d_m);
    find_strains(law, dt_s, padded, memories, block->in, block->d_m, block->may_cap);
    find_caps(law, padded, block->in, block->may_cap);
    find_pushes(law, padded, memories, block->in, block->d_m);
}

BODY void block_general(const struct dig_law law, const double dt_s, const size_t count,
                        double *const memories[DIG_MEMORIES], struct dig_block *const block)
{
    const size_t padded = pad(count, block);
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        struct dig_memory     memory = recall(memories, c);
        const struct dig_push push   = dig_law_general(law, dt_s, get_touch(block->in, c), &memory);
        remember(memories, c, memory);
        put_push(block->out, c, push);
    }
}

// `general` is a constant where this is inlined: the plain law pays nothing for the others.
BODY void block_body(const bool general, const struct dig_law law, const double dt_s,
                     const size_t count, double *const memories[DIG_MEMORIES],
                     struct dig_block *const block)
{
    if (general) {
        block_general(law, dt_s, count, memories, block);
    } else {
        block_plain(law, dt_s, count, memories, block);
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_STAGES_H
