// Tests for tables/load.c

#include "tables/load.h"

#include "core/table_step.h"
#include "files/scene_yaml.h"
#include "tests/tables_fixture.h"

static const struct dig_curve *curve_of(const struct dig_curve_set *const set, const size_t entry,
                                        const size_t trajectory)
{
    return &set->curve[entry * set->trajectories + trajectory];
}

TEST(the_head_is_that_of_the_scene)
{
    struct dig_store *const store = fixture_create("head.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    dig_store_close(store);
    struct dig_curve_set *const set   = fixture_load("head.sqlite");
    const struct dig_scene      scene = fixture_scene();
    char                        hash[65];
    dig_scene_hash(&scene, hash);
    assert_string_equal(set->scene_hash, hash);
    assert_string_equal(set->scene_name, "tub");
    assert_close(set->tooth_m, 0.09, 0.0);
    assert_close(set->bucket_width_m, 0.07, 0.0);
    assert_close(set->young_Pa, 5e6, 0.0);
    assert_close(set->smooth_half_s, 0.16, 0.0);
    assert_close(set->stiffness_power, 0.2, 0.0);
    assert_int_equal(set->trajectories, 2);
    for (size_t t = 0; t < 2; t++) {
        const struct dig_trajectory *const a = &set->trajectory[t], *const b = &scene.trajectory[t];
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->phases, b->phases);
        assert_close(a->theta0_rad, b->theta0_rad, 0.0);
        assert_close(a->start_x_m, b->start_x_m, 0.0);
        assert_close(a->phase[0].vx_mps, b->phase[0].vx_mps, 0.0);
        assert_close(a->phase[0].duration_s, b->phase[0].duration_s, 0.0);
    }
    dig_curve_set_destroy(set);
}

// Out of the text that a table keeps of its scene: the step, the smallest grains, the lightest
// gravel.
TEST(the_step_is_that_of_the_scene_and_its_lightest_gravel)
{
    struct dig_scene scene  = fixture_scene();
    scene.time_step_s       = 5e-5;
    scene.bed.sizes         = 2;
    scene.bed.size[0]       = (struct dig_size){ 0.009, 0.5 };
    scene.bed.size[1]       = (struct dig_size){ 0.006, 0.5 };
    struct dig_store *store = NULL;
    assert_int_equal(dig_store_create(scratch_path("tremble.sqlite"), &scene, &store, NULL),
                     DIG_OK);
    fixture_put_run(store, fixture_origin(.3, .3, 2500.0, 0, 0), 1.0);
    fixture_put_run(store, fixture_origin(.3, .3, 1800.0, 0, 0), 1.0);
    struct dig_store_report report = { .entries = 0 };
    assert_int_equal(dig_store_check(store, &report, NULL), DIG_OK);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("tremble.sqlite");

    struct dig_material finest        = scene.material;
    finest.diameter_m                 = 0.006;
    const struct dig_table_step truth = dig_table_step_of(&finest, DIG_NORMAL_HOOKE, 1800.0, 5e-5);
    assert_memory_equal(&set->step, &truth, sizeof truth);
    assert_close(report.step.lightest_kgpm3, 1800.0, 0.0);
    dig_curve_set_destroy(set);
}

