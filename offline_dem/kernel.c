#include "offline_dem/kernel.h"

#include "offline_dem/law_general.h"
#include "offline_dem/period.h"

#include <stdint.h>
#include <string.h>

#define LANES 8 // doubles of the widest vector; blocks are padded to it

#if defined(__x86_64__) && defined(__GNUC__)
#define VARIANT_AVX2 __attribute__((target("avx2")))
// GCC takes half vectors by itself where full ones might slow the clock; clang has no such word.
#ifdef __clang__
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
#else
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
#endif
#else
#define VARIANT_AVX2
#define VARIANT_AVX512
#endif

#define BODY __attribute__((always_inline)) static inline

enum dig_isa dig_kernel_best(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
        return DIG_ISA_AVX512;
    }
    if (__builtin_cpu_supports("avx2")) {
        return DIG_ISA_AVX2;
    }
#endif
    return DIG_ISA_BASE;
}

const char *dig_kernel_name(const enum dig_isa isa)
{
    return isa == DIG_ISA_AVX512 ? "avx512f" : isa == DIG_ISA_AVX2 ? "avx2" : "baseline";
}

// Lanes beyond the last contact: bodies far apart, which the law answers with zeros.
BODY size_t pad(const size_t count, struct dig_block *const block)
{
    const size_t padded = (count + LANES - 1) / LANES * LANES;
    for (size_t c = count; c < padded; c++) {
        for (int k = 0; k < 12; k++) {
            block->in[k][c] = 1e3;
        }
    }
    return padded;
}

// `general` is a constant where this is inlined: the plain law pays nothing for the others.
BODY void block_body(const bool general, const struct dig_law law, const double dt_s,
                     const size_t count, double *const memories[DIG_MEMORIES],
                     struct dig_block *const block)
{
    const size_t padded                   = pad(count, block);
    double *restrict sx                   = memories[0];
    double *restrict sy                   = memories[1];
    double *restrict sz                   = memories[2];
    double *restrict mx                   = memories[3];
    double *restrict my                   = memories[4];
    double *restrict mz                   = memories[5];
    const double(*restrict in)[DIG_BLOCK] = (const double(*)[DIG_BLOCK])block->in;
    double(*restrict out)[DIG_BLOCK]      = block->out;

#pragma omp simd simdlen(8)
    for (size_t c = 0; c < padded; c++) {
        const struct dig_touch touch = {
            in[0][c], in[1][c], in[2][c], in[3][c], in[4][c],  in[5][c],
            in[6][c], in[7][c], in[8][c], in[9][c], in[10][c], in[11][c],
        };
        struct dig_memory     memory = { sx[c], sy[c], sz[c], mx[c], my[c], mz[c] };
        const struct dig_push push   = general ? dig_law_general(law, dt_s, touch, &memory)
                                               : dig_law_step(law, dt_s, touch, &memory);
        sx[c]                        = memory.sx_m;
        sy[c]                        = memory.sy_m;
        sz[c]                        = memory.sz_m;
        mx[c]                        = memory.mx_Nm;
        my[c]                        = memory.my_Nm;
        mz[c]                        = memory.mz_Nm;
        out[0][c]                    = push.fx_N;
        out[1][c]                    = push.fy_N;
        out[2][c]                    = push.fz_N;
        out[3][c]                    = push.ix_Nm;
        out[4][c]                    = push.iy_Nm;
        out[5][c]                    = push.iz_Nm;
        out[6][c]                    = push.jx_Nm;
        out[7][c]                    = push.jy_Nm;
        out[8][c]                    = push.jz_Nm;
    }
}

// Every function below that passes vectors is inlined: how such arguments travel does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

// Four doubles moved together; the compiler makes two halves where the processor has no more.
typedef double  four __attribute__((vector_size(32)));
typedef int64_t four_index __attribute__((vector_size(32)));

BODY four load_four(const double row[4])
{
    four v;
    memcpy(&v, row, sizeof v);
    return v;
}

BODY void store_four(double row[4], const four *const v)
{
    memcpy(row, v, sizeof *v);
}

// Rows a b c d become columns: (a0 b0 c0 d0), (a1 b1 c1 d1), …
BODY void transpose(const four row[4], four column[4])
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

BODY void put_columns(const four row[4], double (*const field)[DIG_BLOCK], const size_t c)
{
    four column[4];
    transpose(row, column);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        store_four(&field[k][c], &column[k]);
    }
}

