#include "offline_dem/kernel/kernel.h"

#include "offline_dem/kernel/advance.h"
#include "offline_dem/kernel/block.h"
#include "offline_dem/kernel/near_search.h"
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
        find_pair_normals(law, period_m, contacts.count, &block);
        find_forces(law, dt_s, &contacts, &block);
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
        find_forces(law, dt_s, &contacts, &block);
        scatter_walls_single(&contacts, &block, load, sum_N);
        end_block(&contacts, first, list);
    }
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
    }                                                                                              \
    attribute static size_t near_##suffix(                                                         \
        const struct dig_near_query *const query, const struct dig_near_grains *const in,          \
        const size_t rows, const struct dig_near_row row[], uint32_t other[])                      \
    {                                                                                              \
        return near_body(query, in, rows, row, other);                                             \
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

size_t dig_kernel_near(const enum dig_isa isa, const struct dig_near_query *const query,
                       const struct dig_near_grains *const in, const size_t rows,
                       const struct dig_near_row row[], uint32_t other[])
{
    return CALL(isa, near, query, in, rows, row, other);
}
