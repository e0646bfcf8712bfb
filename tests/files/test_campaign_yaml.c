// Tests for files/campaign_yaml.c

#include "files/campaign_yaml.h"

#include "tests/scratch.h"

TEST(the_example_of_the_formats_loads_as_it_is_written)
{
    static struct dig_campaign campaign;
    assert_int_equal(dig_campaign_read("tests/data/formats/campaign", &campaign, NULL), DIG_OK);
    assert_string_equal(campaign.scene, "tests/data/formats/campaign/../scene.yaml");
    assert_string_equal(campaign.machine, "tests/data/formats/campaign/../machine.yaml");
    assert_int_equal(campaign.recordings, 4);
    assert_string_equal(campaign.recording[0].file, "tests/data/formats/campaign/a1.csv");
    assert_string_equal(campaign.recording[3].trajectory, "actual");
    assert_int_equal(campaign.recording[0].role, DIG_ROLE_IDENTIFY);
    assert_int_equal(campaign.recording[1].role, DIG_ROLE_FIT);
    assert_int_equal(campaign.recording[3].role, DIG_ROLE_HOLDOUT);
    assert_int_equal(campaign.recording[2].pass, 1); // not given: the first
    assert_int_equal(campaign.recording[3].pass, 2);
}

#define ONE "recordings:\n  - {file: a.csv, trajectory: t, role: fit}\n"

TEST(absolute_paths_stay_and_the_machine_may_be_missing)
{
    static struct dig_campaign campaign;
    (void)scratch_write("campaign.yaml", "scene: /somewhere/scene.yaml\n" ONE);
    assert_int_equal(dig_campaign_read(scratch_dir, &campaign, NULL), DIG_OK);
    assert_string_equal(campaign.scene, "/somewhere/scene.yaml");
    assert_string_equal(campaign.machine, "");
    assert_string_equal(campaign.recording[0].file, scratch_path("a.csv"));
}

TEST(what_a_campaign_cannot_be_is_refused_with_file_line_and_key)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        { ONE, "scene" },
        { "scene: s.yaml\n", "recordings" },
        { "scene: s.yaml\nrecordings: []\n", "recordings" },
        { "scene: s.yaml\nrecordings:\n  - {file: a.csv, trajectory: t, role: spare}\n",
          "campaign.yaml:3: recordings[0].role: \"spare\", expected one of identify, fit, "
          "holdout" },
        { "scene: s.yaml\nrecordings:\n  - {trajectory: t, role: fit}\n", "file" },
        { "scene: s.yaml\nrecordings:\n  - {file: a.csv, role: fit}\n", "trajectory" },
        { "scene: s.yaml\nrecordings:\n  - {file: a.csv, trajectory: t}\n", "role" },
        { "scene: s.yaml\nrecordings:\n  - {file: a, trajectory: t, role: fit, pass: -1}\n",
          "pass" },
        { "scene: s.yaml\nrecordings:\n  - {file: a, trajectory: t, role: fit, pass: 0}\n",
          "campaign.yaml:3: recordings[0].pass: 0, expected 1 where" },
        { "scene: s.yaml\nweather: fine\n" ONE, "weather" },
        { "scene: [a, b]\n" ONE, "scene" },
        { "scene: s.yaml\nrecordings:\n  - {file: a, trajectory: "
          "a_name_that_is_far_longer_than_any_name_may_be, role: fit}\n",
          "trajectory" },
        { "scene: \"s\n", "campaign.yaml" },
        { "scene: \"s\\n.yaml\"\n" ONE, "campaign.yaml:1: scene: \"s" },
        { "scene: \"\\x1b]0;owned\\x07\"\n" ONE, "scene: \"?]0;owned?\"" },
        { "scene: s\nrecordings:\n  - {file: \"a\\nb\", trajectory: t, role: fit}\n",
          "campaign.yaml:3: recordings[0].file: " },
        { "scene: s\nrecordings:\n  - {file: \"a\\x85\", trajectory: t, role: fit}\n", "file: " },
        { "scene: s\nrecordings:\n  - {file: ../a.csv, trajectory: t, role: fit}\n",
          "campaign.yaml:3: recordings[0].file: \"../a.csv\" leaves the campaign's folder" },
        { "scene: s\nrecordings:\n  - {file: a/../../b, trajectory: t, role: fit}\n", "leaves" },
        { "scene: s\nrecordings:\n  - {file: /dev/zero, trajectory: t, role: fit}\n",
          "no regular file" },
        { "scene: s\nrecordings:\n  - {file: a, trajectory: ../t, role: fit}\n",
          "campaign.yaml:3: recordings[0].trajectory: \"../t\", expected a name" },
        { "scene: s\nrecordings:\n  - {file: a, trajectory: \"`touch OWNED`\", role: fit}\n",
          "recordings[0].trajectory: " },
        { "scene: s\nrecordings:\n  - {file: a, trajectory: t, role: fit}\n"
          "  - {file: a, trajectory: t, role: holdout}\n",
          "campaign.yaml:4: recordings[1].file: that of recordings[0]" },
    };
    static struct dig_campaign campaign;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_error error = { "" };
        campaign.recordings    = 42;
        (void)scratch_write("campaign.yaml", bad[i].text);
        assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error), DIG_EINVAL);
        assert_contains(error.text, bad[i].says);
        assert_int_equal(campaign.recordings, 42);
    }
}

TEST(folder_without_a_campaign_is_refused)
{
    static struct dig_campaign campaign;
    struct dig_error           error = { "" };
    (void)unlink(scratch_path("campaign.yaml"));
    assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error), DIG_EIO);
    assert_contains(error.text, "campaign.yaml");
}

TEST(path_too_long_is_refused)
{
    static struct dig_campaign campaign;
    struct dig_error           error = { "" };
    char                       deep[601];
    memset(deep, 'x', sizeof deep - 1);
    deep[sizeof deep - 1] = '\0';
    assert_refused(dig_campaign_read(deep, &campaign, &error), error, DIG_EINVAL, "shorter");
}

TEST(folder_is_told_from_a_file)
{
    assert_true(dig_campaign_is(scratch_dir));
    assert_false(dig_campaign_is(scratch_write("a.csv", "t_s\n")));
    assert_false(dig_campaign_is(scratch_path("nothing")));
}

TESTS_WITH(scratch_setup, scratch_teardown)
