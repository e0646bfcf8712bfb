// Tests for files/yaml/yaml_tree.c: texts that would take memory or time without end.
// end.

#include "files/campaign_yaml.h"

#include "tests/scratch.h"

#define REST "scene: s.yaml\nrecordings:\n  - {file: a.csv, trajectory: t, role: fit}\n"

static enum dig_status read_with(const char *const source, struct dig_error *const error)
{
    static char                text[400000];
    static struct dig_campaign campaign;
    (void)snprintf(text, sizeof text, "source: %s\n" REST, source);
    (void)scratch_write("campaign.yaml", text);
    return dig_campaign_read(scratch_dir, &campaign, error);
}

// A billion values, of which nothing reads more than its arrays hold.
TEST(aliases_that_grow_tenfold_line_by_line_do_no_harm)
{
    struct dig_error error = { "" };
    char             text[4000];
    size_t used = (size_t)snprintf(text, sizeof text, "\n  - &a [x, x, x, x, x, x, x, x, x, x]");
    for (char c = 'b'; c <= 'j'; c++) {
        const char p = (char)(c - 1);
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "\n  - &%c [*%c, *%c, *%c, *%c, *%c, *%c, *%c, *%c, *%c, *%c]", c,
                                 p, p, p, p, p, p, p, p, p, p);
    }
    assert_int_equal(read_with(text, &error), DIG_OK);
    (void)snprintf(text + used, sizeof text - used, "\nrecordings: *j\nscene: s\n");
    char whole[4100];
    (void)snprintf(whole, sizeof whole, "source:%s", text);
    static struct dig_campaign campaign;
    (void)scratch_write("campaign.yaml", whole);
    assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error), DIG_EINVAL);
    assert_contains(error.text, "recordings[0]: a list, expected a mapping");
}

TEST(an_alias_within_its_own_anchor_ends)
{
    static struct dig_campaign campaign;
    struct dig_error           error = { "" };
    assert_int_equal(read_with("&a [1, *a]", &error), DIG_OK);
    (void)scratch_write("campaign.yaml", "scene: s\nrecordings: &a [*a]\n");
    assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error), DIG_EINVAL);
    assert_contains(error.text, "campaign.yaml:2: recordings[0]: a list, expected a mapping");
}

TEST(what_nests_without_end_is_refused_at_once)
{
    static char      text[300001];
    struct dig_error error = { "" };
    memset(text, '[', sizeof text - 1);
    assert_int_equal(read_with(text, &error), DIG_EINVAL);
    assert_contains(error.text, "campaign.yaml:1: more than 64 open brackets");
    (void)snprintf(text, sizeof text, "%.60s%.60s",
                   "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
                   "]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]");
    assert_int_equal(read_with(text, NULL), DIG_OK);
}

TEST(anchors_without_number_are_refused_and_a_few_aliases_are_not)
{
    static char      text[20000];
    struct dig_error error = { "" };
    size_t           used  = (size_t)snprintf(text, sizeof text, "[");
    for (int i = 0; i < 1001; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "&a%d x, ", i);
    }
    (void)snprintf(text + used, sizeof text - used, "y]");
    assert_refused(read_with(text, &error), error, DIG_EINVAL, "more than 1000 anchors");
    assert_int_equal(read_with("[&a {x: 1}, *a, &b [*a, *a], *b]", NULL), DIG_OK);
}

// 20 MB of values took 1.6 GB.
TEST(a_text_of_more_than_two_megabytes_is_refused)
{
    static char                text[(2 << 20) + 100];
    static struct dig_campaign campaign;
    for (size_t size = 2 << 20; size <= (2 << 20) + 1; size++) {
        struct dig_error error = { "" };
        memset(text, ' ', size);
        memcpy(text, REST "#", strlen(REST "#"));
        text[size] = '\0';
        (void)scratch_write("campaign.yaml", text);
        assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error),
                         size == 2 << 20 ? DIG_OK : DIG_EINVAL);
        assert_int_equal(strstr(error.text, "2097153 bytes, expected at most") != NULL,
                         size != 2 << 20);
    }
}

// Each is compared with all before it: 50,000 took five seconds.
TEST(directives_without_number_are_refused_and_a_few_are_not)
{
    static char                text[40000];
    static struct dig_campaign campaign;
    for (int n = 1000; n <= 1001; n++) {
        struct dig_error error = { "" };
        size_t           used  = 0;
        for (int k = 0; k < n; k++) {
            used += (size_t)snprintf(text + used, sizeof text - used, "%%TAG !a%d! tag:x:\n", k);
        }
        (void)snprintf(text + used, sizeof text - used, "---\n" REST);
        (void)scratch_write("campaign.yaml", text);
        assert_int_equal(dig_campaign_read(scratch_dir, &campaign, &error),
                         n == 1000 ? DIG_OK : DIG_EINVAL);
        assert_int_equal(strstr(error.text, "campaign.yaml:1001: more than 1000") != NULL,
                         n != 1000);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
