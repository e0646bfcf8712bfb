// The law on a block of contacts. The plain law goes through its stages (law.h) with all contacts
// of the block at one stage before the next begins. Columns of the block after each stage:
//
//              0..2   3..5   6         7      8      9       10       11       d_m    may_cap
//   gathered   d      v      w_i ...          ...    w_j ...          ...
//   normals    n      .      .         .      .      .       .        .        |d|
//   trials     n      slip   F_n       |xi|^2 |M|^2  1       1        1        |d|    0, 1
//   caps       n      slip   F_n       .      .      spring  damping  torque   |d|
//   forces     f_i    t_i    t_j: 6..8
//
// Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_STAGES_H
#define DIG_OFFLINE_DEM_KERNEL_STAGES_H

#include "offline_dem/kernel/kernel.h"
#include "offline_dem/kernel/rows.h"
#include "offline_dem/law/law_general.h"

// Padding lanes are bodies far apart, for which the law gives zeros.
INLINED size_t pad(const size_t count, struct dig_block *const block)
{
    const size_t padded = (count + DIG_LANES - 1) / DIG_LANES * DIG_LANES;
    for (size_t c = count; c < padded; c++) {
        for (int k = 0; k < 12; k++) {
            block->in[k][c] = 1e3;
        }
    }
    return padded;
}

INLINED struct dig_contact_history load_history(double *const histories[DIG_HISTORY_VALUES],
                                                const size_t  c)
{
    return (struct dig_contact_history){ histories[0][c], histories[1][c], histories[2][c],
                                         histories[3][c], histories[4][c], histories[5][c] };
}

INLINED void store_history(double *const histories[DIG_HISTORY_VALUES], const size_t c,
                           const struct dig_contact_history history)
{
    histories[0][c] = history.sx_m;
    histories[1][c] = history.sy_m;
    histories[2][c] = history.sz_m;
    histories[3][c] = history.mx_Nm;
    histories[4][c] = history.my_Nm;
    histories[5][c] = history.mz_Nm;
}

INLINED void store_force(double (*const out)[DIG_BLOCK], const size_t c,
                         const struct dig_contact_force force)
{
    out[0][c] = force.fx_N;
    out[1][c] = force.fy_N;
    out[2][c] = force.fz_N;
    out[3][c] = force.ix_Nm;
    out[4][c] = force.iy_Nm;
    out[5][c] = force.iz_Nm;
    out[6][c] = force.jx_Nm;
    out[7][c] = force.jy_Nm;
    out[8][c] = force.jz_Nm;
}

INLINED struct dig_kinematics load_kinematics(double (*const in)[DIG_BLOCK], const size_t c)
{
    return (struct dig_kinematics){ in[0][c], in[1][c], in[2][c], in[3][c], in[4][c],  in[5][c],
                                    in[6][c], in[7][c], in[8][c], in[9][c], in[10][c], in[11][c] };
}

INLINED void find_normals(const size_t padded, double (*const col)[DIG_BLOCK], double d_m[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_contact_normal n = dig_law_normal(col[0][c], col[1][c], col[2][c]);
        col[0][c]                         = n.nx;
        col[1][c]                         = n.ny;
        col[2][c]                         = n.nz;
        d_m[c]                            = n.d_m;
    }
}

INLINED void find_trials(const struct dig_law law, const double dt_s, const size_t padded,
                         double *const histories[DIG_HISTORY_VALUES],
                         double (*const col)[DIG_BLOCK], const double d_m[], int64_t may_cap[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_contact_normal n       = { col[0][c], col[1][c], col[2][c], d_m[c] };
        struct dig_contact_history      history = load_history(histories, c);
        const struct dig_trial          trial =
            dig_law_trial(law, dt_s, n, load_kinematics(col, c), &history);
        store_history(histories, c, history);
        col[3][c]  = trial.vx_mps;
        col[4][c]  = trial.vy_mps;
        col[5][c]  = trial.vz_mps;
        col[6][c]  = trial.normal_N;
        col[7][c]  = trial.spring2_m2;
        col[8][c]  = trial.torque2_Nm2;
        col[9][c]  = 1.0;
        col[10][c] = 1.0;
        col[11][c] = 1.0;
        may_cap[c] = dig_law_may_cap(law, trial) & (n.d_m < law.reach_m);
    }
}

// Square roots and quotients only for the contacts that may need them, one in six of a bed at rest:
// these are packed together.
INLINED void find_caps(const struct dig_law law, const size_t        padded,
                       double (*const col)[DIG_BLOCK], const int64_t may_cap[])
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
            const struct dig_trial trial = { .normal_N    = side[0][l],
                                             .spring2_m2  = side[1][l],
                                             .torque2_Nm2 = side[2][l] };
            const struct dig_caps  caps  = dig_law_caps(law, trial);
            side[3][l]                   = caps.spring;
            side[4][l]                   = caps.damping;
            side[5][l]                   = caps.torque;
        }
        for (size_t l = 0; l < DIG_LANES; l++) {
            col[9][which[k + l]]  = side[3][l];
            col[10][which[k + l]] = side[4][l];
            col[11][which[k + l]] = side[5][l];
        }
    }
}

INLINED void find_forces(const struct dig_law law, const size_t padded,
                         double *const histories[DIG_HISTORY_VALUES],
                         double (*const col)[DIG_BLOCK], const double d_m[])
{
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_contact_normal n     = { col[0][c], col[1][c], col[2][c], d_m[c] };
        const struct dig_trial          trial = {
                     .normal_N = col[6][c], .vx_mps = col[3][c], .vy_mps = col[4][c], .vz_mps = col[5][c]
        };
        const struct dig_caps          caps    = { col[9][c], col[10][c], col[11][c] };
        struct dig_contact_history     history = load_history(histories, c);
        const struct dig_contact_force force   = dig_law_force(law, n, trial, caps, &history);
        store_history(histories, c, history);
        store_force(col, c, force);
    }
}

INLINED void block_plain(const struct dig_law law, const double dt_s, const size_t count,
                         double *const histories[DIG_HISTORY_VALUES], struct dig_block *const block)
{
    const size_t padded = pad(count, block);
    find_normals(padded, block->in, block->d_m);
    find_trials(law, dt_s, padded, histories, block->in, block->d_m, block->may_cap);
    find_caps(law, padded, block->in, block->may_cap);
    find_forces(law, padded, histories, block->in, block->d_m);
}

INLINED void block_general(const struct dig_law law, const double dt_s, const size_t count,
                           double *const           histories[DIG_HISTORY_VALUES],
                           struct dig_block *const block)
{
    const size_t padded = pad(count, block);
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        struct dig_contact_history     history = load_history(histories, c);
        const struct dig_contact_force force =
            dig_law_general(law, dt_s, load_kinematics(block->in, c), &history);
        store_history(histories, c, history);
        store_force(block->out, c, force);
    }
}

// `general` is a compile-time constant here: the plain law pays nothing for the others.
INLINED void block_body(const bool general, const struct dig_law law, const double dt_s,
                        const size_t count, double *const histories[DIG_HISTORY_VALUES],
                        struct dig_block *const block)
{
    if (general) {
        block_general(law, dt_s, count, histories, block);
    } else {
        block_plain(law, dt_s, count, histories, block);
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_STAGES_H
