// Tests for tables/load.c, upgrade.c and listed.c: digs at another depth or attack in a
// table, and tables from before there were any.

#include "tables/load.h"

#include "core/units.h"
#include "files/scene_yaml.h"
#include "tables/listed.h"
#include "tables/merge.h"
#include "tests/tables_fixture.h"

#define TURNED (10.0 * DIG_RAD_PER_DEG)

static void put_turned(struct dig_store *const store, const double friction,
                       const double attack_rad, const size_t packing, const double my_Nm)
{
    struct dig_run_origin origin = fixture_origin(friction, .5, 2500.0, packing, 0);
    origin.approach.attack_rad   = attack_rad;
    fixture_put_run(store, origin, my_Nm);
}

static void make_table(const char *const name)
{
    struct dig_store *const store = fixture_create(name);
    put_turned(store, .9, TURNED, 0, 8.0);
    put_turned(store, .3, TURNED, 0, 3.0);
    put_turned(store, .3, -TURNED, 0, 2.0);
    fixture_put(store, .3, .5, 0, 0, 1.0);
    fixture_put(store, .3, .5, 1, 0, 1.4);
    fixture_put(store, .9, .5, 0, 0, 5.0);
    dig_store_close(store);
}

TEST_WITH(turned_digs_stand_beside_the_plain_ones, scratch_setup, scratch_teardown)
{
    make_table("both.sqlite");
    struct dig_curve_set *const set = fixture_load("both.sqlite");
    assert_int_equal(set->entries, 2);
    assert_close((double)set->curve[0].mean[0][100], 1.2, 1e-6);
    const struct dig_entry_set *const other = set->approaches;
    assert_non_null(other);
    assert_int_equal(other->entries, 3);
    static const struct {
        double friction, attack_rad, my_Nm;
    } expected[] = { { .3, -TURNED, 2.0 }, { .3, TURNED, 3.0 }, { .9, TURNED, 8.0 } };
    for (size_t i = 0; i < 3; i++) {
        assert_close(other->entry[i].gravel.value[0], expected[i].friction, 0.0);
        assert_close(other->entry[i].approach.attack_rad, expected[i].attack_rad, 0.0);
        assert_close(other->entry[i].approach.depth, 1.0, 0.0);
        assert_int_equal(other->packings[2 * i], 1);
        assert_int_equal(other->packings[2 * i + 1], 0);
        const struct dig_curve *const curve = &other->curve[2 * i];
        assert_close((double)curve->mean[0][7], expected[i].my_Nm, 1e-6);

        // One packing: the spread is that of the plain dig with two, relative to the moment.
        assert_close((double)curve->sd[0][7], 0.2 * sqrt(2.0) / 1.2 * expected[i].my_Nm, 1e-5);

        const struct dig_listed one = dig_listed_at(set, 2 + i, 0);
        assert_ptr_equal(one.curve, curve);
        assert_close(one.trajectory.theta0_rad - set->trajectory[0].theta0_rad,
                     expected[i].attack_rad, 1e-15);
    }
    assert_int_equal(dig_listed_count(set), 5);
    assert_ptr_equal(dig_listed_at(set, 1, 0).curve, &set->curve[2]);
    dig_curve_set_destroy(set);
}

TEST_WITH(a_table_without_them_has_no_such_set, scratch_setup, scratch_teardown)
{
    struct dig_store *const store = fixture_create("plain.sqlite");
    fixture_put(store, .3, .5, 0, 0, 1.0);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("plain.sqlite");
    assert_null(set->approaches);
    assert_int_equal(dig_listed_count(set), 1);
    dig_curve_set_destroy(set);
}

