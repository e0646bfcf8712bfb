// The law on a block of contacts. In single precision the block takes two stages, the normals of
// all contacts before the forces of the first: while a root is worked out the processor goes on
// with other contacts. A wall's contacts have their normals from it. Inlined into the variants of
// kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_BLOCK_H
#define DIG_OFFLINE_DEM_KERNEL_BLOCK_H

#include "offline_dem/kernel/kernel.h"
#include "offline_dem/kernel/rows.h"
#include "offline_dem/kernel/rows_single.h"
#include "offline_dem/law/law_general.h"
#include "offline_dem/law/period.h"

#define LANES        8  // doubles of the widest vector
#define LANES_SINGLE 16 // floats of it
#define FAR_m        1e3

INLINED size_t round_up(const size_t count, const size_t lanes)
{
    return (count + lanes - 1) / lanes * lanes;
}

// Padding lanes are bodies far apart, for which the law gives zeros.
INLINED size_t pad(const size_t count, struct dig_block *const block)
{
    const size_t padded = round_up(count, LANES);
    for (size_t c = count; c < padded; c++) {
        for (int k = 0; k < 12; k++) {
            block->in[k][c] = FAR_m;
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

// `general` is a compile-time constant here: the plain law pays nothing for the others.
INLINED void block_body(const bool general, const struct dig_law law, const double dt_s,
                        const size_t count, double *const histories[DIG_HISTORY_VALUES],
                        struct dig_block *const block)
{
    const size_t padded = pad(count, block);
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_kinematics    t       = load_kinematics(block->in, c);
        struct dig_contact_history     history = load_history(histories, c);
        const struct dig_contact_force force   = general ? dig_law_general(law, dt_s, t, &history)
                                                         : dig_law_step(law, dt_s, t, &history);
        store_history(histories, c, history);
        store_force(block->out, c, force);
    }
}

// Distances in y become those of nearest images.
INLINED void find_normals(const bool periodic, const double reach_m, const double period_m,
                          const size_t padded, struct block_single *const block)
{
    const double inverse_period = dig_period_inverse(period_m);
#pragma omp simd simdlen(16)
    for (size_t c = 0; c < padded; c++) {
        const double dy_m = periodic ? dig_period_fold(block->d_m[1][c], period_m, inverse_period)
                                     : block->d_m[1][c];
        const struct dig_contact_normal_single n =
            dig_law_normal_single(reach_m, block->d_m[0][c], dy_m, block->d_m[2][c]);
        block->normal[0][c] = n.nx;
        block->normal[1][c] = n.ny;
        block->normal[2][c] = n.nz;
        block->normal[3][c] = n.delta_m;
    }
}

// From block->normal and block->in.
INLINED void find_forces(const struct dig_law *const wide, const double wide_dt_s,
                         const struct single_contacts *const contacts,
                         struct block_single *const          block)
{
    const struct dig_law_single law       = dig_law_to_single(wide);
    const float                 dt_s      = (float)wide_dt_s;
    const size_t                padded    = round_up(contacts->count, LANES_SINGLE);
    float *const *const         histories = contacts->history;
    float(*const in)[DIG_BLOCK]           = block->in;
    float(*const out)[DIG_BLOCK]          = block->out;
#pragma omp simd simdlen(16)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_contact_normal_single n = { block->normal[0][c], block->normal[1][c],
                                                     block->normal[2][c], block->normal[3][c] };
        const struct dig_contact_motion_single t = { in[0][c], in[1][c], in[2][c],
                                                     in[3][c], in[4][c], in[5][c],
                                                     in[6][c], in[7][c], in[8][c] };
        struct dig_contact_history_single h = { histories[0][c], histories[1][c], histories[2][c],
                                                histories[3][c], histories[4][c], histories[5][c] };
        const struct dig_contact_force_single f = dig_law_force_single(law, dt_s, n, t, &h);

        histories[0][c] = h.sx_m;
        histories[1][c] = h.sy_m;
        histories[2][c] = h.sz_m;
        histories[3][c] = h.mx_Nm;
        histories[4][c] = h.my_Nm;
        histories[5][c] = h.mz_Nm;
        out[0][c]       = f.fx_N;
        out[1][c]       = f.fy_N;
        out[2][c]       = f.fz_N;
        out[3][c]       = f.ix_Nm;
        out[4][c]       = f.iy_Nm;
        out[5][c]       = f.iz_Nm;
        out[6][c]       = f.jx_Nm;
        out[7][c]       = f.jy_Nm;
        out[8][c]       = f.jz_Nm;
    }
}

INLINED void find_pair_normals(const struct dig_law *const law, const double period_m,
                               const size_t count, struct block_single *const block)
{
    const size_t padded = round_up(count, LANES_SINGLE);
    for (size_t c = count; c < padded; c++) {
        for (int k = 0; k < 3; k++) {
            block->d_m[k][c] = FAR_m;
        }
    }
    if (period_m > 0.0) {
        find_normals(true, law->reach_m, period_m, padded, block);
    } else {
        find_normals(false, law->reach_m, 0.0, padded, block);
    }
}

#endif // DIG_OFFLINE_DEM_KERNEL_BLOCK_H
