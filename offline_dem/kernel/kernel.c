#include "offline_dem/kernel/kernel.h"

#include "offline_dem/kernel/block.h"
#include "offline_dem/kernel/rows.h"
#include "offline_dem/kernel/wall_rows.h"
#include "offline_dem/law/period.h"

#include <stdint.h>
#include <string.h>

// DIG_KERNEL_BASE: the baseline alone, for sanitizers and analyzers, which take as long over every
// variant of the same lines.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(DIG_KERNEL_BASE)
#define VARIANT_AVX2 __attribute__((target("avx2")))
// GCC prefers half vectors where full ones might lower the clock; clang has no such option.
#ifdef __clang__
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
#else
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
#endif
#endif

enum dig_isa dig_kernel_best(void)
{
#ifdef VARIANT_AVX2
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

INLINED void fold(const double period_m, const size_t count, double y_m[DIG_BLOCK])
{
    const double inverse_period = dig_period_inverse(period_m);
#pragma omp simd simdlen(8)
    for (size_t c = 0; c < count; c++) {
        y_m[c] = dig_period_fold(y_m[c], period_m, inverse_period);
    }
}

// Where the histories of a block of contacts stand.
INLINED void find_histories(struct dig_contacts *const list, const size_t first,
                            double *histories[DIG_HISTORY_VALUES])
{
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        histories[m] = list->history[m] + first;
    }
}

INLINED size_t block_count(const size_t first, const size_t end)
{
    return end - first < DIG_BLOCK ? end - first : DIG_BLOCK;
}

// Blocks are cleared once a list: the analyzer does not see that every stage fills the operands of
// the next.
INLINED void pairs_body(const bool general, const struct dig_law law, const double dt_s,
                        const double period_m, struct dig_contacts *const list,
                        struct dig_grains *const grains)
{
    struct dig_block block;
    memset(&block, 0, sizeof block);
    double *histories[DIG_HISTORY_VALUES] = { NULL };
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t count = block_count(first, list->n);
        gather(list, grains->motion, first, count, &block);
        if (period_m > 0.0) {
            fold(period_m, count, block.in[1]);
        }
        find_histories(list, first, histories);
        block_body(general, law, dt_s, count, histories, &block);
        scatter(list, &block, first, count, grains->load);
    }
}

INLINED void pairs_single_body(const struct dig_law *const law, const double dt_s,
                               const double period_m, struct dig_contacts *const list,
                               const size_t slab, struct dig_grains *const grains)
{
    struct dig_single_load *const load = dig_grains_slab_load(grains, slab);
    const size_t                  end  = dig_contacts_slab_first(list, slab + 1);
    struct single_contacts        contacts;
    struct block_single           block;
    memset(&block, 0, sizeof block);
    for (size_t first = dig_contacts_slab_first(list, slab); first < end; first += DIG_BLOCK) {
        begin_block(list, first, block_count(first, end), &contacts);
        gather_single(&contacts, grains->single_motion, &block);
        block_single_body(law, dt_s, period_m, &contacts, &block);
        scatter_single(&contacts, &block, load);
        end_block(&contacts, first, list);
    }
}

// The law's reach is the grain's radius.
INLINED void walls_body(const bool general, const struct dig_law law, const double dt_s,
                        const struct dig_wall wall[], struct dig_contacts *const list,
                        struct dig_grains *const grains, four *const sum_N)
{
    struct dig_block block;
    memset(&block, 0, sizeof block);
    double *histories[DIG_HISTORY_VALUES] = { NULL };
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t count = block_count(first, list->n);
        gather_walls(list, wall, law.reach_m, grains->motion, first, count, &block);
        find_histories(list, first, histories);
        block_body(general, law, dt_s, count, histories, &block);
        scatter_walls(list, &block, first, count, grains->load, sum_N);
    }
}