// Four contacts at a time: beyond the last stands padding, which names grains that exist.
BODY void gather(const struct dig_contacts *const list, const struct dig_motion *const motion,
                 const size_t first, const size_t count, struct dig_block *const block)
{
    for (size_t c = 0; c < count; c += 4) {
        four d[4];
        four v[4];
        four wi[4];
        four wj[4];
#pragma GCC unroll 4
        for (int l = 0; l < 4; l++) {
            const struct dig_motion *const a = &motion[list->i[first + c + (size_t)l]];
            const struct dig_motion *const b = &motion[list->j[first + c + (size_t)l]];
            d[l]                             = load_four(a->x_m) - load_four(b->x_m);
            v[l]                             = load_four(a->v_mps) - load_four(b->v_mps);
            wi[l]                            = load_four(a->w_radps);
            wj[l]                            = load_four(b->w_radps);
        }
        put_columns(d, block->in, c);
        put_columns(v, block->in + 3, c);
        put_columns(wi, block->in + 6, c);
        put_columns(wj, block->in + 9, c);
    }
}

BODY void get_rows(const double (*const field)[DIG_BLOCK], const size_t c, four row[4])
{
    const four zero      = { 0.0, 0.0, 0.0, 0.0 };
    const four column[4] = { load_four(&field[0][c]), load_four(&field[1][c]),
                             load_four(&field[2][c]), zero };
    transpose(column, row);
}

BODY void add_four(double row[4], const four *const v)
{
    const four sum = load_four(row) + *v;
    store_four(row, &sum);
}

BODY void scatter(const struct dig_contacts *const list, const struct dig_block *const block,
                  const size_t first, const size_t count, struct dig_load *const load)
{
    const double(*const out)[DIG_BLOCK] = (const double(*)[DIG_BLOCK])block->out;
    for (size_t c = 0; c < count; c += 4) {
        four f[4];
        four ti[4];
        four tj[4];
        get_rows(out, c, f);
        get_rows(out + 3, c, ti);
        get_rows(out + 6, c, tj);
#pragma GCC unroll 4
        for (int l = 0; l < 4; l++) {
            struct dig_load *const a        = &load[list->i[first + c + (size_t)l]];
            struct dig_load *const b        = &load[list->j[first + c + (size_t)l]];
            const four             reaction = -f[l];
            add_four(a->f_N, &f[l]);
            add_four(a->t_Nm, &ti[l]);
            add_four(b->f_N, &reaction);
            add_four(b->t_Nm, &tj[l]);
        }
    }
}

BODY void fold(const double period_m, const size_t count, double y_m[DIG_BLOCK])
{
    const double per_m = dig_period_inverse(period_m);
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < count; c++) {
        y_m[c] = dig_period_fold(y_m[c], period_m, per_m);
    }
}

BODY void pairs_body(const bool general, const struct dig_law law, const double dt_s,
                     const double period_m, const bool still, struct dig_contacts *const list,
                     struct dig_grains *const grains)
{
    struct dig_block block;
    double           copy[DIG_MEMORIES][DIG_BLOCK];
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t left  = list->n - first;
        const size_t count = left < DIG_BLOCK ? left : DIG_BLOCK;
        gather(list, grains->motion, first, count, &block);
        if (period_m > 0.0) {
            fold(period_m, count, block.in[1]);
        }
        double *memories[DIG_MEMORIES];
        for (int m = 0; m < DIG_MEMORIES; m++) {
            memories[m] = list->memory[m] + first;
            if (still) {
                memcpy(copy[m], memories[m], sizeof copy[m]);
                memories[m] = copy[m];
            }
        }
        block_body(general, law, dt_s, count, memories, &block);
        scatter(list, &block, first, count, grains->load);
    }
}

// How a kind's velocities answer: gravity, and what a load is multiplied with. Zeros where a body
// drives the grains.
struct answer {
    four   g_mps2;
    double per_kg, per_kgm2;
};

// One grain over one step; returns its displacement since the lists were made, and in the fourth
// lane its margin with the sign turned.
BODY four advance_one(const struct answer *const answer, const double kick_s, const double dt_s,
                      const double at_m[4], struct dig_motion *const motion,
                      struct dig_load *const load)
{
    const four zero = { 0.0, 0.0, 0.0, 0.0 };
    const four v    = load_four(motion->v_mps) +
                   kick_s * (load_four(load->f_N) * answer->per_kg + answer->g_mps2);
    const four w = load_four(motion->w_radps) + kick_s * (load_four(load->t_Nm) * answer->per_kgm2);
    const four x = load_four(motion->x_m) + dt_s * v;
    store_four(motion->v_mps, &v);
    store_four(motion->w_radps, &w);
    store_four(motion->x_m, &x);
    store_four(load->f_N, &zero);
    store_four(load->t_Nm, &zero);
    return x - load_four(at_m);
}

