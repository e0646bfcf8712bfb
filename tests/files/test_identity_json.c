// Tests for files/identity_json.c

#include "files/identity_json.h"

#include "tests/scratch.h"

static struct dig_identity example(void)
{
    struct dig_identity id = {
        .trajectory       = "simpleA",
        .made             = { 1.25, 0.02 },
        .matched          = { 1.2, 0.01 },
        .match            = { .digs              = 3,
                              .forces            = true,
                              .gravel            = { { 0.512345, 0.4, 2345.6 } },
                              .mean              = { { 0.52, 0.41, 2300.0 } },
                              .low               = { { 0.4, 0.3, 2000.0 } },
                              .high              = { { 0.6, 0.5, 2600.0 } },
                              .distance          = 0.11,
                              .nearest_distance  = 0.12,
                              .weighted_distance = 1.25,
                              .noise_floor       = 0.2,
                              .outside           = true,
                              .samples           = 2,
                              .sample            = { { { 0.5, 0.4, 2300.0 } }, { { 0.55, 0.45, 2200.0 } } } },
        .nearest          = { { 0.5, 0.5, 2500.0 } },
        .weighted_nearest = { { 0.3, 0.6, 1500.0 } },
        .family           = true,
    };
    memset(id.scene_hash, 'a', 64);
    id.recorded = 2;
    for (int i = 0; i < 2; i++) {
        struct dig_observation *const dig = &id.recording[i].seen;
        (void)strcpy(id.recording[i].trajectory, i == 0 ? "simpleA" : "simpleB");
        dig->first = 0.125;
        dig->last  = 0.875;
        if (i == 1) {
            dig->approach = (struct dig_approach){ 1.15, 0.05 };
        }
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            dig->moment_Nm[k] = 0.001 * k * (1 + i);
            dig->sigma_Nm[k]  = 0.75;
            for (int c = 0; i == 1 && c < 2; c++) {
                dig->forces              = true;
                dig->force_N[c][k]       = (c == 0 ? -0.25 : 0.125) * k;
                dig->force_sigma_N[c][k] = 0.375 + c;
            }
        }
    }
    return id;
}

TEST(what_was_written_is_read_back)
{
    const struct dig_identity id   = example();
    const char *const         path = scratch_path("id.json");
    FILE *const               file = fopen(path, "w");
    assert_non_null(file);
    dig_identity_write(file, &id);
    (void)fclose(file);

    struct dig_identity back  = { 0 };
    struct dig_error    error = { "" };
    assert_ok(dig_identity_read(path, &back, &error), error);
    assert_string_equal(back.scene_hash, id.scene_hash);
    assert_string_equal(back.trajectory, "simpleA");
    assert_int_equal(back.match.digs, 3);
    assert_int_equal(back.match.samples, 2);
    assert_true(back.match.outside && back.family);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(back.match.gravel.value[a], id.match.gravel.value[a], 1e-6);
        assert_close(back.match.low.value[a], id.match.low.value[a], 1e-6);
        assert_close(back.match.high.value[a], id.match.high.value[a], 1e-6);
        assert_close(back.nearest.value[a], id.nearest.value[a], 1e-6);
        assert_close(back.match.sample[1].value[a], id.match.sample[1].value[a], 1e-6);
        assert_close(back.weighted_nearest.value[a], id.weighted_nearest.value[a], 1e-6);
    }
    assert_true(back.match.valid && back.match.weighted == 0);
    assert_close(back.match.weighted_distance, 1.25, 1e-9);
    assert_close(back.match.noise_floor, 0.2, 1e-9);
    assert_close(back.made.depth, 1.25, 1e-9);
    assert_close(back.made.attack_rad, 0.02, 1e-9);
    assert_close(back.matched.depth, 1.2, 1e-9);
    assert_close(back.matched.attack_rad, 0.01, 1e-9);
    assert_int_equal(back.recorded, 2);
    assert_string_equal(back.recording[1].trajectory, "simpleB");
    assert_close(back.recording[1].seen.approach.depth, 1.15, 1e-9);
    assert_close(back.recording[1].seen.approach.attack_rad, 0.05, 1e-9);
    assert_true(dig_approach_is_plain(&back.recording[0].seen.approach));
    assert_close(back.recording[1].seen.first, 0.125, 0.0);
    assert_close(back.recording[1].seen.last, 0.875, 0.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(back.recording[1].seen.moment_Nm[k], 0.002 * k, 1e-7);
        assert_close(back.recording[0].seen.sigma_Nm[k], 0.75, 0.0);
    }
    assert_true(back.match.forces && !back.recording[0].seen.forces &&
                back.recording[1].seen.forces);
    assert_memory_equal(back.recording[1].seen.force_N, id.recording[1].seen.force_N,
                        sizeof id.recording[1].seen.force_N);
    assert_memory_equal(back.recording[1].seen.force_sigma_N, id.recording[1].seen.force_sigma_N,
                        sizeof id.recording[1].seen.force_sigma_N);
}