INLINED void walls_single_body(const struct dig_law *const law, const double dt_s,
                               const struct dig_wall wall[], struct dig_contacts *const list,
                               const size_t slab, struct dig_grains *const grains,
                               four *const sum_N)
{
    struct dig_single_load *const load = dig_grains_slab_load(grains, slab);
    const size_t                  end  = dig_contacts_slab_first(list, slab + 1);
    struct single_contacts        contacts;
    struct block_single           block;
    memset(&block, 0, sizeof block);
    for (size_t first = dig_contacts_slab_first(list, slab); first < end; first += DIG_BLOCK) {
        begin_block(list, first, block_count(first, end), &contacts);
        gather_walls_single(&contacts, wall, law->reach_m, grains->single_motion, &block);
        block_single_body(law, dt_s, 0.0, &contacts, &block);
        scatter_walls_single(&contacts, &block, load, sum_N);
        end_block(&contacts, first, list);
    }
}

// Response of a type's velocities: gravity and the inverse inertia. Zeros where a body drives the
// grains.
struct inertia {
    four         g_mps2;
    double       inverse_kg, inverse_kgm2;
    eight_single g_single, inverse_single; // of v and w
};

// One grain over one step. Returns its displacement since the lists were made, and in the fourth
// lane its negated margin.
INLINED four advance_one_double(const struct inertia *const inertia, const double kick_s,
                                const double dt_s, const double reference_m[4],
                                struct dig_motion *const motion, struct dig_load *const load)
{
    const four zero = { 0.0, 0.0, 0.0, 0.0 };
    const four v    = load_four(motion->v_mps) +
                   kick_s * (load_four(load->f_N) * inertia->inverse_kg + inertia->g_mps2);
    const four w =
        load_four(motion->w_radps) + kick_s * (load_four(load->t_Nm) * inertia->inverse_kgm2);
    const four x = load_four(motion->x_m) + dt_s * v;
    store_four(motion->v_mps, &v);
    store_four(motion->w_radps, &w);
    store_four(motion->x_m, &x);
    store_four(load->f_N, &zero);
    store_four(load->t_Nm, &zero);
    return x - load_four(reference_m);
}

// The same where velocities are in single precision.
INLINED four advance_one_single(const struct inertia *const inertia, const double kick_s,
                                const double dt_s, const double reference_m[4],
                                struct dig_single_motion *const motion,
                                struct dig_single_load *const   load)
{
    const eight_single zero = { 0.0F };
    const eight_single vw =
        load_eight(motion->v_mps) +
        (float)kick_s * (load_eight(load) * inertia->inverse_single + inertia->g_single);
    const four x = load_four(motion->x_m) + dt_s * (four){ vw[0], vw[1], vw[2], vw[3] };
    store_eight(motion->v_mps, &vw);
    store_eight(load, &zero);
    store_four(motion->x_m, &x);
    return x - load_four(reference_m);
}

INLINED four advance_one(const bool single, const struct inertia inertia[], const double kick_s,
                         const double dt_s, const double (*const reference_m)[4], const size_t i,
                         struct dig_single_load *const single_load, struct dig_grains *const grains)
{
    const struct inertia *const of = &inertia[grains->type_of[i]];
    return single ? advance_one_single(of, kick_s, dt_s, reference_m[i], &grains->single_motion[i],
                                       &single_load[i])
                  : advance_one_double(of, kick_s, dt_s, reference_m[i], &grains->motion[i],
                                       &grains->load[i]);
}

// Loads on grains first … end - 1 of a slab from the halo of the slab beside it.
INLINED void take_halo(const size_t first, const size_t end, struct dig_single_load *const beside,
                       struct dig_single_load *const own)
{
    const eight_single zero = { 0.0F };
    for (size_t i = first; i < end; i++) {
        const eight_single row = load_eight(&beside[i]);
        add_load(&own[i], &row);
        store_eight(&beside[i], &zero);
    }
}

// Whether any of four grains has left its margin.
INLINED four_index left_margin(const four d[4])
{
    four c[4];
    transpose_four(d, c);
    // Negated, so that a coordinate that is not a number counts as having left.
    return ~(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] <= c[3] * c[3]);
}

