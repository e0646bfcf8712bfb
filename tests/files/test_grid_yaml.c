// Tests for files/grid_yaml.c and config/grids/

#include "files/grid_yaml.h"

#include "core/units.h"
#include "tests/files/yaml_fixture.h"

#define AXES "friction: [.3, .5]\nrolling: [0]\ndensity_kgpm3: [2500]\n"

#define POINT "points:\n  - {friction: .3, rolling: 0, density_kgpm3: 2500, packings: 1}\n"

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    struct dig_grid grid;
    assert_int_equal(dig_grid_read("tests/data/formats/grid.yaml", &grid, NULL), DIG_OK);
    assert_int_equal(grid.count[DIG_AXIS_FRICTION], 2);
    assert_int_equal(grid.count[DIG_AXIS_ROLLING], 3);
    assert_int_equal(grid.count[DIG_AXIS_DENSITY_kgpm3], 1);
    assert_close(grid.value[DIG_AXIS_FRICTION][1], 0.6, 0.0);
    assert_close(grid.value[DIG_AXIS_ROLLING][2], 0.4, 0.0);
    assert_close(grid.value[DIG_AXIS_DENSITY_kgpm3][0], 2500.0, 0.0);
    assert_int_equal(grid.packings, 2);
    assert_int_equal(grid.trajectories, 1);
    assert_string_equal(grid.trajectory[0], "scrape");
}

TEST(points_and_effects_load_as_they_are_written)
{
    struct dig_grid grid;
    assert_int_equal(dig_grid_read("tests/data/formats/grid_effects.yaml", &grid, NULL), DIG_OK);
    assert_int_equal(grid.count[DIG_AXIS_FRICTION], 0);
    assert_int_equal(grid.points, 2);
    assert_close(grid.point[1].gravel.value[DIG_AXIS_FRICTION], 0.6, 0.0);
    assert_close(grid.point[1].gravel.value[DIG_AXIS_ROLLING], 0.4, 0.0);
    assert_int_equal(grid.point[0].packings, 2);
    assert_int_equal(grid.effects, 2);
    assert_int_equal(grid.effect[1].effect, DIG_EFFECT_GROUND_SLOPE);
    assert_int_equal(grid.effect[1].magnitudes, 2);
    assert_close(grid.effect[1].magnitude[0], -5.0, 0.0);
    assert_int_equal(grid.trajectories, 0);
}

TEST(depths_and_attacks_load_as_a_cross_or_a_product)
{
    struct dig_grid grid;
    assert_int_equal(dig_grid_read("tests/data/formats/grid_approaches.yaml", &grid, NULL), DIG_OK);
    static const double cross[][2]   = { { 0.8, 0.0 }, { 1.0, 5.0 }, { 1.2, 0.0 } };
    static const double product[][2] = {
        { 0.8, 0.0 }, { 0.8, 5.0 }, { 1.0, 5.0 }, { 1.2, 0.0 }, { 1.2, 5.0 }
    };
    assert_int_equal(grid.approaches, 3);
    for (size_t i = 0; i < 3; i++) {
        assert_close(grid.approach[i].depth, cross[i][0], 0.0);
        assert_close(grid.approach[i].attack_rad, cross[i][1] * DIG_RAD_PER_DEG, 1e-15);
    }
    assert_int_equal(grid.varied_packings, 1);
    assert_true(grid.point[0].states);
    assert_close(grid.point[0].approach.depth, 1.2, 0.0);
    assert_close(grid.point[0].approach.attack_rad, 5.0 * DIG_RAD_PER_DEG, 1e-15);

    const char *const path =
        scratch_write("grid.yaml", AXES "packings: 1\ndepth: [.8, 1, 1.2]\nattack_deg: [0, 5]\n"
                                        "design: product\n" POINT);
    assert_int_equal(dig_grid_read(path, &grid, NULL), DIG_OK);
    assert_int_equal(grid.approaches, 5);
    for (size_t i = 0; i < 5; i++) {
        assert_close(grid.approach[i].depth, product[i][0], 0.0);
        assert_close(grid.approach[i].attack_rad, product[i][1] * DIG_RAD_PER_DEG, 1e-15);
    }
    assert_false(grid.point[0].states);
    assert_int_equal(grid.varied_packings, 0);
}