BODY bool advance_body(const double gravity_mps2[3], const double kick_s, const double dt_s,
                       const double (*const at_m)[4], const size_t count,
                       const uint32_t *const which, struct dig_grains *const grains)
{
    const four    g = { gravity_mps2[0], gravity_mps2[1], gravity_mps2[2], 0.0 };
    struct answer answer[DIG_KINDS_MAX];
    for (size_t k = 0; k < grains->kinds; k++) {
        const struct dig_kind kind = grains->kind[k];
        answer[k].g_mps2           = (kind.driven ? 0.0 : 1.0) * g;
        answer[k].per_kg           = kind.driven ? 0.0 : 1.0 / kind.mass_kg;
        answer[k].per_kgm2         = kind.driven ? 0.0 : 1.0 / kind.inertia_kgm2;
    }
    four_index   left = { 0, 0, 0, 0 };
    const size_t n    = which == NULL ? grains->n : count;
    for (size_t k = 0; k < n; k += 4) {
        four d[4] = { { 0.0 }, { 0.0 }, { 0.0 }, { 0.0 } };
        for (size_t l = 0; l < 4 && k + l < n; l++) {
            const size_t i = which == NULL ? k + l : which[k + l];
            d[l] = advance_one(&answer[grains->of[i]], kick_s, dt_s, at_m[i], &grains->motion[i],
                               &grains->load[i]);
        }
        four c[4];
        transpose(d, c);
        // Negated, so that a coordinate that is not a number counts as having left.
        left |= ~(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] <= c[3] * c[3]);
    }
    return (left[0] | left[1] | left[2] | left[3]) != 0;
}

// An attribute cannot stand in parentheses: NOLINTBEGIN(bugprone-macro-parentheses)
#define VARIANTS(attribute, suffix)                                                                \
    attribute static void block_##suffix(const struct dig_law *const law, const double dt_s,       \
                                         const size_t count, double *const memories[DIG_MEMORIES], \
                                         struct dig_block *const block)                            \
    {                                                                                              \
        if (law->general) {                                                                        \
            block_body(true, *law, dt_s, count, memories, block);                                  \
        } else {                                                                                   \
            block_body(false, *law, dt_s, count, memories, block);                                 \
        }                                                                                          \
    }                                                                                              \
    attribute static void pairs_##suffix(                                                          \
        const struct dig_law *const law, const double dt_s, const double period_m,                 \
        const bool still, struct dig_contacts *const list, struct dig_grains *const grains)        \
    {                                                                                              \
        if (law->general) {                                                                        \
            pairs_body(true, *law, dt_s, period_m, still, list, grains);                           \
        } else {                                                                                   \
            pairs_body(false, *law, dt_s, period_m, still, list, grains);                          \
        }                                                                                          \
    }                                                                                              \
    attribute static bool advance_##suffix(const double gravity_mps2[3], const double kick_s,      \
                                           const double dt_s, const double(*const at_m)[4],        \
                                           const size_t count, const uint32_t *const which,        \
                                           struct dig_grains *const grains)                        \
    {                                                                                              \
        return advance_body(gravity_mps2, kick_s, dt_s, at_m, count, which, grains);               \
    }

// NOLINTEND(bugprone-macro-parentheses)
VARIANTS(, base)
VARIANTS(VARIANT_AVX2, avx2)
VARIANTS(VARIANT_AVX512, avx512)

void dig_kernel_block(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const size_t count, double memory[DIG_MEMORIES][DIG_BLOCK],
                      struct dig_block *const block)
{
    double *const memories[DIG_MEMORIES] = { memory[0], memory[1], memory[2],
                                             memory[3], memory[4], memory[5] };
    switch (isa) {
    case DIG_ISA_AVX512: block_avx512(law, dt_s, count, memories, block); break;
    case DIG_ISA_AVX2: block_avx2(law, dt_s, count, memories, block); break;
    case DIG_ISA_BASE: block_base(law, dt_s, count, memories, block); break;
    }
}

static void run_pairs(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const double period_m, const bool still, struct dig_contacts *const list,
                      struct dig_grains *const grains)
{
    switch (isa) {
    case DIG_ISA_AVX512: pairs_avx512(law, dt_s, period_m, still, list, grains); break;
    case DIG_ISA_AVX2: pairs_avx2(law, dt_s, period_m, still, list, grains); break;
    case DIG_ISA_BASE: pairs_base(law, dt_s, period_m, still, list, grains); break;
    }
}

void dig_kernel_pairs(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const double period_y_m, struct dig_contacts *const list,
                      struct dig_grains *const grains)
{
    run_pairs(isa, law, dt_s, period_y_m, false, list, grains);
}

void dig_kernel_still(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const double period_y_m, struct dig_contacts *const list,
                      struct dig_grains *const grains)
{
    run_pairs(isa, law, dt_s, period_y_m, true, list, grains);
}

bool dig_kernel_advance(const enum dig_isa isa, const double gravity_mps2[3], const double kick_s,
                        const double dt_s, const double at_m[][4], const size_t count,
                        const uint32_t which[], struct dig_grains *const grains)
{
    switch (isa) {
    case DIG_ISA_AVX512:
        return advance_avx512(gravity_mps2, kick_s, dt_s, at_m, count, which, grains);
    case DIG_ISA_AVX2: return advance_avx2(gravity_mps2, kick_s, dt_s, at_m, count, which, grains);
    case DIG_ISA_BASE: break;
    }
    return advance_base(gravity_mps2, kick_s, dt_s, at_m, count, which, grains);
}