INLINED void find_inertia(const double gravity_mps2[3], const struct dig_grains *const grains,
                          struct inertia inertia[])
{
    const four g = { gravity_mps2[0], gravity_mps2[1], gravity_mps2[2], 0.0 };
    for (size_t k = 0; k < grains->types; k++) {
        const struct dig_grain_type type = grains->type[k];
        const double                kg   = type.driven ? 0.0 : 1.0 / type.mass_kg;
        const double                kgm2 = type.driven ? 0.0 : 1.0 / type.inertia_kgm2;
        inertia[k].g_mps2                = (type.driven ? 0.0 : 1.0) * g;
        inertia[k].inverse_kg            = kg;
        inertia[k].inverse_kgm2          = kgm2;
        for (int a = 0; a < 4; a++) {
            inertia[k].g_single[a]           = (float)inertia[k].g_mps2[a];
            inertia[k].g_single[4 + a]       = 0.0F;
            inertia[k].inverse_single[a]     = (float)kg;
            inertia[k].inverse_single[4 + a] = (float)kgm2;
        }
    }
}

INLINED bool advance_body(const bool single, const double gravity_mps2[3], const double kick_s,
                          const double dt_s, const double (*const reference_m)[4],
                          const size_t slab, struct dig_grains *const grains)
{
    struct inertia inertia[DIG_GRAIN_TYPES_MAX];
    find_inertia(gravity_mps2, grains, inertia);
    struct dig_single_load *const load  = dig_grains_slab_load(grains, slab);
    const size_t                  first = dig_grains_slab_first(grains, slab);
    const size_t                  end   = dig_grains_slab_first(grains, slab + 1);
    const size_t                  halo  = grains->slabs.halo;
    if (slab > 0) {
        const size_t last = first + halo < end ? first + halo : end;
        take_halo(first, last, dig_grains_slab_load(grains, slab - 1), load);
    }
    if (slab + 1 < grains->slabs.count) {
        take_halo(end - halo, end, dig_grains_slab_load(grains, slab + 1), load);
    }
    four_index left = { 0, 0, 0, 0 };
    size_t     k    = first;
    for (; k + 4 <= end; k += 4) {
        four d[4];
#pragma GCC unroll 4
        for (size_t l = 0; l < 4; l++) {
            d[l] = advance_one(single, inertia, kick_s, dt_s, reference_m, k + l, load, grains);
        }
        left |= left_margin(d);
    }
    four rest[4] = { { 0.0 }, { 0.0 }, { 0.0 }, { 0.0 } };
    for (size_t l = 0; k + l < end; l++) {
        rest[l] = advance_one(single, inertia, kick_s, dt_s, reference_m, k + l, load, grains);
    }
    left |= left_margin(rest);
    return (left[0] | left[1] | left[2] | left[3]) != 0;
}

