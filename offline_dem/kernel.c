#include "offline_dem/kernel.h"

#define LANES 8 // doubles of the widest vector; blocks are padded to it

#if defined(__x86_64__) && defined(__GNUC__)
#define VARIANT_AVX2   __attribute__((target("avx2")))
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
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
            block->in[k][c] = 1e9;
        }
    }
    return padded;
}

BODY void block_body(const struct dig_law law, const double dt_s, const size_t count,
                     double *const memories[DIG_MEMORIES], struct dig_block *const block)
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
        const struct dig_push push   = dig_law_step(law, dt_s, touch, &memory);
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

BODY void gather(const struct dig_contacts *const list, const struct dig_motion *const motion,
                 const size_t first, const size_t count, struct dig_block *const block)
{
    for (size_t c = 0; c < count; c++) {
        const struct dig_motion *const a = &motion[list->i[first + c]];
        const struct dig_motion *const b = &motion[list->j[first + c]];
        for (int k = 0; k < 3; k++) {
            block->in[k][c]     = a->x_m[k] - b->x_m[k];
            block->in[3 + k][c] = a->v_mps[k] - b->v_mps[k];
            block->in[6 + k][c] = a->w_radps[k];
            block->in[9 + k][c] = b->w_radps[k];
        }
    }
}

BODY void scatter(const struct dig_contacts *const list, const struct dig_block *const block,
                  const size_t first, const size_t count, struct dig_load *const load)
{
    for (size_t c = 0; c < count; c++) {
        struct dig_load *const a = &load[list->i[first + c]];
        struct dig_load *const b = &load[list->j[first + c]];
        for (int k = 0; k < 3; k++) {
            a->f_N[k] += block->out[k][c];
            a->t_Nm[k] += block->out[3 + k][c];
            b->f_N[k] -= block->out[k][c];
            b->t_Nm[k] += block->out[6 + k][c];
        }
    }
}

BODY void pairs_body(const struct dig_law law, const double dt_s, struct dig_contacts *const list,
                     struct dig_grains *const grains)
{
    struct dig_block block;
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t left  = list->n - first;
        const size_t count = left < DIG_BLOCK ? left : DIG_BLOCK;
        gather(list, grains->motion, first, count, &block);
        double *memories[DIG_MEMORIES];
        for (int m = 0; m < DIG_MEMORIES; m++) {
            memories[m] = list->memory[m] + first;
        }
        block_body(law, dt_s, count, memories, &block);
        scatter(list, &block, first, count, grains->load);
    }
}

BODY bool advance_body(const double gravity_mps2[3], const double kick_s, const double dt_s,
                       const double (*const at_m)[4], struct dig_grains *const grains)
{
    const double g[4] = { gravity_mps2[0], gravity_mps2[1], gravity_mps2[2], 0.0 };
    double       per_kg[DIG_KINDS_MAX], per_kgm2[DIG_KINDS_MAX];
    for (size_t k = 0; k < grains->kinds; k++) {
        per_kg[k]   = 1.0 / grains->kind[k].mass_kg;
        per_kgm2[k] = 1.0 / grains->kind[k].inertia_kgm2;
    }
    double worst_m2 = 0.0;
    bool   broken   = false;
    for (size_t i = 0; i < grains->n; i++) {
        struct dig_motion *const m = &grains->motion[i];
        struct dig_load *const   l = &grains->load[i];
        const double             a = per_kg[grains->of[i]];
        const double             b = per_kgm2[grains->of[i]];
        double                   d[4];
        for (int k = 0; k < 4; k++) {
            m->v_mps[k] += kick_s * (l->f_N[k] * a + g[k]);
            m->w_radps[k] += kick_s * (l->t_Nm[k] * b);
            m->x_m[k] += dt_s * m->v_mps[k];
            l->f_N[k]  = 0.0;
            l->t_Nm[k] = 0.0;
            d[k]       = m->x_m[k] - at_m[i][k];
        }
        const double over_m2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - at_m[i][3] * at_m[i][3];
        worst_m2             = over_m2 > worst_m2 ? over_m2 : worst_m2;
        broken |= !(over_m2 < 1e12);
    }
    return worst_m2 > 0.0 || broken;
}

#define VARIANTS(attribute, suffix)                                                                \
    attribute static void block_##suffix(const struct dig_law *const law, const double dt_s,       \
                                         const size_t count, double *const memories[DIG_MEMORIES], \
                                         struct dig_block *const block)                            \
    {                                                                                              \
        block_body(*law, dt_s, count, memories, block);                                            \
    }                                                                                              \
    attribute static void pairs_##suffix(const struct dig_law *const law, const double dt_s,       \
                                         struct dig_contacts *const list,                          \
                                         struct dig_grains *const   grains)                        \
    {                                                                                              \
        pairs_body(*law, dt_s, list, grains);                                                      \
    }                                                                                              \
    attribute static bool advance_##suffix(const double gravity_mps2[3], const double kick_s,      \
                                           const double dt_s, const double(*const at_m)[4],        \
                                           struct dig_grains *const grains)                        \
    {                                                                                              \
        return advance_body(gravity_mps2, kick_s, dt_s, at_m, grains);                             \
    }

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

void dig_kernel_pairs(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      struct dig_contacts *const list, struct dig_grains *const grains)
{
    switch (isa) {
    case DIG_ISA_AVX512: pairs_avx512(law, dt_s, list, grains); break;
    case DIG_ISA_AVX2: pairs_avx2(law, dt_s, list, grains); break;
    case DIG_ISA_BASE: pairs_base(law, dt_s, list, grains); break;
    }
}

bool dig_kernel_advance(const enum dig_isa isa, const double gravity_mps2[3], const double kick_s,
                        const double dt_s, const double at_m[][4], struct dig_grains *const grains)
{
    switch (isa) {
    case DIG_ISA_AVX512: return advance_avx512(gravity_mps2, kick_s, dt_s, at_m, grains);
    case DIG_ISA_AVX2: return advance_avx2(gravity_mps2, kick_s, dt_s, at_m, grains);
    case DIG_ISA_BASE: break;
    }
    return advance_base(gravity_mps2, kick_s, dt_s, at_m, grains);
}
