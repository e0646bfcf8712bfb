// The made world, and the soil of its effects, for all the tests of a program:
//   TESTS_WITH(world_setup, world_teardown)

#ifndef DIG_TESTS_WORLD_FIXTURE_H
#define DIG_TESTS_WORLD_FIXTURE_H

#include "closed_loop/fit/whitened_digs.h"
#include "tests/made_campaign.h"
#include "tests/testlib.h"

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

// The batch of all these digs, thought to be of this gravel (NULL: not known).
static inline void batch_digs(const size_t digs, const struct dig_measured measured[],
                              const struct dig_gravel *const  gravel,
                              struct dig_whitened_digs *const batch)
{
    bool   take[DIG_MEASURED_MAX];
    double place[DIG_AXES];
    memset(take, true, sizeof take);
    if (gravel != NULL) {
        dig_response_surface_place(world.surface, gravel, place);
    }
    assert_int_equal(dig_whitened_digs_make(soil, world.scatter, digs, measured, take,
                                            gravel != NULL ? place : NULL, batch),
                     DIG_OK);
}

#endif // DIG_TESTS_WORLD_FIXTURE_H