// An attribute cannot stand in parentheses: NOLINTBEGIN(bugprone-macro-parentheses)
#define VARIANTS(attribute, suffix)                                                                \
    attribute static void block_##suffix(                                                          \
        const struct dig_law *const law, const double dt_s, const size_t count,                    \
        double *const histories[DIG_HISTORY_VALUES], struct dig_block *const block)                \
    {                                                                                              \
        if (law->general) {                                                                        \
            block_body(true, *law, dt_s, count, histories, block);                                 \
        } else {                                                                                   \
            block_body(false, *law, dt_s, count, histories, block);                                \
        }                                                                                          \
    }                                                                                              \
    attribute static void pairs_##suffix(const struct dig_law *const law, const double dt_s,       \
                                         const double period_m, struct dig_contacts *const list,   \
                                         const size_t slab, struct dig_grains *const grains)       \
    {                                                                                              \
        if (list->single) {                                                                        \
            pairs_single_body(law, dt_s, period_m, list, slab, grains);                            \
        } else if (law->general) {                                                                 \
            pairs_body(true, *law, dt_s, period_m, list, grains);                                  \
        } else {                                                                                   \
            pairs_body(false, *law, dt_s, period_m, list, grains);                                 \
        }                                                                                          \
    }                                                                                              \
    attribute static void walls_##suffix(const struct dig_law *const law, const double dt_s,       \
                                         const struct dig_wall      wall[],                        \
                                         struct dig_contacts *const list, const size_t slab,       \
                                         struct dig_grains *const grains, double on_walls_N[3])    \
    {                                                                                              \
        four sum_N = { on_walls_N[0], on_walls_N[1], on_walls_N[2], 0.0 };                         \
        if (list->single) {                                                                        \
            walls_single_body(law, dt_s, wall, list, slab, grains, &sum_N);                        \
        } else if (law->general) {                                                                 \
            walls_body(true, *law, dt_s, wall, list, grains, &sum_N);                              \
        } else {                                                                                   \
            walls_body(false, *law, dt_s, wall, list, grains, &sum_N);                             \
        }                                                                                          \
        for (int k = 0; k < 3; k++) {                                                              \
            on_walls_N[k] = sum_N[k];                                                              \
        }                                                                                          \
    }                                                                                              \
    attribute static bool advance_##suffix(const double gravity_mps2[3], const double kick_s,      \
                                           const double dt_s, const double(*const reference_m)[4], \
                                           const size_t slab, struct dig_grains *const grains)     \
    {                                                                                              \
        return grains->in_single                                                                   \
                   ? advance_body(true, gravity_mps2, kick_s, dt_s, reference_m, slab, grains)     \
                   : advance_body(false, gravity_mps2, kick_s, dt_s, reference_m, slab, grains);   \
    }

// NOLINTEND(bugprone-macro-parentheses)
VARIANTS(, base)

// The variant of a function for an instruction set.
#ifdef VARIANT_AVX2
VARIANTS(VARIANT_AVX2, avx2)
VARIANTS(VARIANT_AVX512, avx512)
#define CALL(isa, name, ...)                                                                       \
    ((isa) == DIG_ISA_AVX512 ? name##_avx512(__VA_ARGS__)                                          \
     : (isa) == DIG_ISA_AVX2 ? name##_avx2(__VA_ARGS__)                                            \
                             : name##_base(__VA_ARGS__))
#else
#define CALL(isa, name, ...) ((void)(isa), name##_base(__VA_ARGS__))
#endif

// Works on a copy of the histories: the law clears the lanes that pad a block, and in the list
// these are other contacts.
void dig_kernel_block(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      struct dig_contacts *const list, const size_t first, const size_t count,
                      struct dig_block *const block)
{
    double  copy[DIG_HISTORY_VALUES][DIG_BLOCK] = { { 0.0 } };
    double *histories[DIG_HISTORY_VALUES];
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        histories[m] = copy[m];
        memcpy(copy[m], list->history[m] + first, count * sizeof(double));
    }
    CALL(isa, block, law, dt_s, count, histories, block);
    for (int m = 0; m < DIG_HISTORY_VALUES; m++) {
        memcpy(list->history[m] + first, copy[m], count * sizeof(double));
    }
}

void dig_kernel_pairs(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const double period_y_m, struct dig_contacts *const list, const size_t slab,
                      struct dig_grains *const grains)
{
    CALL(isa, pairs, law, dt_s, period_y_m, list, slab, grains);
}

void dig_kernel_walls(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const struct dig_wall wall[], struct dig_contacts *const list,
                      const size_t slab, struct dig_grains *const grains, double on_walls_N[3])
{
    CALL(isa, walls, law, dt_s, wall, list, slab, grains, on_walls_N);
}

bool dig_kernel_advance(const enum dig_isa isa, const double gravity_mps2[3], const double kick_s,
                        const double dt_s, const double reference_m[][4], const size_t slab,
                        struct dig_grains *const grains)
{
    return CALL(isa, advance, gravity_mps2, kick_s, dt_s, reference_m, slab, grains);
}
