// Tests for files/bed_yaml.c, core/bed_plan.c and core/bed_canonical.c: laws and beds as a scene
// YAML says them.

#include "core/ground.h"
#include "core/log_normal.h"
#include "tests/files/yaml_fixture.h"

#define EXAMPLE "tests/data/formats/scene_bed.yaml"

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    const struct dig_scene           s   = read_scene(EXAMPLE);
    const struct dig_bed_plan *const bed = &s.bed;
    assert_int_equal(s.laws.normal, DIG_NORMAL_HERTZ);
    assert_int_equal(s.laws.rolling, DIG_ROLLING_CDT);
    assert_close(s.laws.cohesion_Jpm3, 2e4, 0.0);
    assert_close(s.laws.adhesion_Jpm3, 1e4, 0.0);
    assert_close(s.laws.bucket_smoothness, 0.6, 0.0);
    assert_int_equal(bed->sizes, 2);
    assert_close(bed->size[1].diameter_m, 0.07, 0.0);
    assert_close(bed->size[0].mass_fraction, 0.4, 0.0);
    assert_int_equal(bed->materials, 1);
    assert_string_equal(bed->material[0].name, "ore");
    assert_close(bed->material[0].density_kgpm3, 4000.0, 0.0);
    assert_int_equal(bed->pairs, 2);
    assert_int_equal(bed->pair[0].a, 1);
    assert_int_equal(bed->pair[0].b, DIG_MATERIAL_BUCKET);
    assert_int_equal(bed->pair[1].a, 0);
    assert_int_equal(bed->pair[1].b, 1);
    assert_close(bed->pair[1].restitution, 0.15, 0.0);
    assert_int_equal(bed->layers, 1);
    assert_int_equal(bed->layer[0].material, 1);
    assert_close(bed->layer[0].to_m, 0.1, 0.0);
    assert_int_equal(bed->surface, 3);
    assert_close(bed->surface_z_m[2], 0.29, 0.0);
    assert_int_equal(bed->clump.spheres, 2);
    assert_close(bed->clump.x[0], -0.25, 0.0);
    assert_int_equal(bed->obstacles, 2);
    assert_int_equal(bed->obstacle[0].shape, DIG_OBSTACLE_SPHERE);
    assert_close(bed->obstacle[0].size_m[0], 0.08, 0.0);
    assert_false(bed->obstacle[0].movable);
    assert_int_equal(bed->obstacle[1].shape, DIG_OBSTACLE_BOX);
    assert_close(bed->obstacle[1].size_m[2], 0.12, 0.0);
    assert_true(bed->obstacle[1].movable);
    assert_close(bed->obstacle[1].density_kgpm3, 2600.0, 0.0);
    assert_false(bed->periodic_y);
    assert_close(bed->preload_Pa, 5000.0, 0.0);
    assert_int_equal(bed->earlier_digs, 2);
    assert_string_equal(bed->earlier, "scrape");
    assert_true(bed->earlier_as_dug);
}

// The tables that exist name the rig by this hash, made before beds could hold anything else.
TEST(a_plain_scene_keeps_its_identity)
{
    char                   hex[65];
    const struct dig_scene rig = read_scene("config/scenes/rig.yaml");
    dig_scene_hash(&rig, hex);
    assert_string_equal(hex, "9a66b75d3dbf255ea79c13c1c43a401f089ead1b9d22f68b09cfd554af26f411");
}

TEST(whatever_changes_the_bed_changes_the_identity)
{
    static const char *const differs[][2] = {
        { "normal: hertz", "normal: hooke" },
        { "rolling: cdt", "rolling: none" },
        { "cohesion_Jpm3: 2.0e+4", "cohesion_Jpm3: 2.1e+4" },
        { "adhesion_Jpm3: 1.0e+4", "adhesion_Jpm3: 1.1e+4" },
        { "bucket_smoothness: 0.6", "bucket_smoothness: 0.61" },
        { "{diameter_m: 0.05,", "{diameter_m: 0.051," },
        { "friction: 0.9", "friction: 0.91" },
        { "rolling: 0.8", "rolling: 0.81" },
        { "density_kgpm3: 4000", "density_kgpm3: 4001" },
        { "restitution: 0.3}", "restitution: 0.31}" },
        { "[ore, bucket], friction: 0.4", "[ore, bucket], friction: 0.41" },
        { "[ore, bucket]", "[ore, walls]" },
        { "z_m: [0, 0.1]", "z_m: [0, 0.11]" },
        { "- [0.5, 0.3]", "- [0.5, 0.301]" },
        { "[-0.25, 0, 0], radius: 0.5", "[-0.25, 0, 0], radius: 0.51" },
        { "[-0.25, 0, 0]", "[-0.25, 0.01, 0]" },
        { "[0.5, 0, 0.05]", "[0.5, 0, 0.051]" },
        { "diameter_m: 0.08", "diameter_m: 0.081" },
        { "0.11, 0.12]", "0.11, 0.121]" },
        { "2600", "2601" },
        { "preload_Pa: 5000", "preload_Pa: 5001" },
        { "earlier_digs: 2", "earlier_digs: 3" },
        { "earlier_as_dug: true", "earlier_as_dug: false" },
        { "  earlier: scrape\n", "" },
    };
    yaml_scene_differs_by_each(EXAMPLE, sizeof differs / sizeof differs[0], differs, true);
}

