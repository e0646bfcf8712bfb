// The made world, and the soil of its effects, for all the tests of a program:
//   TESTS_WITH(world_setup, world_teardown)

#ifndef DIG_TESTS_WORLD_FIXTURE_H
#define DIG_TESTS_WORLD_FIXTURE_H

#include "closed_loop/model/soil.h"
#include "tests/made_campaign.h"
#include "tests/testlib.h"

#include <stdlib.h>

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

#endif // DIG_TESTS_WORLD_FIXTURE_H
