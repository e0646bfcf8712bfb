// Every writer of ours, given texts that mean harm where they end up: what it writes is whole, is
// printable UTF-8, and is read back or refused by name. What a terminal and a shell are given:
// tests/core/test_text.c and test_shell.c.

#include "closed_loop/report/html.h"
#include "core/name.h"
#include "core/text.h"
#include "files/identity_json.h"
#include "files/lcm/lcm_log.h"
#include "files/model_json.h"
#include "files/scene_yaml.h"
#include "files/yaml/yaml_tree.h"
#include "firmware_host/publish/output.h"
#include "tests/tables_fixture.h"

static char long_text[2000];

static const char *const hostile[] = {
    "\"",
    "'",
    "\\",
    "\\\"",
    "a\nb",
    "a\r\nb",
    "\t",
    "\x1b[2J\x1b]0;owned\x07",
    "\x7f",
    "\x01",
    "\xc2\x9b[31m",
    "</script><script>alert(1)</script>",
    "<!--",
    "]]>",
    "&lt;",
    "%n%s%n",
    "`id`",
    "$(id)",
    "${IFS}",
    "; id",
    "|id",
    "# no comment",
    ": no key",
    "- no list",
    "{a: b}",
    "*alias",
    "&anchor",
    "!!tag",
    "null",
    "a,b;c",
    "=1+1",
    "@SUM(1)",
    "../../etc/passwd",
    "/dev/null",
    "-rf",
    "\xff\xfe",
    "\xc3",
    "\xe2\x82",
    "\xed\xa0\x80",
    "\xf5\x80\x80\x80",
    "\xef\xbf\xbe",
    "\xe2\x80\xae turned",
    "a b",
    "END",
    long_text,
};
enum { TEXTS = sizeof hostile / sizeof hostile[0] };

static int setup(void **state)
{
    memset(long_text, 'x', sizeof long_text - 1);
    return scratch_setup(state);
}

static void assert_printable(const char *const text)
{
    const char *c = text;
    for (size_t n; (n = dig_text_character(c)) > 0;) {
        c += n;
    }
    if (*c != '\0') {
        fail_msg("byte %02x is shown", (unsigned char)*c);
    }
}

// UTF-8 throughout, whatever it means.
static bool is_utf8(const char *const text)
{
    const char *c = text;
    for (size_t n; *c != '\0'; c += n) {
        const bool control = (unsigned char)*c < 0x20 || *c == '\x7f';
        n                  = control ? 1 : dig_text_character(c);
        n                  = n == 0 && strncmp(c, "\xc2\x9b", 2) == 0 ? 2 : n;
        if (n == 0) {
            return false;
        }
    }
    return true;
}

// What a writer writes, malloc'ed.
static char *written(void (*const put)(FILE *, const char *), const char *const text)
{
    char       *bytes = NULL;
    size_t      size  = 0;
    FILE *const to    = open_memstream(&bytes, &size);
    assert_non_null(to);
    put(to, text);
    assert_int_equal(fclose(to), 0);
    assert_int_equal(strlen(bytes), size);
    return bytes;
}

TEST(pages_hold_no_markup_of_a_text)
{
    for (size_t i = 0; i < TEXTS; i++) {
        char *const html = written(dig_html_text, hostile[i]);
        assert_printable(html);
        assert_null(strpbrk(html, "<>\"'"));
        free(html);
        char *const name = written(dig_html_without_folders, hostile[i]);
        assert_printable(name);
        assert_null(strpbrk(name, "<>\"'"));
        free(name);
        char *const page = written(dig_html_begin, hostile[i]);
        assert_printable(page);
        assert_null(strstr(page, "<script"));
        free(page);
    }
}

TEST(json_strings_come_back)
{
    for (size_t i = 0; i < TEXTS; i++) {
        char *const      json = written(dig_text_put_json, hostile[i]);
        yaml_document_t  document;
        struct dig_error error = { "" };
        assert_printable(json);
        if (dig_yaml_parse("json", json, strlen(json), &document, &error) != DIG_OK) {
            fail_msg("%s: %s", json, error.text);
        }
        const yaml_node_t *const root = yaml_document_get_root_node(&document);
        assert_int_equal(root->type, YAML_SCALAR_NODE);
        if (is_utf8(hostile[i])) {
            assert_string_equal(dig_yaml_text_of(root), hostile[i]);
        }
        yaml_document_delete(&document);
        free(json);
    }
}