TEST(what_cannot_be_is_refused_with_line_and_key)
{
    static const char *const bad[][3] = {
        { "normal: hertz", "normal: herz", "bad.yaml:31: laws.normal" },
        { "cohesion_Jpm3: 2.0e+4", "cohesion_Jpm3: -1", "bad.yaml:33: laws.cohesion_Jpm3: -1" },
        { "bucket_smoothness: 0.6", "bucket_smoothness: 1.1",
          "bad.yaml:35: laws.bucket_smoothness: 1.1" },
        { "bucket_smoothness: 0.6", "bucket_smoothness: -0.1", "laws.bucket_smoothness: -0.1" },
        { "{diameter_m: 0.05,", "{diameter_m: 0,", "bad.yaml:39: bed.sizes[0].diameter_m: 0" },
        { "{diameter_m: 0.05,", "{diameter_m: 0.4,", "bad.yaml:39: bed.sizes[0].diameter_m: 0.4" },
        { "mass_fraction: 0.4", "mass_fraction: 0.3", "bed.sizes: mass fractions add up to 0.9" },
        { "friction: 0.9", "friction: -0.9", "bed.materials[0].friction: -0.9" },
        { "restitution: 0.3}", "restitution: 0}", "bed.materials[0].restitution: 0" },
        { "name: ore", "name: walls", "bed.materials[0].name: \"walls\"" },
        { "name: ore", "name: o|re", "bed.materials[0].name: \"o|re\", expected a name" },
        { "[ore, bucket]", "[ore, coal]", "bed.pairs[0].between" },
        { "[ore, bucket]", "[walls, bucket]", "bed.pairs[0].between" },
        { "material: ore", "material: coal", "bed.layers[0].material: expected" },
        { "material: ore", "material: walls", "bed.layers[0].material: expected" },
        { "z_m: [0, 0.1]", "z_m: [0.1, 0]", "bed.layers[0].z_m: [0.1, 0]" },
        { "- [0.5, 0.3]", "- [-0.5, 0.3]", "bed.surface_m[1]: [-0.5, 0.3]" },
        { "- [0.5, 0.3]", "- [0.5, 0]", "bed.surface_m[1]: [0.5, 0]" },
        { "[-0.25, 0, 0], radius: 0.5", "[-0.25, 0, 0], radius: 0", "bed.clump[0]" },
        { "diameter_m: 0.08", "diameter_m: -1", "bed.obstacles[0]: expected" },
        { "diameter_m: 0.08", "edges_m: [1, 1, 1]", "bed.obstacles[0].edges_m" },
        { "density_kgpm3: 2600", "density_kgpm3: 0", "bed.obstacles[1].density_kgpm3: 0" },
        { "periodic_y: false", "periodic_y: true", "bed.obstacles[1].movable" },
        { "preload_Pa: 5000", "preload_Pa: -5", "bed.preload_Pa: -5" },
        { "earlier_digs: 2", "earlier_digs: 99", "bed.earlier_digs: 99" },
        { "earlier: scrape", "earlier: scratch", "bed.earlier: \"scratch\"" },
        { "  sizes:", "  log_normal: {median_m: 0.05, sigma: 0.3, classes: 4}\n  sizes:",
          "bed.log_normal: beside bed.sizes" },
    };
    yaml_refuses_each(EXAMPLE, sizeof bad / sizeof bad[0], bad, yaml_scene_refused);
}

TEST(no_key_is_overlooked)
{
    yaml_knows_every_key(EXAMPLE, yaml_scene_refused);
}