// Digs that differ by a factor alone go together in all numbers: what they are off by, relative to
// their mean, is worked out by hand. A gravel dug once teaches nothing.
TEST(the_covariance_is_that_of_the_packings_of_all_gravels)
{
    struct dig_store *const store = fixture_create("covariance.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 2.0);
    fixture_put(store, .3, .3, 2, 0, 6.0);
    fixture_put(store, .3, .6, 0, 0, 10.0);
    fixture_put(store, .3, .6, 1, 0, 12.0);
    fixture_put(store, .6, .6, 0, 0, 5.0);
    fixture_put(store, .6, .6, 1, 0, 5.0);
    fixture_put(store, .3, .3, 0, 1, 1.0);
    dig_store_close(store);
    struct dig_curve_set *const        set = fixture_load("covariance.sqlite");
    const struct dig_covariance *const c   = set->covariance;
    const double                       one = ((4.0 + 1.0 + 9.0) / 9.0 + 2.0 / 121.0) / 4.0;
    assert_non_null(c);
    assert_close(c[0].freedom, 4.0, 0.0);
    assert_close(c[1].freedom, 0.0, 0.0);
    for (size_t i = 0; i < DIG_COVARIANCE_NUMBERS; i++) {
        for (size_t j = 0; j < DIG_COVARIANCE_NUMBERS; j++) {
            // Fz is below 0 and the others above: what makes these larger makes it less.
            const bool other = (i / DIG_COVARIANCE_BLOCKS == DIG_CHANNEL_FZ_N) !=
                               (j / DIG_COVARIANCE_BLOCKS == DIG_CHANNEL_FZ_N);
            assert_close(c[0].of[i][j], other ? -one : one, 1e-6);
            assert_close(c[1].of[i][j], 0.0, 0.0);
        }
    }
    dig_curve_set_destroy(set);
}

TEST(a_single_packing_takes_the_pooled_relative_spread)
{
    struct dig_store *const store = fixture_create("pool.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0); // mean 2, variance 2: one half of its square
    fixture_put(store, .3, .3, 1, 0, 3.0);
    fixture_put(store, .5, .3, 0, 0, 3.0); // mean 4, variance 1, with twice the weight
    fixture_put(store, .5, .3, 1, 0, 4.0);
    fixture_put(store, .5, .3, 2, 0, 5.0);
    fixture_put(store, .9, .3, 0, 0, -10.0);
    fixture_put(store, .9, .3, 0, 1, 5.0); // nobody has a second packing on "push"
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("pool.sqlite");
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close((double)curve_of(set, 0, 0)->sd[0][k], sqrt(2.0), 1e-5);
        assert_close((double)curve_of(set, 1, 0)->sd[0][k], 1.0, 1e-6);
        assert_close((double)curve_of(set, 2, 0)->sd[0][k], 10.0 * sqrt((0.5 + 2.0 / 16.0) / 3.0),
                     1e-4);
        assert_close((double)curve_of(set, 2, 1)->sd[0][k], 1.0, 1e-5);
    }
    dig_curve_set_destroy(set);
}

TEST(the_grid_knows_its_axes_and_its_holes)
{
    struct dig_store *const store = fixture_create("grid.sqlite");
    fixture_put(store, .9, .3, 0, 0, 1.0);
    fixture_put(store, .3, .9, 0, 0, 2.0);
    fixture_put(store, .3, .1, 0, 0, 3.0);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("grid.sqlite");
    assert_int_equal(set->entries, 3);
    assert_int_equal(set->axis_count[DIG_AXIS_FRICTION], 2);
    assert_int_equal(set->axis_count[DIG_AXIS_ROLLING], 3);
    assert_int_equal(set->axis_count[DIG_AXIS_DENSITY_kgpm3], 1);
    assert_close(set->axis[DIG_AXIS_ROLLING][0], .1, 0.0);
    assert_close(set->axis[DIG_AXIS_ROLLING][2], .9, 0.0);

    // Friction slowest: (.3, .1) (.3, .3) (.3, .9) (.9, .1) (.9, .3) (.9, .9).
    static const double moment[] = { 3.0, 0.0, 2.0, 0.0, 1.0, 0.0 };
    for (size_t i = 0; i < 6; i++) {
        if (moment[i] > 0.0) {
            assert_true(set->cell[i] >= 0);
            assert_close((double)curve_of(set, (size_t)set->cell[i], 0)->mean[0][100], moment[i],
                         1e-6);
        } else {
            assert_int_equal(set->cell[i], -1);
        }
    }
    dig_curve_set_destroy(set);
    dig_curve_set_destroy(NULL);
}

TEST(damage_is_refused_and_named)
{
    struct dig_store *const store = fixture_create("good.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 2.0);
    dig_store_close(store);
    static const struct {
        const char     *sql;
        enum dig_status status;
        const char     *says;
    } bad[] = {
        { "PRAGMA user_version = 7", DIG_ESCHEMA, "user_version: table format 7, expected 4" },
        { "PRAGMA application_id = 99", DIG_EINVAL, "not a digsight table (application_id 99" },
        { "UPDATE scene SET hash = replace(hash, substr(hash, 1, 1), 'x')", DIG_EINVAL,
          "scene.hash: " },
        { "UPDATE scene SET canonical = canonical || ' '", DIG_EINVAL, "scene.hash: " },
        { "UPDATE scene SET tooth_m = -1", DIG_EINVAL, "scene: tooth_m" },
        { "UPDATE scene SET points = 128", DIG_ESCHEMA, "scene.points: 128, expected 256" },
        { "DELETE FROM scene", DIG_EINVAL, "scene: no row" },
        { "UPDATE trajectory SET theta0_rad = 0.5", DIG_EINVAL,
          "the rows differ from scene.canon" },
        { "UPDATE phase SET vx_mps = 0.06 WHERE trajectory = 0", DIG_EINVAL,
          "trajectory: the rows" },
        { "UPDATE phase SET duration_s = 0", DIG_EINVAL, "phase.duration_s: expected > 0" },
        { "DELETE FROM phase WHERE number = 0", DIG_EINVAL, "trajectory: " },
        { "UPDATE entry SET mean = x'00'", DIG_EINVAL, "entry.mean, entry.spread: expected 1024" },
        { "UPDATE entry SET mean = CAST(mean || x'00' AS BLOB)", DIG_EINVAL, "entry.mean" },
        { "UPDATE entry SET spread = CAST(substr(spread, 1, 400) || x'0000c07f' || "
          "substr(spread, 405) AS BLOB)",
          DIG_EINVAL, "finite" },
        { "UPDATE entry SET trajectory = 1; UPDATE entry SET trajectory = 9", DIG_EINVAL,
          "refers to nothing" },
        { "UPDATE run SET curve = x'00'", DIG_EINVAL, "run.curve: 1 bytes for" },
        { "UPDATE run SET windows = windows + 1", DIG_EINVAL, "s, expected 16 each" },
        { "UPDATE run SET curve = CAST(substr(curve, 1, 400) || x'0000c07f' || "
          "substr(curve, 405) AS BLOB)",
          DIG_EINVAL, "run.curve: a number that is not finite" },
        { "UPDATE ground SET rolling = -0.5", DIG_EINVAL, "ground.rolling: -0.5, expected >= 0" },
        { "DELETE FROM entry; DELETE FROM run; DELETE FROM ground", DIG_EINVAL, "ground: no rows" },
        { "DROP TABLE entry", DIG_EINVAL, "schema: index \"sqlite_autoindex_entry_1\" is missing" },
        { "UPDATE scene SET tooth_m = 9e999", DIG_EINVAL, "scene: tooth_m" },
        { "UPDATE scene SET young_Pa = 9e999", DIG_EINVAL, "scene: tooth_m" },
        { "UPDATE phase SET omega_radps = 9e999", DIG_EINVAL, "expected finite numbers" },
        { "UPDATE scene SET name = '../tub'", DIG_EINVAL, "scene.name: expected at most 31" },
        { "UPDATE trajectory SET name = '$(x)' WHERE id = 0", DIG_EINVAL,
          "trajectory: expected rows" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_curve_set *set   = NULL;
        struct dig_error      error = { "" };
        const char *const     path  = fixture_copy_sealed("good.sqlite", "bad.sqlite", bad[i].sql);
        assert_int_equal(dig_table_load(path, &set, &error), bad[i].status);
        assert_null(set);
        assert_contains(error.text, "bad.sqlite: ");
        assert_contains(error.text, bad[i].says);
    }
}

TEST(what_is_no_table_is_refused)
{
    struct dig_curve_set *set   = NULL;
    struct dig_error      error = { "" };
    assert_int_equal(dig_table_load(scratch_path("absent.sqlite"), &set, &error), DIG_EIO);
    assert_contains(error.text, "absent.sqlite: No such file");
    assert_false(scratch_exists("absent.sqlite"));
    assert_int_equal(dig_table_load(scratch_dir, &set, &error), DIG_EINVAL);
    assert_contains(error.text, "expected a regular file");
    assert_int_equal(dig_table_load(scratch_write("empty.sqlite", ""), &set, &error), DIG_EINVAL);
    assert_contains(error.text, "not a digsight table");
    assert_refused(
        dig_table_load(scratch_write("text.sqlite", "friction,rolling\n1,2\n"), &set, &error),
        error, DIG_EINVAL, "not a digsight table");
    assert_null(set);
}

// The table and its journal as they stand on the disk in the middle of a transaction: what is left
// of a computer that lost its power.
TEST(a_transaction_cut_short_is_rolled_back)
{
    struct dig_store *const store = fixture_create("cut.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    dig_store_close(store);
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(scratch_path("cut.sqlite"), &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db,
                                  "PRAGMA cache_size = 1; BEGIN; UPDATE ground SET friction = 0.7; "
                                  "UPDATE entry SET mean = zeroblob(4096); "
                                  "UPDATE run SET curve = zeroblob(200000);",
                                  NULL, NULL, NULL),
                     SQLITE_OK);
    static const char *const names[][2] = { { "cut.sqlite", "hot.sqlite" },
                                            { "cut.sqlite-journal", "hot.sqlite-journal" } };
    for (size_t i = 0; i < 2; i++) {
        size_t      size  = 0;
        char *const bytes = scratch_read(scratch_path(names[i][0]), &size);
        assert_true(size > 0);
        (void)scratch_write_bytes(names[i][1], bytes, size);
        free(bytes);
    }
    assert_int_equal(sqlite3_close(db), SQLITE_OK);

    struct dig_curve_set *const set = fixture_load("hot.sqlite");
    assert_close(set->gravel[0].value[DIG_AXIS_FRICTION], .3, 0.0);
    assert_close((double)curve_of(set, 0, 0)->mean[0][100], 1.0, 1e-6);
    dig_curve_set_destroy(set);
    assert_false(scratch_exists("hot.sqlite-journal"));
}

// With a bit flipped: test_seal.c.
TEST(a_file_cut_at_any_page_is_refused)
{
    struct dig_store *const store = fixture_create("whole.sqlite");
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .5, 0, 1, 2.0);
    dig_store_close(store);
    size_t      size  = 0;
    char *const whole = scratch_read(scratch_path("whole.sqlite"), &size);
    for (size_t cut = 0; cut < size; cut += 4096) {
        struct dig_curve_set *set = NULL;
        assert_int_not_equal(
            dig_table_load(scratch_write_bytes("cut.sqlite", whole, cut), &set, NULL), DIG_OK);
        assert_null(set);
    }
    free(whole);
}

TESTS_WITH(scratch_setup, scratch_teardown)
