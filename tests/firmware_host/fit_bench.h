// A matcher on a table of eight gravels, the corners of a cube, whose curves differ by a factor;
// only simpleA has curves unless said otherwise.

#ifndef DIG_TESTS_FIT_BENCH_H
#define DIG_TESTS_FIT_BENCH_H

#include "firmware_host/matching/fit.h"
#include "tests/cube_table.h"
#include "tests/testlib.h"
#include "tests/wires.h"

#include <stdlib.h>
#include <string.h>

#define GRAVELS      CUBE_GRAVELS
#define TRAJECTORIES 2

struct bench {
    struct dig_config      config;
    struct cube_table      cube;
    struct wires           wires;
    struct dig_early_match early;
    struct dig_fit         fit;
};

static inline double bench_moment_Nm(const int gravel, const int point)
{
    const double p = point / (double)(DIG_CURVE_POINTS - 1);
    return p * (1.0 - p) * (1.0 + (gravel / 4) + 0.5 * (gravel / 2 % 2) * p + 0.25 * (gravel % 2));
}

/// Free with free().
static inline struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    struct dig_curve_set *const set = &b->cube.set;
    set->tooth_m                    = 0.09;
    set->bucket_width_m             = 0.07;
    set->smooth_half_s              = DIG_SMOOTH_HALF_s;
    set->trajectories               = TRAJECTORIES;
    (void)strcpy(set->scene_hash,
                 "9a66b75d3dbf255ea79c13c1c43a401f089ead1b9d22f68b09cfd554af26f411");
    (void)strcpy(set->trajectory[0].name, "simpleA");
    (void)strcpy(set->trajectory[1].name, "actual");
    for (int t = 0; t < TRAJECTORIES; t++) {
        set->trajectory[t].phases   = 1;
        set->trajectory[t].phase[0] = (struct dig_phase){ .duration_s = 2.0, .vx_mps = 0.05 };
    }
    cube_table_init(&b->cube);
    for (int g = 0; g < GRAVELS; g++) {
        b->cube.packings[g * TRAJECTORIES] = 3;
        for (int p = 0; p < DIG_CURVE_POINTS; p++) {
            b->cube.curve[g * TRAJECTORIES].mean[DIG_CHANNEL_MY_Nm][p] =
                (float)bench_moment_Nm(g, p);
            b->cube.curve[g * TRAJECTORIES].sd[DIG_CHANNEL_MY_Nm][p] = 0.01F;
        }
    }
    dig_outlines_draw(set);
    b->config = wires_config();
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, set, &b->early, &b->fit);
    return b;
}

/// One whose actual has the curves of simpleA.
static inline struct bench *bench_of_two_digs(void)
{
    struct bench *const b = bench_create();
    for (int g = 0; g < GRAVELS; g++) {
        b->cube.packings[g * TRAJECTORIES + 1] = 3;
        b->cube.curve[g * TRAJECTORIES + 1]    = b->cube.curve[g * TRAJECTORIES];
    }
    dig_outlines_draw(&b->cube.set);
    return b;
}

/// A simple dig in one of the gravels, its moment times a factor.
static inline struct dig_observation bench_observation(const int gravel, const double factor)
{
    struct dig_observation dig = { .dig_count = 5, .trajectory = 0, .first = 0.0, .last = 1.0 };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = factor * bench_moment_Nm(gravel, p);
        dig.sigma_Nm[p]  = 0.005;
    }
    return dig;
}

/// The matcher takes such a dig, along one of the trajectories.
static inline void bench_dig(struct bench *const b, const int gravel, const int trajectory,
                             const double factor)
{
    struct dig_observation dig = bench_observation(gravel, factor);
    dig.trajectory             = trajectory;
    dig_fit_take(&b->fit, &dig);
}

#endif // DIG_TESTS_FIT_BENCH_H
