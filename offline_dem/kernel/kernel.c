#include "offline_dem/kernel/kernel.h"

#include "offline_dem/kernel/rows.h"
#include "offline_dem/kernel/stages.h"
#include "offline_dem/kernel/wall_rows.h"
#include "offline_dem/law/period.h"

#include <stdint.h>
#include <string.h>

#if defined(__x86_64__) && defined(__GNUC__)
#define VARIANT_AVX2 __attribute__((target("avx2")))
// GCC prefers half vectors where full ones might lower the clock; clang has no such option.
#ifdef __clang__
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
#else
#define VARIANT_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
#endif
#else
#define VARIANT_AVX2
#define VARIANT_AVX512
#endif

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

INLINED void pairs_body(const bool wide, const bool general, const struct dig_law law,
                        const double dt_s, const double period_m, struct dig_contacts *const list,
                        struct dig_grains *const grains)
{
    if (list->n == 0) {
        return;
    }
    // Cleared once a list: the analyzer does not see that every stage fills the operands of the
    // next.
    struct dig_block block;
    memset(&block, 0, sizeof block);
    double *histories[DIG_HISTORY_VALUES] = { NULL };
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t left  = list->n - first;
        const size_t count = left < DIG_BLOCK ? left : DIG_BLOCK;
        gather(wide, list, grains->motion, first, count, &block);
        if (period_m > 0.0) {
            fold(period_m, count, block.in[1]);
        }
        find_histories(list, first, histories);
        block_body(general, law, dt_s, count, histories, &block);
        scatter(wide, list, &block, first, count, grains->load);
    }
}

INLINED void walls_body(const bool general, const struct dig_law law, const double dt_s,
                        const struct dig_wall wall[], struct dig_contacts *const list,
                        struct dig_grains *const grains, double on_walls_N[3])
{
    if (list->n == 0) {
        return;
    }
    // Cleared once a list: the analyzer does not see that every stage fills the operands of the
    // next.
    struct dig_block block;
    memset(&block, 0, sizeof block);
    double *histories[DIG_HISTORY_VALUES] = { NULL };
    four    sum_N                         = { on_walls_N[0], on_walls_N[1], on_walls_N[2], 0.0 };
    for (size_t first = 0; first < list->n; first += DIG_BLOCK) {
        const size_t left  = list->n - first;
        const size_t count = left < DIG_BLOCK ? left : DIG_BLOCK;
        // The law's reach is the grain's radius.
        gather_walls(list, wall, law.reach_m, grains->motion, first, count, &block);
        find_histories(list, first, histories);
        block_body(general, law, dt_s, count, histories, &block);
        scatter_walls(list, &block, first, count, grains->load, &sum_N);
    }
    for (int k = 0; k < 3; k++) {
        on_walls_N[k] = sum_N[k];
    }
}

// Response of a type's velocities: gravity and the inverse inertia. Zeros where a body drives the
// grains.
struct inertia {
    four   g_mps2;
    double inverse_kg, inverse_kgm2;
};

// One grain over one step. Returns its displacement since the lists were made, and in the fourth
// lane its negated margin.
INLINED four advance_one(const struct inertia *const inertia, const double kick_s,
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

// Whether any of four grains has left its margin.
INLINED four_index left_margin(const four d[4])
{
    four c[4];
    transpose_four(d, c);
    // Negated, so that a coordinate that is not a number counts as having left.
    return ~(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] <= c[3] * c[3]);
}

