// Tests for files/yaml/yaml_growth.c: small texts that stand for more than memory holds.

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

TEST(aliases_that_grow_tenfold_line_by_line_are_refused)
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
    assert_int_equal(read_with(text, &error), DIG_EINVAL);
    assert_contains(error.text, "campaign.yaml:6: aliases stand for more than 100000 values");
}

TEST(an_alias_within_its_own_anchor_is_refused)
{
    struct dig_error error = { "" };
    assert_int_equal(read_with("&a [1, *a]", &error), DIG_EINVAL);
    assert_contains(error.text, "campaign.yaml:1: an alias within its own anchor");
    assert_int_equal(read_with("&a {x: {y: *a}}", &error), DIG_EINVAL);
}

TEST(what_nests_without_end_is_refused_at_once)
{
    static char      text[300001];
    struct dig_error error = { "" };
    memset(text, '[', sizeof text - 1);
    assert_int_equal(read_with(text, &error), DIG_EINVAL);
    assert_contains(error.text, "campaign.yaml:1: nested deeper than 64");
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
    for (int i = 0; i < 300; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "&a%d x, ", i);
    }
    (void)snprintf(text + used, sizeof text - used, "y]");
    assert_refused(read_with(text, &error), error, DIG_EINVAL, "more than 256 anchors");
    assert_int_equal(read_with("[&a {x: 1}, *a, &b [*a, *a], *b]", NULL), DIG_OK);
}

// 20 MB of them took 1.6 GB.
TEST(values_without_number_are_refused_and_many_are_not)
{
    static char text[2200000];
    for (size_t n = 990000; n <= 1010000; n += 20000) {
        size_t used = (size_t)snprintf(text, sizeof text, "source: [x");
        for (size_t i = 0; i < n; i++) {
            memcpy(text + used, ",x", 2);
            used += 2;
        }
        (void)snprintf(text + used, sizeof text - used, "]\n" REST);
        (void)scratch_write("campaign.yaml", text);
        static struct dig_campaign campaign;
        struct dig_error           error  = { "" };
        const enum dig_status      status = dig_campaign_read(scratch_dir, &campaign, &error);
        assert_int_equal(status, n < 1000000 ? DIG_OK : DIG_EINVAL);
        if (n > 1000000) {
            assert_contains(error.text, "campaign.yaml:1: more than 1000000 values");
        }
    }
}

// Each is compared with all before it: 50,000 took five seconds. libyaml knows five ends of a line.
TEST(directives_without_number_are_refused_and_a_few_are_not)
{
    static const char *const ends[] = { "\n",       "\r\n",         "\r",
                                        "\xC2\x85", "\xE2\x80\xA8", "\xE2\x80\xA9" };
    for (int i = 0; i < 12; i++) {
        static struct dig_campaign campaign;
        struct dig_error           error = { "" };
        char                       text[1000];
        size_t                     used = 0;
        const int                  n    = 8 + i / 6;
        for (int k = 0; k < n; k++) {
            used += (size_t)snprintf(text + used, sizeof text - used, "%%TAG !a%d! tag:x:%s", k,
                                     ends[i % 6]);
        }
        (void)snprintf(text + used, sizeof text - used, "---\n" REST);
        (void)scratch_write("campaign.yaml", text);
        const enum dig_status status = dig_campaign_read(scratch_dir, &campaign, &error);
        assert_int_equal(status, n == 8 ? DIG_OK : DIG_EINVAL);
        if (n == 9) {
            assert_contains(error.text, "campaign.yaml:9: more than 8 directives");
        }
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
