// Digs of random gravels of a made table, with forces of their own noise.

#ifndef DIG_TESTS_RANDOM_DIG_H
#define DIG_TESTS_RANDOM_DIG_H

#include "tests/made_table.h"
#include "tests/model_front.h"

#include <math.h>

static inline struct dig_gravel random_gravel_of(uint64_t *const seed, const double density_kgpm3)
{
    return (struct dig_gravel){ { 0.3 + 0.6 * model_uniform(seed), 0.1 + 0.9 * model_uniform(seed),
                                  density_kgpm3 } };
}

/// As likely as any in the made table.
static inline struct dig_gravel random_gravel(uint64_t *const seed)
{
    struct dig_gravel gravel = random_gravel_of(seed, 1500.0);
    gravel.value[DIG_AXIS_DENSITY_kgpm3] *= pow(4000.0 / 1500.0, model_uniform(seed));
    return gravel;
}

/// Forces are as the table has them, -8 and 5 times the moment, with errors of their own.
static inline struct dig_observation make_dig(const struct dig_gravel *const gravel,
                                              const enum made_trajectory along, const bool forces,
                                              uint64_t *const seed)
{
    struct dig_observation o = made_observation(gravel, along, 0.0);
    made_disturb(&o, 0.1, seed);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        o.sigma_Nm[k]         = 0.01 * model_uniform(seed);
        o.force_N[0][k]       = -8.0 * o.moment_Nm[k] + 0.1 * model_normal(seed);
        o.force_N[1][k]       = 5.0 * o.moment_Nm[k] + 0.1 * model_normal(seed);
        o.force_sigma_N[0][k] = 0.05 + 0.1 * model_uniform(seed);
        o.force_sigma_N[1][k] = 0.05 + 0.1 * model_uniform(seed);
    }
    o.forces = forces;
    return o;
}

#endif // DIG_TESTS_RANDOM_DIG_H
