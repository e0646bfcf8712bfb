// Tests for tables/density_scale.c: one density stands for all where it is a scale of the scene,
// and only there.

#include "tables/density_scale.h"

#include "core/entry_set.h"
#include "tests/tables_fixture.h"

static void make_table(const char *const name, const struct dig_scene *const scene)
{
    struct dig_store *const store = fixture_create_of(name, scene);
    fixture_put(store, .5, .3, 0, 0, 4.0);
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 1.5);
    static const double deeper[] = { 0.8, 1.2 };
    for (size_t i = 0; i < 2; i++) {
        struct dig_run_origin origin = fixture_origin(.3, .3, 2500.0, 0, 0);
        origin.approach.depth        = deeper[i];
        fixture_put_run(store, origin, 10.0 * deeper[i]);
    }
    dig_store_close(store);
}

static struct dig_scene scaling_scene(void)
{
    struct dig_scene scene        = fixture_diving_scene();
    scene.material.young_at_kgpm3 = 2500.0;
    return scene;
}

TEST_WITH(one_density_becomes_three, scratch_setup, scratch_teardown)
{
    const struct dig_scene scene = scaling_scene();
    make_table("scales.sqlite", &scene);
    struct dig_curve_set *const set = fixture_load("scales.sqlite");
    assert_int_equal(set->entries, 6);
    assert_int_equal(set->axis_count[DIG_AXIS_DENSITY_kgpm3], 3);
    assert_int_equal(set->copies, 3);
    assert_close(set->stiffness_power, 1.0, 0.0);
    static const double density_kgpm3[] = { 1500.0, 2500.0, 4000.0 };
    static const double my_Nm[]         = { 1.25, 4.0 };
    for (size_t i = 0; i < 6; i++) {
        const double factor = density_kgpm3[i % 3] / 2500.0;
        assert_close(set->gravel[i].value[DIG_AXIS_FRICTION], i < 3 ? .3 : .5, 0.0);
        assert_close(set->gravel[i].value[DIG_AXIS_DENSITY_kgpm3], density_kgpm3[i % 3], 1e-9);
        assert_int_equal(set->packings[2 * i], i < 3 ? 2 : 1);
        assert_int_equal(set->packings[2 * i + 1], 0);
        const struct dig_curve *const curve = &set->curve[2 * i];
        assert_close((double)curve->mean[0][9], factor * my_Nm[i / 3], 1e-6);
        assert_close((double)curve->mean[1][9], 2.0 * factor * my_Nm[i / 3], 1e-6);
        assert_close((double)curve->mean[3][9], 5.0 * factor * my_Nm[i / 3], 1e-5);
        assert_close((double)curve->sd[0][9], factor * my_Nm[i / 3] * sqrt(.125) / 1.25, 1e-6);
        assert_int_equal(set->cell[i], (int)i);
    }
    dig_curve_set_destroy(set);
}

// Digs deeper and turned go along, in the order of gravel, then depth.
TEST_WITH(so_do_digs_made_in_another_way, scratch_setup, scratch_teardown)
{
    const struct dig_scene scene = scaling_scene();
    make_table("deeper.sqlite", &scene);
    struct dig_curve_set *const       set   = fixture_load("deeper.sqlite");
    const struct dig_entry_set *const other = set->approaches;
    assert_non_null(other);
    assert_int_equal(other->entries, 6);
    for (size_t i = 0; i < 6; i++) {
        const double factor = i < 2 ? 0.6 : i < 4 ? 1.0 : 1.6;
        const double depth  = i % 2 == 0 ? 0.8 : 1.2;
        assert_close(other->entry[i].gravel.value[DIG_AXIS_DENSITY_kgpm3], 2500.0 * factor, 1e-9);
        assert_close(other->entry[i].approach.depth, depth, 0.0);
        assert_close((double)other->curve[2 * i].mean[0][9], factor * 10.0 * depth, 1e-5);
    }
    dig_curve_set_destroy(set);
}

TEST_WITH(what_was_dug_is_listed, scratch_setup, scratch_teardown)
{
    const struct dig_scene scene = scaling_scene();
    make_table("listed.sqlite", &scene);
    struct dig_curve_set *set = NULL;
    assert_int_equal(dig_table_list(scratch_path("listed.sqlite"), &set, NULL, NULL), DIG_OK);
    assert_int_equal(set->entries, 2);
    dig_curve_set_destroy(set);
}

static void expect_as_dug(const char *const name, const struct dig_scene *const scene)
{
    make_table(name, scene);
    struct dig_curve_set *const set = fixture_load(name);
    assert_int_equal(set->entries, 2);
    assert_int_equal(set->copies, 1);
    dig_curve_set_destroy(set);
}

// A pull, a press or a layer of its own does not go with the density of the gravel.
TEST_WITH(what_has_a_size_of_its_own_is_no_scale, scratch_setup, scratch_teardown)
{
    struct dig_scene scene = fixture_diving_scene();
    expect_as_dug("plain.sqlite", &scene);
    scene                    = scaling_scene();
    scene.laws.cohesion_Jpm3 = 1e4;
    expect_as_dug("cohesion.sqlite", &scene);
    scene                    = scaling_scene();
    scene.laws.adhesion_Jpm3 = 1e4;
    expect_as_dug("adhesion.sqlite", &scene);
    scene                = scaling_scene();
    scene.bed.preload_Pa = 1e3;
    expect_as_dug("preload.sqlite", &scene);
    scene                 = scaling_scene();
    scene.bed.materials   = 1;
    scene.bed.material[0] = (struct dig_other_material){ "clay", .5, .5, 1800.0, .2 };
    expect_as_dug("layers.sqlite", &scene);
    scene                 = scaling_scene();
    scene.bed.obstacles   = 1;
    scene.bed.obstacle[0] = (struct dig_obstacle){ .shape         = DIG_OBSTACLE_SPHERE,
                                                   .centre_m      = { 0.2, 0.0, 0.04 },
                                                   .size_m        = { 0.02 },
                                                   .movable       = true,
                                                   .density_kgpm3 = 2600.0 };
    expect_as_dug("rock.sqlite", &scene);
    scene.bed.obstacle[0].movable = false;
    make_table("fixed.sqlite", &scene);
    struct dig_curve_set *const set = fixture_load("fixed.sqlite");
    assert_int_equal(set->entries, 6);
    dig_curve_set_destroy(set);
}

TEST_WITH(densities_that_were_dug_stand, scratch_setup, scratch_teardown)
{
    const struct dig_scene scene = scaling_scene();
    struct dig_store      *store = NULL;
    assert_int_equal(dig_store_create(scratch_path("two.sqlite"), &scene, &store, NULL), DIG_OK);
    fixture_put_run(store, fixture_origin(.3, .3, 2500.0, 0, 0), 1.0);
    fixture_put_run(store, fixture_origin(.3, .3, 1800.0, 0, 0), 0.7);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("two.sqlite");
    assert_int_equal(set->entries, 2);
    assert_close((double)set->curve[0].mean[0][9], 0.7, 1e-6);
    dig_curve_set_destroy(set);
}
