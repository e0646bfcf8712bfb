// Tests for files/scene_yaml.c and config/scenes/

#include "files/scene_yaml.h"

#include "core/units.h"
#include "tests/scratch.h"

#include <ctype.h>

static struct dig_scene read_scene(const char *const path)
{
    struct dig_error error = { "" };
    struct dig_scene scene;
    if (dig_scene_read(path, &scene, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return scene;
}

// Where the tooth starts and the pin ends: the first stands in the reference digs' manifest as
// toe_x0_m, the second is the last line of curves/mu0.3_mur0.3_rho2500__actual.csv there.
static void the_rig_is_the_scene_of_the_reference_digs(void **state)
{
    (void)state;
    const struct dig_scene             rig     = read_scene("config/scenes/rig.yaml");
    const struct dig_trajectory *const actual  = dig_scene_find(&rig, "actual");
    const struct dig_trajectory *const simpleA = dig_scene_find(&rig, "simpleA");
    const struct dig_trajectory *const simpleB = dig_scene_find(&rig, "simpleB");
    assert_non_null(actual);
    assert_non_null(simpleA);
    assert_non_null(simpleB);

    const double tooth_m = dig_scene_tooth_m(&rig);
    assert_close(tooth_m, 0.09, 1e-15);
    assert_close(actual->start_x_m + tooth_m * sin(actual->theta0_rad), 0.045, 1e-12);
    assert_close(simpleA->start_x_m + tooth_m * sin(simpleA->theta0_rad), 0.06, 1e-12);
    assert_close(simpleB->start_x_m + tooth_m * sin(simpleB->theta0_rad), 0.09, 1e-12);

    const struct dig_pose end = dig_trajectory_pose(actual, 6.797531);
    assert_close(end.x_m, 0.215512, 2e-6);
    assert_close(end.z_m, 0.194212, 2e-6);
    assert_close(end.theta_rad / DIG_RAD_PER_DEG, 29.823, 1e-4);
    assert_close(rig.box.x_max_m * (rig.box.y_max_m - rig.box.y_min_m) * rig.box.z_max_m,
                 0.31 * 0.12 * 0.085, 1e-15);
    assert_close(rig.material.young_Pa, 5e6, 0.0);
    assert_close(rig.time_step_s, 6.25e-5, 0.0);
    // The grains poured fill a region 0.196747 m high to .3, over a bed 0.085 m high.
    assert_close(rig.packing.fill_factor * rig.box.z_max_m, 0.3 * 0.196747, 1e-6);
}

static void every_scene_that_is_shipped_loads(void **state)
{
    (void)state;
    DIR *const dir = opendir("config/scenes");
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
        if (strstr(entry->d_name, ".yaml") != NULL) {
            char path[512];
            (void)snprintf(path, sizeof path, "config/scenes/%s", entry->d_name);
            (void)read_scene(path);
        }
    }
    (void)closedir(dir);
}

static void the_example_of_the_formats_loads_as_it_is_written(void **state)
{
    (void)state;
    const struct dig_scene s = read_scene("tests/data/formats/scene.yaml");
    assert_string_equal(s.name, "tub");
    assert_int_equal(s.bucket.points, 4);
    assert_close(s.bucket.x_m[2], -0.12, 0.0);
    assert_close(s.bucket.z_m[2], -0.05, 0.0);
    assert_close(s.box.y_min_m, -0.3, 0.0);
    assert_close(s.packing.relax_s, 0.2, 0.0);
    assert_close(s.material.restitution, 0.2, 0.0);
    assert_int_equal(s.trajectories, 1);
    assert_int_equal(s.trajectory[0].phases, 2);
    assert_string_equal(s.trajectory[0].phase[1].name, "pull");
    assert_close(s.trajectory[0].phase[1].omega_radps, DIG_PI / 18.0, 1e-15);
    assert_close(s.trajectory[0].theta0_rad, -DIG_PI / 12.0, 1e-15);
}

static char *with(const char *const text, const char *const from, const char *const to)
{
    const char *const at = strstr(text, from);
    assert_non_null(at);
    const size_t size = strlen(text) + strlen(to) + 1;
    char *const  out  = malloc(size);
    assert_non_null(out);
    (void)snprintf(out, size, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return out;
}

static void hash_of(const char *const text, char hex[const 65])
{
    const struct dig_scene s = read_scene(scratch_write("scene.yaml", text));
    dig_scene_hash(&s, hex);
}

static void the_hash_is_of_what_is_meant_not_of_how_it_is_written(void **state)
{
    (void)state;
    size_t      size = 0;
    char *const text = scratch_read("tests/data/formats/scene.yaml", &size);
    char        before[65], after[65];
    hash_of(text, before);
    assert_int_equal(strlen(before), 64);

    static const char *const same[][2] = {
        { "name: tub\n", "name:   tub # a comment\n" },
        { "source: made up for this example\n", "" },
        { "young_Pa: 5.0e+6", "young_Pa: 5000000" },
        { "x: [0, 1.0]", "x:\n    - 0\n    - 1" },
    };
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++) {
        char *const other = with(text, same[i][0], same[i][1]);
        hash_of(other, after);
        assert_string_equal(before, after);
        free(other);
    }
    static const char *const differs[][2] = {
        { "name: tub", "name: tube" },
        { "young_Pa: 5.0e+6", "young_Pa: 5.1e+6" },
        { "x: [0, 1.0]", "x: [0, 1.01]" },
        { "omega_degps: 10", "omega_degps: 10.5" },
    };
    for (size_t i = 0; i < sizeof differs / sizeof differs[0]; i++) {
        char *const other = with(text, differs[i][0], differs[i][1]);
        hash_of(other, after);
        assert_string_not_equal(before, after);
        free(other);
    }
    free(text);
}

static void expect_refusal(const char *const text, const char *const says)
{
    struct dig_error error = { "" };
    struct dig_scene scene;
    memset(&scene, 0x5a, sizeof scene);
    const struct dig_scene untouched = scene;
    assert_int_equal(dig_scene_read(scratch_write("bad.yaml", text), &scene, &error), DIG_EINVAL);
    assert_memory_equal(&scene, &untouched, sizeof scene);
    assert_contains(error.text, says);
    assert_contains(error.text, "expected");
}

static void what_cannot_be_is_refused_with_line_and_key(void **state)
{
    (void)state;
    size_t                   size     = 0;
    char *const              text     = scratch_read("tests/data/formats/scene.yaml", &size);
    static const char *const bad[][3] = {
        { "young_Pa: 5.0e+6", "young_Pa: -1", "bad.yaml:22: material.young_Pa: -1" },
        { "y: [-0.3, 0.3]", "y: [0.3, -0.3]", "bad.yaml:12: box_m.y: [0.3, -0.3]" },
        { "y: [-0.3, 0.3]", "y: [0.3]", "bad.yaml:12: box_m.y: 1 values" },
        { "duration_s: 1,", "duration_s: 0,",
          "bad.yaml:35: trajectories[0].phases[1].duration_s: 0" },
        { "output_s: 0.005", "output_s: 0.5", "bad.yaml:28: output_s: 0.5" },
        { "    - [-0.12, -0.2]\n    - [-0.12, -0.05]\n", "",
          "bad.yaml:6: bucket.profile_m: 2 values" },
        { "name: scrape", "name: ''", "bad.yaml:30: trajectories[0].name: nothing" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char *const other = with(text, bad[i][0], bad[i][1]);
        expect_refusal(other, bad[i][2]);
        free(other);
    }
    free(text);
}

// Each key of the rig in turn is spelled wrongly: an unknown key is found by its own line.
static void every_key_is_known_and_needed(void **state)
{
    (void)state;
    size_t      size = 0;
    char *const text = scratch_read("tests/data/formats/scene.yaml", &size);
    int         line = 1;
    for (size_t i = 0; i + 1 < size; i++) {
        line += text[i] == '\n';
        if (text[i + 1] != ':' || !isalnum((unsigned char)text[i])) {
            continue;
        }
        const char kept = text[i];
        text[i]         = 'Q';
        char where[32];
        (void)snprintf(where, sizeof where, "bad.yaml:%d: ", line);
        expect_refusal(text, where);
        text[i] = kept;
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rig_is_the_scene_of_the_reference_digs),
        cmocka_unit_test(every_scene_that_is_shipped_loads),
        cmocka_unit_test(the_example_of_the_formats_loads_as_it_is_written),
        cmocka_unit_test(the_hash_is_of_what_is_meant_not_of_how_it_is_written),
        cmocka_unit_test(what_cannot_be_is_refused_with_line_and_key),
        cmocka_unit_test(every_key_is_known_and_needed),
    };
    return cmocka_run_group_tests_name("scene_yaml", tests, scratch_setup, scratch_teardown);
}