// What it was matched at is written where it is another; neither, where it was not told.
TEST(a_depth_is_written_once_and_only_where_it_was_told)
{
    struct dig_identity id = example();
    static const struct {
        struct dig_approach made, matched;
        bool                says, says_matched;
    } cases[] = { { { 0.0, 0.0 }, { 0.0, 0.0 }, false, false },
                  { { 1.1, 0.02 }, { 1.1, 0.02 }, true, false },
                  { { 1.0, 0.0 }, { 0.0, 0.0 }, true, false },
                  { { 1.1, 0.02 }, { 1.1, 0.01 }, true, true },
                  { { 1.1, 0.0 }, { 0.0, 0.0 }, true, true } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        static char         text[65536];
        struct dig_identity back;
        id.made          = cases[i].made;
        id.matched       = cases[i].matched;
        id.recorded      = 0;
        FILE *const file = fopen(scratch_path("made.json"), "w+");
        assert_non_null(file);
        dig_identity_write(file, &id);
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        (void)fclose(file);
        assert_true((strstr(text, "\"depth\"") != NULL) == cases[i].says);
        assert_true((strstr(text, "\"matched_depth\"") != NULL) == cases[i].says_matched);
        assert_int_equal(dig_identity_read(scratch_path("made.json"), &back, NULL), DIG_OK);
        const struct dig_approach matched = dig_approach_normalized(&back.matched);
        const struct dig_approach was     = dig_approach_normalized(&cases[i].matched);
        assert_close(back.made.depth, cases[i].made.depth, 1e-9);
        assert_close(back.made.attack_rad, cases[i].made.attack_rad, 1e-9);
        assert_close(matched.depth, was.depth, 1e-9);
        assert_close(matched.attack_rad, was.attack_rad, 1e-9);
    }
}

// Of 0.1.0: without a word of forces.
TEST(what_was_written_before_forces_is_read)
{
    struct dig_identity read  = { .match.forces = true };
    struct dig_error    error = { "" };
    assert_ok(dig_identity_read("tests/data/formats/identity.json", &read, &error), error);
    assert_true(read.match.digs > 0 && !read.match.forces && read.match.weighted < 0 &&
                !(read.made.depth > 0.0));
}

// Each defect names the file and the key, and leaves what was there.
TEST(defects_are_refused_by_name)
{
    static char               good[65536];
    const struct dig_identity id   = example();
    FILE *const               file = tmpfile();
    dig_identity_write(file, &id);
    rewind(file);
    good[fread(good, 1, sizeof good - 1, file)] = '\0';
    (void)fclose(file);

    const struct {
        const char *was, *is, *names;
    } defect[] = {
        { "\"outside\": true", "\"outside\": 7e", "outside" },
        { "\"digs\": 3", "\"digs\": -3", "digs" },
        { "\"trajectory\": \"simpleA\"", "\"trajectory\": \"../A\"", "trajectory: \"../A\"" },
        { "\"distance\": 0.11,", "", "distance" },
        { "\"friction\": 0.55,", "\"friction\": -0.55,", "samples" },
        { "\"rolling\": 0.6,", "\"rolling\": -0.6,", "weighted_nearest" },
        { "\"weighted_distance\": 1.25", "\"weighted_distance\": -1", "weighted_nearest" },
        { "2345.6", "nan", "density_kgpm3" },
        { "\"simpleA\"", "\"a name that is far too long for any trajectory\"", "trajectory" },
        { "{\"scene_hash\"", "{\"scene\"", "scene" },
        { "\"last\": 0.875", "\"last\": 0.1", "recorded" },
        { "0.75, 0.75", "0.75, -0.75", "recorded" },
        { "0.75, 0.75", "0.75", "sigma_Nm" },
        { "0.75, 0.75", "0.75, 0.75, 0.75", "sigma_Nm" },
        { "\"forces\": true", "\"forces\": 3", "forces" },
        { "0.375, 0.375", "0.375, nan", "sigma_x_N" },
        { "0.375, 0.375", "0.375", "sigma_x_N" },
        { "1.375, 1.375", "1.375, -1.375", "recorded" },
        { "\"z_N\"", "\"y_N\"", "y_N" },
        { "\"depth\": 1.25", "\"depth\": 3.5", "depth" },
        { "\"depth\": 1.25,", "", "depth" },
        { "\"matched_depth\": 1.2", "\"matched_depth\": 0.1", "matched_depth" },
        { "\"matched_attack_deg\": 0.", "\"matched_attack_deg\": 50.", "matched_attack_deg" },
    };
    for (size_t i = 0; i < sizeof defect / sizeof defect[0]; i++) {
        static char       bad[65536];
        const char *const at = strstr(good, defect[i].was);
        assert_non_null(at);
        (void)snprintf(bad, sizeof bad, "%.*s%s%s", (int)(at - good), good, defect[i].is,
                       at + strlen(defect[i].was));
        const char *const   path      = scratch_write("bad.json", bad);
        struct dig_identity untouched = { .match.digs = 42 };
        struct dig_error    error     = { "" };
        if (dig_identity_read(path, &untouched, &error) != DIG_EINVAL) {
            fail_msg("%s for %s is taken", defect[i].is, defect[i].was);
        }
        assert_int_equal(untouched.match.digs, 42);
        assert_contains(error.text, path);
        assert_contains(error.text, defect[i].names);
    }
    struct dig_identity untouched = { .match.digs = 42 };
    assert_int_equal(dig_identity_read(scratch_path("absent.json"), &untouched, NULL), DIG_EIO);
    assert_int_equal(untouched.match.digs, 42);
}

TESTS_WITH(scratch_setup, scratch_teardown)
