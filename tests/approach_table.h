// A table whose curves are a known function of gravel, depth and attack, dug at a cross or a
// product of them: eight gravels, the rig's simpleA and actual.

#ifndef DIG_TESTS_APPROACH_TABLE_H
#define DIG_TESTS_APPROACH_TABLE_H

#include "core/entry_set.h"
#include "core/units.h"
#include "tests/cube_table.h"
#include "tests/made_table.h"
#include "tests/testlib.h"

#include <math.h>
#include <string.h>

#define APPROACH_WAYS 8
#define APPROACH_m    0.0261366 // depth of simpleA: .6 s at .0435611 m/s from the ground on

struct approach_table {
    struct cube_table    cube;
    struct dig_entry_set others;
    struct dig_entry     entry[CUBE_GRAVELS * APPROACH_WAYS];
    int                  packings[CUBE_GRAVELS * APPROACH_WAYS * 2];
    struct dig_curve     curve[CUBE_GRAVELS * APPROACH_WAYS * 2];
};

/// How much gravel g resists.
static inline double approach_strength(const size_t g)
{
    return 1.0 + 0.3 * (double)g;
}

static inline double approach_moment_Nm(const size_t g, const size_t t, const double time_s,
                                        const double factor)
{
    const double whole_s = t == 0 ? 3.0 : 6.8;
    return approach_strength(g) * factor * sin(DIG_PI * time_s / whole_s) *
           (1.0 + 0.1 * sin(9.0 * time_s / whole_s + (double)g));
}

/// How a deeper dig, or one with the bucket turned, resists beside the plain one: as the square of
/// the depth, and less with the attack.
static inline double approach_growing(const double depth, const double attack_rad)
{
    return depth * depth - 1.5 * attack_rad;
}

static inline void approach_curve(const size_t g, const size_t t, const struct dig_trajectory *dug,
                                  const double factor, const double relative_sd,
                                  struct dig_curve *const curve)
{
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at_s = dig_trajectory_time_s(dug, 0.09, (double)k / (DIG_CURVE_POINTS - 1));
        const double my   = approach_moment_Nm(g, t, at_s, factor);
        for (int c = 0; c < DIG_CHANNELS; c++) {
            curve->mean[c][k] = (float)(my * (1.0 + c));
            curve->sd[c][k] =
                (float)(relative_sd * factor * approach_strength(g) * 0.7 * (1.0 + c));
        }
    }
}

static inline struct dig_trajectory approach_dug(const size_t t, const struct dig_approach approach)
{
    const struct dig_trajectory plain = made_trajectory(t == 0 ? MADE_SIMPLE_A : MADE_ACTUAL);
    struct dig_trajectory       dug   = plain;
    if (dig_approach_apply(&plain, 0.09, APPROACH_m, &approach, &dug, NULL) != DIG_OK) {
        fail_msg("no such approach");
    }
    return dug;
}

/// The first `gravels` are dug in all the ways, the others plainly alone.
static inline void approach_table_init(struct approach_table *const table, const size_t gravels,
                                       const size_t ways, const struct dig_approach way[],
                                       double (*const factor)(double depth, double attack_rad),
                                       const double relative_sd, const int packings)
{
    struct dig_curve_set *const set = &table->cube.set;
    memset(table, 0, sizeof *table);
    cube_table_init(&table->cube);
    set->tooth_m       = 0.09;
    set->smooth_half_s = 0.16;
    set->trajectories  = 2;
    set->approaches    = &table->others;
    table->others      = (struct dig_entry_set){ .trajectories = 2,
                                                 .depth_m      = { APPROACH_m, APPROACH_m },
                                                 .entries      = gravels * ways,
                                                 .entry        = table->entry,
                                                 .packings     = table->packings,
                                                 .curve        = table->curve };
    for (size_t g = 0; g < CUBE_GRAVELS; g++) {
        for (size_t t = 0; t < 2; t++) {
            set->trajectory[t]              = approach_dug(t, dig_approach_plain());
            table->cube.packings[2 * g + t] = packings;
            approach_curve(g, t, &set->trajectory[t], factor(1.0, 0.0), relative_sd,
                           &table->cube.curve[2 * g + t]);
        }
        for (size_t w = 0; g < gravels && w < ways; w++) {
            const size_t i  = g * ways + w;
            table->entry[i] = (struct dig_entry){ .gravel   = table->cube.gravel[g],
                                                  .approach = way[w],
                                                  .effect   = DIG_EFFECTS };
            for (size_t t = 0; t < 2; t++) {
                const struct dig_trajectory dug = approach_dug(t, way[w]);
                table->packings[2 * i + t]      = packings;
                approach_curve(g, t, &dug, factor(way[w].depth, way[w].attack_rad), relative_sd,
                               &table->curve[2 * i + t]);
            }
        }
    }
    dig_outlines_draw(set);
}

#endif // DIG_TESTS_APPROACH_TABLE_H
