// Threads that share a step: every member works once a call, and a large bed moves bit for bit
// alike on any number of them.

#include "core/chance.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/offloaded.h"
#include "tests/dem_fixture.h"
#include "tests/offline_dem/host_device.h"

#include <stdatomic.h>
#include <stdlib.h>

#define ACROSS 18
#define LONG   110 // three slabs (kernel/grains.c)
#define MANY   ((size_t)ACROSS * ACROSS * LONG)

static atomic_size_t worked[5];

static void count(void *const context, const size_t member)
{
    (void)context;
    atomic_fetch_add(&worked[member], 1);
}

TEST(every_member_works_once_a_call)
{
    struct dig_crew *crew = NULL;
    dig_crew_run(NULL, count, NULL);
    assert_int_equal(atomic_load(&worked[0]), 1);
    assert_int_equal(dig_crew_members(NULL), 1);
    assert_int_equal(dig_crew_create(5, &crew), DIG_OK);
    assert_int_equal(dig_crew_members(crew), 5);
    for (size_t k = 1; k <= (test_is_quick() ? 300 : 3000); k++) {
        dig_crew_run(crew, count, NULL);
        for (size_t m = 0; m < 5; m++) {
            assert_int_equal(atomic_load(&worked[m]), k + (m == 0));
        }
    }
    dig_crew_destroy(crew);
    dig_crew_destroy(NULL);
}

// A long bar of grains that touch, and shake.
static struct dig_world make_bar(void)
{
    uint64_t random     = 3;
    double(*const x)[3] = malloc(MANY * sizeof *x);
    assert_non_null(x);
    for (size_t i = 0; i < MANY; i++) {
        const size_t at[3] = { i / ACROSS / ACROSS, i % ACROSS, i / ACROSS % ACROSS };
        for (size_t k = 0; k < 3; k++) {
            x[i][k] =
                2.0 * GRAIN_m * (double)at[k] + dig_chance_between(&random, -0.02, 0.02) * GRAIN_m;
        }
    }
    struct dig_world world = dem_world(MANY, (const double(*)[3])x, dem_material(0.5, 0.3));
    free(x);
    for (size_t i = 0; i < MANY; i++) {
        for (size_t k = 0; k < 3; k++) {
            world.grains.motion[i].v_mps[k]   = dig_chance_between(&random, -0.2, 0.2);
            world.grains.motion[i].w_radps[k] = dig_chance_between(&random, -20.0, 20.0);
        }
    }
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    return world;
}

TEST(a_large_bed_moves_alike_on_any_number_of_threads)
{
    const size_t     steps = test_is_quick() ? 60 : 120;
    struct dig_world alone = make_bar();
    alone.single           = true;
    dem_run(&alone, steps);
    assert_true(alone.grains.slabs.count >= 2 && alone.list_rebuilds > 1);
    assert_int_equal(dig_world_sync_motion(&alone), DIG_OK);
    for (size_t threads = test_is_quick() ? 5 : 2; threads <= 5; threads++) {
        struct dig_world shared = make_bar();
        shared.single           = true;
        assert_int_equal(dig_crew_create(threads, &shared.crew), DIG_OK);
        dem_run(&shared, steps);
        assert_int_equal(dig_world_sync_motion(&shared), DIG_OK);
        assert_memory_equal(alone.grains.id, shared.grains.id, MANY * sizeof *alone.grains.id);
        assert_memory_equal(alone.grains.motion, shared.grains.motion,
                            MANY * sizeof *alone.grains.motion);
        assert_memory_equal(&alone.on_walls, &shared.on_walls, sizeof alone.on_walls);
        dig_crew_destroy(shared.crew);
        dig_world_finish(&shared);
    }
    dig_world_finish(&alone);
}

// The crew shares the copies to and from a device.
TEST(a_bed_on_a_device_moves_alike_on_any_number_of_threads)
{
    const size_t     steps    = test_is_quick() ? 2 : 10;
    struct dig_world world[2] = { make_bar(), make_bar() };
    for (size_t k = 0; k < 2; k++) {
        world[k].wall[0].offset_m = -0.99 * GRAIN_m; // where it throws no grain out of its margin
        if (k > 0) {
            assert_int_equal(dig_crew_create(3, &world[k].crew), DIG_OK);
        }
        assert_int_equal(dem_host_take_over(&world[k], NULL), DIG_OK);
        dem_run(&world[k], steps);
        dig_world_mark_stale(&world[k]);
        dem_run(&world[k], steps);
        assert_int_equal(dig_world_sync(&world[k]), DIG_OK);
    }
    assert_true(world[0].pair[0].n > MANY / 2 && world[0].surface[0].n > ACROSS);
    assert_int_equal(world[0].pair[0].n, world[1].pair[0].n);
    assert_memory_equal(world[0].pair[0].j, world[1].pair[0].j,
                        world[0].pair[0].n * sizeof *world[0].pair[0].j);
    assert_memory_equal(world[0].pair[0].history[0], world[1].pair[0].history[0],
                        world[0].pair[0].n * sizeof *world[0].pair[0].history[0]);
    assert_memory_equal(world[0].grains.motion, world[1].grains.motion,
                        MANY * sizeof *world[0].grains.motion);
    dig_crew_destroy(world[1].crew);
    for (size_t k = 0; k < 2; k++) {
        dig_world_finish(&world[k]);
    }
}

// In double precision a bed has no slabs: no contact is lost or counted twice between them.
TEST(slabs_lose_no_contact)
{
    struct dig_world split = make_bar();
    struct dig_world whole = make_bar();
    split.single           = true;
    dem_run(&split, test_is_quick() ? 10 : 60);
    dem_run(&whole, test_is_quick() ? 10 : 60);
    assert_true(split.grains.slabs.count >= 2 && whole.grains.slabs.count == 1);
    assert_int_equal(dig_world_sync_motion(&split), DIG_OK);
    static size_t place[MANY]; // in whole, by id: each sorts along cells of its own
    double        most_m  = 0.0;
    double        moved_m = 0.0;
    for (size_t i = 0; i < MANY; i++) {
        place[whole.grains.id[i]] = i;
    }
    for (size_t i = 0; i < MANY; i++) {
        for (size_t k = 0; k < 3; k++) {
            const double a_m = split.grains.motion[i].x_m[k];
            const double b_m = whole.grains.motion[place[split.grains.id[i]]].x_m[k];
            most_m           = fmax(most_m, fabs(a_m - b_m));
            moved_m          = fmax(moved_m, fabs(split.grains.motion[i].v_mps[k]));
        }
    }
    assert_true(most_m < 1e-7 * GRAIN_m / 1e-3);
    assert_true(moved_m > 0.1);
    dig_world_finish(&split);
    dig_world_finish(&whole);
}

// A bed of one slab would have the others wait for it, turning in place.
TEST(a_small_bed_is_not_shared)
{
    const struct dig_stepper stepper = { .single_precision = true, .threads = 2 };
    struct dig_world         world   = { .crew = NULL };
    world.grains.n                   = 15000;
    assert_int_equal(dig_setup_stepper(&stepper, &world, NULL), DIG_OK);
    assert_null(world.crew);
    world.grains.n = 40000;
    assert_int_equal(dig_setup_stepper(&stepper, &world, NULL), DIG_OK);
    assert_non_null(world.crew);
    dig_crew_destroy(world.crew);
}
