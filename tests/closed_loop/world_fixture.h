// The made world, and the soil of its effects, for all the tests of a program:
//   TESTS_WITH(world_setup, world_teardown)

#ifndef DIG_TESTS_WORLD_FIXTURE_H
#define DIG_TESTS_WORLD_FIXTURE_H

#include "closed_loop/fit/hypothesis.h"
#include "core/chance.h"
#include "tests/made_campaign.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct made_world world;
static struct dig_soil  *soil;

static inline int world_setup(void **state)
{
    (void)state;
    world = made_world(5);
    return dig_soil_create(world.surface, world.effects, world.scatter, &soil);
}

static inline int world_teardown(void **state)
{
    (void)state;
    free(soil);
    made_world_finish(&world);
    return 0;
}

// Digs of a gravel with these effects, a simple and a real one in turn.
static inline void dig_in_turn(const size_t digs, const struct dig_gravel *const gravel,
                               const size_t effects, const enum dig_effect_id effect[],
                               const double magnitude[], uint64_t *const seed,
                               struct dig_measured measured[])
{
    for (size_t i = 0; i < digs; i++) {
        measured[i] = made_dig(gravel, i % 2 == 0 ? MADE_SIMPLE_A : MADE_ACTUAL, effects, effect,
                               magnitude, seed);
        measured[i].order = i;
    }
}

// Adds noise to a dig's rows, 5 ms apart, so much of each channel's rms, before the smoothing, that
// lasts so long (0: white).
static inline void dig_add_noise(const double share, const double memory_s, uint64_t *const seed,
                                 struct dig_measured *const dig)
{
    enum { ROWS_MAX = 4096 };
    static double                      t_s[ROWS_MAX], noise[ROWS_MAX], smooth[ROWS_MAX];
    const struct dig_trajectory *const t = &world.set->trajectory[dig->trajectory];

    const double half_s   = world.set->smooth_half_s;
    const double kept     = memory_s > 0.0 ? exp(-0.005 / memory_s) : 0.0;
    const size_t rows     = (size_t)(dig_trajectory_duration_s(t) / 0.005) + 1;
    dig->lasting.memory_s = memory_s;
    assert_true(rows <= ROWS_MAX);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double square = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            square += dig->value[c][k] * dig->value[c][k] / DIG_CURVE_POINTS;
        }
        double off = dig_chance_normal(seed);
        for (size_t i = 0; i < rows; i++) {
            t_s[i]   = 0.005 * (double)i;
            noise[i] = share * sqrt(square) * off;
            off      = kept * off + sqrt(1.0 - kept * kept) * dig_chance_normal(seed);
        }
        dig->lasting.sigma[c] = memory_s > 0.0 ? share * sqrt(square) : 0.0;
        dig_curve_smooth(rows, t_s, noise, half_s, smooth);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double at_s =
                dig_trajectory_time_s(t, world.set->tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
            const size_t row = (size_t)fmin(at_s / 0.005, (double)rows - 1.0);
            dig->value[c][k] += smooth[row];
            dig->sigma[c][k] =
                memory_s > 0.0 ? 0.0 : share * sqrt(square) * sqrt(0.005 / (2.0 * half_s));
        }
    }
}

// The batch of all these digs, thought to be of this gravel (NULL: not known).
static inline void batch_digs(const size_t digs, const struct dig_measured measured[],
                              const struct dig_gravel *const gravel, struct dig_batch *const batch)
{
    bool   take[DIG_MEASURED_MAX];
    double place[DIG_AXES];
    memset(take, true, sizeof take);
    if (gravel != NULL) {
        dig_response_surface_place(world.surface, gravel, place);
    }
    assert_int_equal(dig_batch_make(soil, world.scatter, digs, measured, take,
                                    gravel != NULL ? place : NULL, batch),
                     DIG_OK);
}

// The plain gravel that suits a batch best.
static inline struct dig_fitted fit_plain(const struct dig_batch *const batch)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_fitted                  fitted;
    dig_hypothesis_fit(batch, &none, middle, DIG_FIT_THOROUGH, &fitted);
    return fitted;
}

#endif // DIG_TESTS_WORLD_FIXTURE_H
