// Tests for tables/scene.c: a scene through a file and back.

#include "tables/scene.h"
#include "tables/schema/canonical_scene.h"

#include "core/sha256.h"
#include "core/similar.h"
#include "tests/tables_fixture.h"

static struct dig_scene uneven(void)
{
    struct dig_scene s   = fixture_scene();
    s.box                = (struct dig_box){ -0.01, 0.3, -0.061, 0.061, -0.02, 0.085 };
    s.laws.normal        = DIG_NORMAL_HERTZ;
    s.bed.periodic_y     = true;
    s.bed.surface        = 2;
    s.bed.surface_x_m[1] = 0.3;
    s.bed.surface_z_m[0] = 0.085;
    s.bed.surface_z_m[1] = 0.08;
    s.bed.pairs          = 1;
    s.bed.pair[0]        = (struct dig_material_pair){ 0, DIG_MATERIAL_BUCKET, 0.4, 0.35, 0.1 };
    s.material.young_at_kgpm3 = 2600.0;
    return s;
}

static struct dig_scene uneven_across(void)
{
    struct dig_scene s = fixture_scene();
    s.bed.profiles     = 3;
    for (size_t k = 0; k < s.bed.profiles; k++) {
        s.bed.profile[k] = (struct dig_ground_profile){
            0.1 * (double)k - 0.1, 2, { 0.0, 0.3 }, { 0.08, 0.07 + 0.001 * (double)k }
        };
    }
    return s;
}

static void make_table(const char *const name, const struct dig_scene *const scene)
{
    struct dig_store *store = NULL;
    struct dig_error  error = { "" };
    assert_ok(dig_store_create(scratch_path(name), scene, &store, &error), error);
    dig_store_close(store);
}

TEST(a_table_tells_the_scene_it_was_made_in_to_the_last_bit)
{
    const struct dig_scene made[] = { fixture_scene(), uneven(), uneven_across() };
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++) {
        const struct dig_scene *const a = &made[i];
        struct dig_scene              b;
        struct dig_error              error = { "" };
        make_table("scene.sqlite", a);
        assert_int_equal(dig_table_scene(scratch_path("scene.sqlite"), &b, &error), DIG_OK);
        assert_string_equal(b.name, "tub");
        assert_memory_equal(&b.bucket, &a->bucket, sizeof b.bucket);
        assert_memory_equal(&b.box, &a->box, sizeof b.box);
        assert_memory_equal(&b.material, &a->material, sizeof b.material);
        assert_close(b.gravity_mps2, a->gravity_mps2, 0.0);
        assert_int_equal(b.laws.normal, a->laws.normal);
        assert_int_equal(b.bed.pairs, a->bed.pairs);
        assert_memory_equal(b.bed.pair, a->bed.pair, sizeof b.bed.pair);
        assert_int_equal(b.bed.periodic_y, a->bed.periodic_y);
        assert_int_equal(b.bed.surface, a->bed.surface);
        assert_memory_equal(b.bed.surface_x_m, a->bed.surface_x_m, sizeof b.bed.surface_x_m);
        assert_memory_equal(b.bed.surface_z_m, a->bed.surface_z_m, sizeof b.bed.surface_z_m);
        assert_int_equal(b.bed.profiles, a->bed.profiles);
        assert_memory_equal(b.bed.profile, a->bed.profile, sizeof b.bed.profile);
        assert_int_equal(b.trajectories, a->trajectories);
        assert_int_equal(dig_scene_similar(a, &b, &error), DIG_OK);
        assert_int_equal(remove(scratch_path("scene.sqlite")), 0);
    }
}

TEST(what_is_no_table_is_refused_and_leaves_the_scene_alone)
{
    struct dig_error error = { "" };
    struct dig_scene b     = { .name = "mine" };
    assert_int_equal(dig_table_scene(scratch_path("none.sqlite"), &b, &error), DIG_EIO);
    const char *const path = scratch_write("text.sqlite", "a text, and no table of any kind\n");
    assert_int_equal(dig_table_scene(path, &b, &error), DIG_EINVAL);
    assert_string_equal(b.name, "mine");
}

// The text is replaced together with its hash, so that only what it says is wrong.
static void expect_no_scene(const char *const text)
{
    char hash[65];
    char sql[600];
    dig_sha256_hex(text, strlen(text), hash);
    (void)snprintf(sql, sizeof sql, "UPDATE scene SET canonical = '%s', hash = '%s'", text, hash);
    const char *const path  = fixture_copy("whole.sqlite", "bare.sqlite", sql);
    struct dig_scene  b     = { .name = "mine" };
    struct dig_error  error = { "" };
    assert_int_equal(dig_table_scene(path, &b, &error), DIG_EINVAL);
    assert_contains(error.text, "bare.sqlite: scene.canonical: expected");
    assert_string_equal(b.name, "mine");
}

TEST(a_scene_without_bucket_box_or_grains_is_none)
{
    struct dig_scene plain = fixture_scene();
    plain.trajectories     = 1;
    make_table("whole.sqlite", &plain);

    // As the trajectory stands in the table; the rest is given or not.
#define BUCKET "scene=x\nbucket_width_m=0.07\nprofile_m=0 -0.09\nprofile_m=0.01 0\n"
#define BOX    "box_m=0 1 -1 1 0 1\n"
#define GRAINS "material=0.01 5e6 0.2 0.2 2\ngravity_mps2=9.81\n"
#define DIG                                                                                        \
    "trajectory=pull\ntheta0_rad=0\nstart_m=0.10000000000000001 0.20000000000000001\n"             \
    "phase=pull 2 0.050000000000000003 0 0\n"
    expect_no_scene("scene=x\nprofile_m=0 -0.09\n" BOX GRAINS DIG);
    expect_no_scene(BUCKET GRAINS DIG);
    expect_no_scene(BUCKET "box_m=0 0 -1 1 0 1\n" GRAINS DIG);
    expect_no_scene(BUCKET BOX "gravity_mps2=9.81\n" DIG);
    expect_no_scene(BUCKET BOX "material=0.01 5e6 0.2 0.2 2\n" DIG);
    char hash[65];
    char sql[600];
    dig_sha256_hex(BUCKET BOX GRAINS DIG, strlen(BUCKET BOX GRAINS DIG), hash);
    (void)snprintf(sql, sizeof sql, "UPDATE scene SET canonical = '%s', hash = '%s'",
                   BUCKET BOX GRAINS DIG, hash);
    struct dig_scene b;
    assert_int_equal(dig_table_scene(fixture_copy("whole.sqlite", "bare.sqlite", sql), &b, NULL),
                     DIG_OK);

    // A text that ends too soon.
    dig_scene_from_canonical("scene=x\nbucket_width_m=0.07\nbox_m=0 1 2\n", &b);
    assert_close(b.bucket.width_m, 0.07, 0.0);
    assert_close(b.box.y_min_m, 2.0, 0.0);
    assert_true(isnan(b.box.y_max_m) && isnan(b.material.diameter_m) && isnan(b.gravity_mps2));
    assert_int_equal(b.bucket.points, 0);
}

TESTS_WITH(scratch_setup, scratch_teardown)
