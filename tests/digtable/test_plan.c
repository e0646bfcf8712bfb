// Tests for tools/digtable/plan.c: what is read, and the hash that tells plans apart.

#include "tools/digtable/plan.h"

#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

static const char scene_path[] = "tests/data/formats/scene.yaml";
static const char grid_path[]  = "tests/data/formats/grid.yaml"; // 6 points, 2 packings

static struct dig_scene        scene;
static struct dig_plan         plan;
static struct dig_plan_point  *point;
static const struct dig_engine engine = { .name = "kernel", .version = "1" };

static int read_plan(void **state)
{
    (void)state;
    return dig_plan_read(scene_path, grid_path, 0, &scene, &plan, &point, NULL) == DIG_OK ? 0 : -1;
}

static int forget_plan(void **state)
{
    (void)state;
    free(point);
    return 0;
}

TEST(a_plan_is_the_grids_points_in_the_scenes_trajectories)
{
    assert_int_equal(plan.points, 6);
    assert_int_equal(plan.trajectories, 1);
    assert_int_equal(plan.point[5].packings, 2);
    assert_int_equal(plan.shards, 0);
}

TEST(what_cannot_be_read_writes_nothing)
{
    struct dig_plan        before = plan;
    struct dig_plan_point *kept   = point;
    struct dig_error       error  = { "" };
    assert_int_not_equal(dig_plan_read("no.yaml", grid_path, 0, &scene, &plan, &point, &error),
                         DIG_OK);
    assert_contains(error.text, "no.yaml");
    assert_int_not_equal(dig_plan_read(scene_path, scene_path, 0, &scene, &plan, &point, &error),
                         DIG_OK);
    assert_memory_equal(&plan, &before, sizeof plan);
    assert_ptr_equal(point, kept);
}

// Each change but the last makes other runs, or the same in other shards.
TEST(plans_of_other_digs_have_other_hashes)
{
    enum { CHANGES = 10 };
    char hash[CHANGES + 1][65];
    for (int change = 0; change <= CHANGES; change++) {
        struct dig_scene      s = scene;
        struct dig_engine     e = engine;
        struct dig_plan       p = plan;
        struct dig_plan_point points[6];
        memcpy(points, plan.point, sizeof points);
        p.point = points;
        switch (change) {
        case 1: s.material.young_Pa *= 2.0; break;
        case 2: e.name = "ode"; break;
        case 3: e.version = "2"; break;
        case 4: points[3].packings++; break;
        case 5: p.points--; break;
        case 6: points[0] = plan.point[1], points[1] = plan.point[0]; break;
        case 7: points[2].gravel.value[DIG_AXIS_ROLLING] += 1e-15; break;
        case 8: points[2].approach.depth = 1.1; break;
        case 9: points[2].effect[0] = 'x'; break;
        case 10: p.trajectory[0]++; break;
        default: break;
        }
        dig_plan_hash(&p, &s, &e, hash[change]);
        assert_int_equal(strlen(hash[change]), 64);
        for (int other = 0; other < change; other++) {
            assert_string_not_equal(hash[change], hash[other]);
        }
    }
    struct dig_plan shard = plan;
    shard.shards          = 5;
    shard.shard           = 2;
    dig_plan_hash(&shard, &scene, &engine, hash[1]);
    assert_string_equal(hash[1], hash[0]);
}

TESTS_WITH(read_plan, forget_plan)