INLINED bool advance_body(const double gravity_mps2[3], const double kick_s, const double dt_s,
                          const double (*const reference_m)[4], struct dig_grains *const grains)
{
    const four     g = { gravity_mps2[0], gravity_mps2[1], gravity_mps2[2], 0.0 };
    struct inertia inertia[DIG_GRAIN_TYPES_MAX];
    for (size_t k = 0; k < grains->types; k++) {
        const struct dig_grain_type type = grains->type[k];
        inertia[k].g_mps2                = (type.driven ? 0.0 : 1.0) * g;
        inertia[k].inverse_kg            = type.driven ? 0.0 : 1.0 / type.mass_kg;
        inertia[k].inverse_kgm2          = type.driven ? 0.0 : 1.0 / type.inertia_kgm2;
    }
    four_index   left = { 0, 0, 0, 0 };
    const size_t n    = grains->n;
    size_t       k    = 0;
    for (; k + 4 <= n; k += 4) {
        four d[4];
#pragma GCC unroll 4
        for (size_t l = 0; l < 4; l++) {
            const size_t i = k + l;
            d[l]           = advance_one(&inertia[grains->type_of[i]], kick_s, dt_s, reference_m[i],
                                         &grains->motion[i], &grains->load[i]);
        }
        left |= left_margin(d);
    }
    four rest[4] = { { 0.0 }, { 0.0 }, { 0.0 }, { 0.0 } };
    for (size_t l = 0; k + l < n; l++) {
        const size_t i = k + l;
        rest[l]        = advance_one(&inertia[grains->type_of[i]], kick_s, dt_s, reference_m[i],
                                     &grains->motion[i], &grains->load[i]);
    }
    left |= left_margin(rest);
    return (left[0] | left[1] | left[2] | left[3]) != 0;
}

// An attribute cannot stand in parentheses: NOLINTBEGIN(bugprone-macro-parentheses)
#define VARIANTS(attribute, wide, suffix)                                                          \
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
                                         struct dig_grains *const grains)                          \
    {                                                                                              \
        if (law->general) {                                                                        \
            pairs_body(wide, true, *law, dt_s, period_m, list, grains);                            \
        } else {                                                                                   \
            pairs_body(wide, false, *law, dt_s, period_m, list, grains);                           \
        }                                                                                          \
    }                                                                                              \
    attribute static void walls_##suffix(                                                          \
        const struct dig_law *const law, const double dt_s, const struct dig_wall wall[],          \
        struct dig_contacts *const list, struct dig_grains *const grains, double on_walls_N[3])    \
    {                                                                                              \
        if (law->general) {                                                                        \
            walls_body(true, *law, dt_s, wall, list, grains, on_walls_N);                          \
        } else {                                                                                   \
            walls_body(false, *law, dt_s, wall, list, grains, on_walls_N);                         \
        }                                                                                          \
    }                                                                                              \
    attribute static bool advance_##suffix(const double gravity_mps2[3], const double kick_s,      \
                                           const double dt_s, const double(*const reference_m)[4], \
                                           struct dig_grains *const grains)                        \
    {                                                                                              \
        return advance_body(gravity_mps2, kick_s, dt_s, reference_m, grains);                      \
    }

// NOLINTEND(bugprone-macro-parentheses)
VARIANTS(, false, base)
VARIANTS(VARIANT_AVX2, false, avx2)
VARIANTS(VARIANT_AVX512, true, avx512)

// The variant of a function for an instruction set.
#define CALL(isa, name, ...)                                                                       \
    ((isa) == DIG_ISA_AVX512 ? name##_avx512(__VA_ARGS__)                                          \
     : (isa) == DIG_ISA_AVX2 ? name##_avx2(__VA_ARGS__)                                            \
                             : name##_base(__VA_ARGS__))

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
                      const double period_y_m, struct dig_contacts *const list,
                      struct dig_grains *const grains)
{
    CALL(isa, pairs, law, dt_s, period_y_m, list, grains);
}

void dig_kernel_walls(const enum dig_isa isa, const struct dig_law *const law, const double dt_s,
                      const struct dig_wall wall[], struct dig_contacts *const list,
                      struct dig_grains *const grains, double on_walls_N[3])
{
    CALL(isa, walls, law, dt_s, wall, list, grains, on_walls_N);
}

bool dig_kernel_advance(const enum dig_isa isa, const double gravity_mps2[3], const double kick_s,
                        const double dt_s, const double reference_m[][4],
                        struct dig_grains *const grains)
{
    return CALL(isa, advance, gravity_mps2, kick_s, dt_s, reference_m, grains);
}