static void fits_the_rig(const char *const path)
{
    const struct dig_scene rig = read_scene("config/scenes/rig.yaml");
    struct dig_grid        grid;
    struct dig_error       error = { "" };
    size_t                 count = 0, trajectory[DIG_TRAJECTORY_MAX];
    assert_ok(dig_grid_read(path, &grid, &error), error);
    assert_ok(dig_grid_trajectories(path, &grid, &rig, &count, trajectory, &error), error);
    assert_true(count > 0);
}

TEST(every_grid_that_is_shipped_fits_the_rig)
{
    yaml_loads_all("config/grids", fits_the_rig);
}

TEST(trajectories_are_found_in_the_scene_or_refused)
{
    struct dig_scene rig;
    struct dig_grid  grid;
    struct dig_error error = { "" };
    size_t           count = 77, trajectory[DIG_TRAJECTORY_MAX] = { 77 };
    assert_int_equal(dig_scene_read("config/scenes/rig.yaml", &rig, NULL), DIG_OK);

    const char *path =
        scratch_write("grid.yaml", AXES "packings: 1\ntrajectories: [simpleA, dance]\n");
    assert_int_equal(dig_grid_read(path, &grid, &error), DIG_OK);
    assert_refused(dig_grid_trajectories(path, &grid, &rig, &count, trajectory, &error), error,
                   DIG_EINVAL,
                   "grid.yaml:5: trajectories[1]: \"dance\", expected one of the scene's: "
                   "simpleA, simpleB, actual");
    assert_int_equal(count, 77);
    assert_int_equal(trajectory[0], 77);

    path = scratch_write("grid.yaml", AXES "packings: 1\ntrajectories: [actual, simpleA]\n");
    assert_int_equal(dig_grid_read(path, &grid, &error), DIG_OK);
    assert_int_equal(dig_grid_trajectories(path, &grid, &rig, &count, trajectory, &error), DIG_OK);
    assert_int_equal(count, 2);
    assert_int_equal(trajectory[0], 2);
    assert_int_equal(trajectory[1], 0);

    path = scratch_write("grid.yaml", AXES "packings: 1\n");
    assert_int_equal(dig_grid_read(path, &grid, &error), DIG_OK);
    assert_int_equal(dig_grid_trajectories(path, &grid, &rig, &count, trajectory, &error), DIG_OK);
    assert_int_equal(count, 3);
    assert_int_equal(trajectory[2], 2);
}