// 15.87 % of a normal distribution lie below -1 sigma and 30.85 % below -1/2 sigma, as tables say.
TEST(a_log_normal_bed_is_cut_into_classes_of_equal_mass)
{
    struct dig_size size[DIG_SIZES_MAX];
    assert_int_equal(dig_log_normal_classes(0.01, 0.4, 3, size), DIG_OK);
    assert_close(size[1].diameter_m, 0.01, 1e-15);
    assert_close(size[0].diameter_m * size[2].diameter_m, 1e-4, 1e-16);
    // A sixth lies below -0.96742 sigma.
    assert_close(size[0].diameter_m, 0.01 * exp(-0.96742 * 0.4), 1e-7);
    assert_close(size[0].mass_fraction, 1.0 / 3.0, 1e-15);
    size[0] = (struct dig_size){ 7.0, 7.0 };
    assert_int_equal(dig_log_normal_classes(0.01, NAN, 3, size), DIG_EINVAL);
    assert_int_equal(dig_log_normal_classes(0.0, 0.4, 3, size), DIG_EINVAL);
    assert_int_equal(dig_log_normal_classes(0.01, 0.4, 1, size), DIG_EINVAL);
    assert_int_equal(dig_log_normal_classes(0.01, 0.4, DIG_SIZES_MAX + 1, size), DIG_EINVAL);
    assert_close(size[0].diameter_m, 7.0, 0.0);
}

TEST(the_ground_is_straight_between_its_points)
{
    struct dig_scene s = read_scene(EXAMPLE);
    assert_close(dig_scene_ground_m(&s, 0.25, 0.0), 0.29, 1e-15);
    assert_close(dig_scene_ground_m(&s, -1.0, 0.0), 0.28, 1e-15);
    assert_close(dig_scene_ground_m(&s, 2.0, 0.0), 0.29, 1e-15);
    assert_close(dig_scene_ground_max_m(&s), 0.3, 1e-15);
    // Beyond the walls there is no ground.
    s.bed.surface_x_m[1] = -0.5;
    s.bed.surface_x_m[0] = -1.0;
    assert_close(dig_scene_ground_max_m(&s), 0.3 - 0.01 / 3.0, 1e-15);
    s.bed.surface = 0;
    assert_close(dig_scene_ground_max_m(&s), s.box.z_max_m, 0.0);
}

#define UNEVEN "tests/data/formats/scene_uneven.yaml"

// Two profiles, heights by hand.
TEST(the_ground_is_straight_from_profile_to_profile)
{
    struct dig_scene s = read_scene(UNEVEN);
    assert_int_equal(s.bed.profiles, 2);
    assert_close(dig_scene_ground_m(&s, 0.5, -0.2), 0.29, 1e-15);
    assert_close(dig_scene_ground_m(&s, 0.5, 0.2), 0.30, 1e-15);
    assert_close(dig_scene_ground_m(&s, 0.5, 0.1), 0.2975, 1e-15);
    assert_close(dig_scene_ground_m(&s, 0.25, -0.1), 0.75 * 0.285 + 0.25 * 0.28, 1e-15);
    assert_close(dig_scene_ground_m(&s, 0.0, 7.0), 0.26, 1e-15);
    assert_close(dig_scene_ground_m(&s, 7.0, -7.0), 0.30, 1e-15);
    assert_close(dig_scene_ground_max_m(&s), 0.30, 1e-15);
    // A peak between the walls of the first profile alone.
    s.bed.profile[0].z_m[1] = 0.2;
    s.bed.profile[1].z_m[1] = 0.35;
    assert_close(dig_scene_ground_max_m(&s), 0.35, 1e-15);
}

TEST(every_key_of_profiles_is_checked)
{
    static const char *const bad[][3] = {
        { "y_m: 0.2", "y_m: -0.2", "bed.surfaces[1].y_m: -0.2" },
        { "- [0.5, 0.3]", "- [0, 0.3]", "bed.surfaces[1].surface_m[1]: [0, 0.3]" },
        { "- [0.5, 0.3]", "- [0.5, -1]", "bed.surfaces[1].surface_m[1]: [0.5, -1]" },
        { "  surfaces:", "  surface_m: [[0, 0.3], [1, 0.3]]\n  surfaces:",
          "bed.surfaces: expected none beside surface_m" },
    };
    yaml_refuses_each(UNEVEN, sizeof bad / sizeof bad[0], bad, yaml_scene_refused);
    yaml_knows_every_key(UNEVEN, yaml_scene_refused);
}

TEST(every_height_is_of_the_scenes_identity)
{
    struct dig_scene s = read_scene(UNEVEN);
    char             hex[65];
    char             other[65];
    dig_scene_hash(&s, hex);
    s.bed.profile[1].z_m[2] = 0.27;
    dig_scene_hash(&s, other);
    assert_string_not_equal(hex, other);
    s.bed.profile[1].z_m[2] = 0.26;
    s.bed.profile[0].y_m    = -0.19;
    dig_scene_hash(&s, other);
    assert_string_not_equal(hex, other);
}

TESTS_WITH(scratch_setup, scratch_teardown)