TEST_WITH(a_run_is_there_in_its_own_approach_only, scratch_setup, scratch_teardown)
{
    make_table("has.sqlite");
    struct dig_store *store = NULL;
    bool              there = false;
    assert_int_equal(dig_store_open(scratch_path("has.sqlite"), &store, NULL), DIG_OK);
    struct dig_run_origin key = fixture_origin(.3, .5, 2500.0, 1, 0);
    assert_int_equal(dig_store_has(store, &key, &there, NULL), DIG_OK);
    assert_true(there);
    key.approach.attack_rad = TURNED;
    assert_int_equal(dig_store_has(store, &key, &there, NULL), DIG_OK);
    assert_false(there);
    key.packing = 0;
    assert_int_equal(dig_store_has(store, &key, &there, NULL), DIG_OK);
    assert_true(there);
    key.approach.depth = 1.1;
    assert_int_equal(dig_store_has(store, &key, &there, NULL), DIG_OK);
    assert_false(there);

    struct dig_store_report report;
    assert_int_equal(dig_store_check(store, &report, NULL), DIG_OK);
    assert_int_equal(report.points, 2);
    assert_int_equal(report.approaches, 3);
    assert_int_equal(report.entries, 5);
    assert_int_equal(report.runs, 6);
    dig_store_close(store);
}

TEST_WITH(an_approach_out_of_range_is_refused_and_leaves_nothing, scratch_setup, scratch_teardown)
{
    struct dig_store *const          store     = fixture_create("range.sqlite");
    struct dig_run_origin            origin    = fixture_origin(.3, .5, 2500.0, 0, 0);
    const struct dig_recording       recording = fixture_recording(400, 1.0);
    struct dig_error                 error     = { "" };
    static const struct dig_approach bad[]     = {
            { 9.0, 0.0 }, { -1.0, 0.0 }, { NAN, 0.0 }, { 1.0, 2.0 }, { 1.0, NAN }
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        origin.approach = bad[i];
        assert_int_equal(dig_store_put(store, &origin, &recording, &error), DIG_EINVAL);
        assert_contains(error.text, "run: depth");
    }
    dig_store_close(store);
    assert_int_equal(fixture_ask("range.sqlite", "SELECT count(*) FROM ground"), 0);
}

// Down 20 mm in half a second and 50 mm along in one; at depth 1.5 it is 30 mm down, so that the
// way along begins at 3/8 of the path, not at 2/7. The moment is the share of the path done.
TEST_WITH(a_deep_dig_is_kept_over_its_own_path, scratch_setup, scratch_teardown)
{
    struct dig_scene scene = fixture_scene();
    scene.trajectories     = 1;
    scene.trajectory[0]    = (struct dig_trajectory){
           .name      = "dive",
           .start_x_m = 0.1,
           .start_z_m = 0.175,
           .phases    = 2,
           .phase     = { { "down", 0.5, 0.0, -0.04, 0.0 }, { "along", 1.0, 0.05, 0.0, 0.0 } },
    };
    struct dig_store *const store   = fixture_create_of("deep.sqlite", &scene);
    struct dig_error        error   = { "" };
    static const double     depth[] = { 1.0, 1.5 };
    struct dig_recording    made    = fixture_recording(300, 0.0);
    for (size_t d = 0; d < 2; d++) {
        const double down_m = 0.02 * depth[d];
        for (size_t i = 0; i < made.rows; i++) {
            const double t_s  = made.row[i].t_s;
            const double at_m = t_s < 0.5 ? t_s / 0.5 * down_m : down_m + 0.05 * (t_s - 0.5);
            made.row[i].My_Nm = at_m / (down_m + 0.05);
        }
        struct dig_run_origin origin = fixture_origin(.3, .5, 2500.0, 0, 0);
        origin.approach.depth        = depth[d];
        assert_int_equal(dig_store_put(store, &origin, &made, &error), DIG_OK);
    }
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("deep.sqlite");
    for (int k = 50; k < 200; k++) { // smoothing bends the ends
        const double share = (double)k / (DIG_CURVE_POINTS - 1);
        assert_close((double)set->curve[0].mean[0][k], share, 0.01);
        assert_close((double)set->approaches->curve[0].mean[0][k], share, 0.01);
    }
    dig_curve_set_destroy(set);
}