TEST(what_is_no_grid_is_refused_with_line_and_key)
{
    static const char *const bad[][2] = {
        { "friction: [.5, .3]\nrolling: [0]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":1: friction[1]: 0.3 after 0.5, expected ascending" },
        { "friction: [.3, .3]\nrolling: [0]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":1: friction[1]: 0.3 after 0.3, expected ascending" },
        { "friction: [-.1]\nrolling: [0]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":1: friction[0]: -.1, expected 0 … 3" },
        { "friction: [.3]\nrolling: [9]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":2: rolling[0]: 9, expected 0 … 3" },
        { "friction: [.3]\nrolling: [0]\ndensity_kgpm3: [2.5]\npackings: 1\n",
          ":3: density_kgpm3[0]: 2.5, expected 100 … 20000" },
        { "friction: []\nrolling: [0]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":1: friction: 0 values, expected 1 to 32" },
        { "rolling: [0]\ndensity_kgpm3: [2500]\npackings: 1\n",
          ":1: friction: missing, expected a list" },
        { POINT "rolling: [0]\n", ":1: friction: missing, expected a list" },
        { POINT "  - {friction: .3, rolling: .1, density_kgpm3: 900, packings: 0}\n",
          ":3: points[1].packings: 0, expected 1 … 1000" },
        { POINT "  - {friction: .3, rolling: .1, density_kgpm3: 9, packings: 1}\n",
          ":3: points[1].density_kgpm3: 9, expected 100 … 20000" },
        { POINT "  - {friction: .3, rolling: 0, density_kgpm3: 2500, packings: 7}\n",
          ":3: points[1]: the gravel of points[0], expected another" },
        { POINT "effects:\n  - {name: gremlins, magnitudes: [1]}\n",
          ":4: effects[0].name: \"gremlins\", expected an effect of the soil" },
        { POINT "effects:\n  - {name: cylinder_friction, magnitudes: [1]}\n",
          ":4: effects[0].name: \"cylinder_friction\", expected an effect of the soil" },
        { POINT "effects:\n  - {name: cohesion, magnitudes: [1]}\n"
                "  - {name: cohesion, magnitudes: [2]}\n",
          ":5: effects[1].name: \"cohesion\" again, expected a new effect" },
        { POINT "effects:\n  - {name: cohesion, magnitudes: [1, 2, 1]}\n",
          ":4: effects[0].magnitudes[2]: 1 again, expected another" },
        { POINT "effects:\n  - {name: cohesion, magnitudes: []}\n",
          ":4: effects[0].magnitudes: 0 values, expected 1 to 16" },
        { AXES "packings: 1\ndepth: [.8, 1.2]\n", ":5: depth: without 1, expected it among" },
        { AXES "packings: 1\ndepth: [.1, 1]\n", ":5: depth[0]: .1, expected 0.2 … 3" },
        { AXES "packings: 1\nattack_deg: [0, 60]\n", ":5: attack_deg[1]: 60, expected -45 … 45" },
        { AXES "packings: 1\nattack_deg: [5, 0]\n", ":5: attack_deg[1]: 0 after 5, expected asc" },
        { AXES "packings: 1\ndepth: [1]\ndesign: star\n", ":6: design: \"star\", expected" },
        { AXES "packings: 1\nvaried_packings: 2\n", ":5: varied_packings: without depth or" },
        { AXES "packings: 1\ndepth: [1]\nvaried_packings: 0\n",
          ":6: varied_packings: 0, expected 1 … 1000" },
        { POINT "depth: [1, 2]\neffects:\n  - {name: cohesion, magnitudes: [1]}\n",
          ":3: depth: beside effects, expected either" },
        { POINT "  - {friction: .3, rolling: .1, density_kgpm3: 900, depth: 7, packings: 1}\n",
          ":3: points[1].depth: 7, expected 0.2 … 3" },
        { POINT "  - {friction: .3, rolling: 0, density_kgpm3: 2500, depth: 1, packings: 1}\n",
          ":3: points[1]: the gravel of points[0], expected another" },
        { AXES "packings: 0\n", ":4: packings: 0, expected 1 … 1000" },
        { AXES "packings: -1\n", ":4: packings: \"-1\", expected a whole number" },
        { AXES, ":1: packings: missing, expected a whole number" },
        { AXES "packings: 1\ntrajectories: [a, b, a]\n",
          ":5: trajectories[2]: \"a\" again, expected a new name" },
        { AXES "packings: 1\ntrajectories: simpleA\n",
          ":5: trajectories: \"simpleA\", expected a list" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_error error = { "" };
        struct dig_grid  grid;
        memset(&grid, 0x5a, sizeof grid);
        const struct dig_grid untouched = grid;
        assert_int_equal(dig_grid_read(scratch_write("bad.yaml", bad[i][0]), &grid, &error),
                         DIG_EINVAL);
        assert_memory_equal(&grid, &untouched, sizeof grid);
        assert_contains(error.text, bad[i][1]);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