TEST(a_model_with_such_texts_is_read_back_and_one_with_such_names_is_not)
{
    for (size_t i = 0; i < TEXTS; i++) {
        static struct dig_model model, back;
        struct dig_error        error = { "" };
        const char *const       path  = scratch_path("model.json");
        model                         = (struct dig_model){ .effects = 1 };
        model.effect[0] = (struct dig_model_effect){ .effect      = DIG_EFFECT_CYLINDER_FRICTION,
                                                     .probability = 1,
                                                     .parameters  = 1 };
        memset(model.scene_hash, 'a', 64);
        (void)snprintf(model.table, sizeof model.table, "%s", hostile[i]);
        (void)snprintf(model.provenance, sizeof model.provenance, "%s", hostile[i]);
        (void)snprintf(model.effect[0].parameter[0].name, DIG_NAME_SIZE, "coulomb_N");
        assert_int_equal(dig_model_save(path, &model, &error), DIG_OK);
        if (dig_model_read(path, &back, &error) != DIG_OK) {
            fail_msg("%s", error.text);
        }
        assert_printable(back.table);
        assert_printable(back.provenance);
        assert_true(!dig_path_ok(model.table) || strcmp(back.table, model.table) == 0);

        (void)snprintf(model.effect[0].parameter[0].name, DIG_NAME_SIZE, "%s", hostile[i]);
        const bool is_name = dig_name_ok(model.effect[0].parameter[0].name);
        assert_int_equal(dig_model_save(path, &model, &error), DIG_OK);
        assert_int_equal(dig_model_read(path, &back, &error), is_name ? DIG_OK : DIG_EINVAL);
        assert_printable(error.text);
    }
}

TEST(a_scene_with_such_a_name_is_no_scene_and_no_table)
{
    size_t      size  = 0;
    char *const whole = scratch_read("tests/data/formats/scene.yaml", &size);
    for (size_t i = 0; i < TEXTS; i++) {
        static struct dig_scene scene;
        struct dig_error        error = { "" };
        FILE *const             file  = fopen(scratch_path("scene.yaml"), "w");
        assert_non_null(file);
        (void)fputs("name: ", file);
        dig_text_put_json(file, hostile[i]);
        (void)fputs(strchr(whole, '\n'), file);
        assert_int_equal(fclose(file), 0);
        const enum dig_status status = dig_scene_read(scratch_path("scene.yaml"), &scene, &error);
        const bool is_name = dig_name_ok(hostile[i]) && strlen(hostile[i]) < DIG_NAME_SIZE;
        assert_int_equal(status, is_name ? DIG_OK : DIG_EINVAL);
        assert_printable(error.text);

        struct dig_scene  named = fixture_scene();
        struct dig_store *store = NULL;
        (void)snprintf(named.trajectory[0].name, DIG_NAME_SIZE, "%s", hostile[i]);
        if (!dig_name_ok(named.trajectory[0].name)) {
            assert_int_equal(dig_store_create(scratch_path("t.sqlite"), &named, &store, &error),
                             DIG_EINVAL);
            assert_printable(error.text);
            assert_false(scratch_exists("t.sqlite"));
        }
    }
    free(whole);
}

TEST(no_run_with_such_an_engine_is_stored_for_an_export_to_print)
{
    struct dig_store *const    store     = fixture_create("runs.sqlite");
    const struct dig_recording recording = fixture_recording(400, 1.0);
    for (size_t i = 0; i < TEXTS; i++) {
        struct dig_run_origin origin = fixture_origin(.3, .3, 2500, i, 0);
        struct dig_error      error  = { "" };
        (void)snprintf(origin.version, sizeof origin.version, "%s", hostile[i]);
        const enum dig_status status = dig_store_put(store, &origin, &recording, &error);
        assert_int_equal(status, dig_label_ok(origin.version) ? DIG_OK : DIG_EINVAL);
        assert_true(status == DIG_OK || strpbrk(origin.version, ",\"\n") != NULL ||
                    !dig_label_ok(origin.version));
        assert_printable(error.text);
    }
    dig_store_close(store);
}

static void on_health(void *const context, const int64_t time_us, const digsight_health_t *const m)
{
    (void)time_us;
    assert_printable(m->note);
    assert_printable(m->input);
    ++*(size_t *)context;
}

TEST(what_the_daemon_publishes_is_printable)
{
    char url[600];
    (void)snprintf(url, sizeof url, "file://%s?mode=w", scratch_path("health.lcm"));
    struct dig_output *output = NULL;
    assert_int_equal(dig_output_create(url, &output, NULL), DIG_OK);
    for (size_t i = 0; i < TEXTS; i++) {
        static const struct dig_fit_counters none;
        struct dig_input                     input = { .connected = true };
        (void)snprintf(input.name, sizeof input.name, "%s", hostile[i]);
        const struct dig_health health = {
            .state = "running", .note = hostile[i], .input = &input, .fit = &none, .table = "abc"
        };
        assert_int_equal(dig_output_health(output, &health), DIG_OK);
    }
    dig_output_destroy(output);
    size_t                      seen   = 0;
    const struct dig_lcm_reader reader = { .context = &seen, .health = on_health };
    assert_int_equal(dig_lcm_log_each(scratch_path("health.lcm"), &reader, NULL), DIG_OK);
    assert_int_equal(seen, TEXTS);
}

TESTS_WITH(setup, scratch_teardown)
