// Grains over one step: their velocities, their places, and whether one has left the margin of the
// lists. Inlined into the variants of kernel.c.

#ifndef DIG_OFFLINE_DEM_KERNEL_ADVANCE_H
#define DIG_OFFLINE_DEM_KERNEL_ADVANCE_H

#include "offline_dem/kernel/rows_single.h"

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

#endif // DIG_OFFLINE_DEM_KERNEL_ADVANCE_H
