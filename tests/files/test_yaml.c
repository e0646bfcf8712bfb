// Tests for files/yaml/yaml.c and files/yaml/yaml_tree.c

#include "files/yaml/yaml.h"

#include "tests/scratch.h"

#include <locale.h>
#include <stdbool.h>
#include <stdint.h>

struct part {
    double weight_kg;
    char   name[8];
};

struct thing {
    char        name[16];
    int         kind;
    int8_t      small;
    uint32_t    id;
    bool        on;
    double      pair[2];
    struct part inner;
    struct part parts[3];
    size_t      parts_count;
    double      turn_rad, step_s;
    bool        has_rate;
    int64_t     level;
};

static const struct dig_yaml_field part_fields[] = {
    NUMBER(part, weight_kg),
    FIELD(TEXT, "name", part, name, OPTIONAL, .least = 1),
    END,
};
static const struct dig_yaml_field part    = ENTRY(part, part_fields);
static const struct dig_yaml_word  kinds[] = { { "round", 1 }, { "square", 2 }, { .word = NULL } };
static const struct dig_yaml_field thing_fields[] = {
    TEXT(thing, name),
    FIELD(WORD, "kind", thing, kind, OPTIONAL, .word = kinds),
    FIELD(WHOLE, "small", thing, small, OPTIONAL),
    FIELD(COUNT, "id", thing, id, OPTIONAL),
    FIELD(BOOL, "on", thing, on, OPTIONAL),
    NUMBERS("pair", REQUIRED, thing, pair),
    PART("inner", REQUIRED, thing, inner, part_fields),
    LIST("parts", OPTIONAL, thing, parts, parts_count, &part, 0),
    FIELD(NUMBER, "turn_deg", thing, turn_rad, OPTIONAL, .low = -180.0, .high = 180.0,
          .factor = 0.0174532925),
    FIELD(NUMBER, "rate_Hz", thing, step_s, OPTIONAL, .low = 1.0, .high = 100.0, .factor = -1.0,
          GIVEN(thing, has_rate)),
    FIELD(WHOLE, "level", thing, level, OPTIONAL, .low = -3.0, .high = 3.0),
    END,
};
static const struct thing         defaults = { .step_s = 7.0, .level = 2 };
static const struct dig_yaml_file schema   = { .of       = thing_fields,
                                               .size     = sizeof(struct thing),
                                               .defaults = &defaults };

#define GOOD                                                                                       \
    "# a comment\n"                                                                                \
    "name: hammer\n"                                                                               \
    "kind: square\n"                                                                               \
    "small: -128\n"                                                                                \
    "id: 0x18FF79E8\n"                                                                             \
    "on: yes\n"                                                                                    \
    "pair: [1.5e-3, -2]\n"                                                                         \
    "inner:\n"                                                                                     \
    "  weight_kg: 1\n"                                                                             \
    "parts:\n"                                                                                     \
    "  - {weight_kg: 2, name: head}\n"                                                             \
    "  - weight_kg: 3\n"

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    (void)path;
    (void)c;
    (void)loaded;
}

// A thing without a name: nothing was read.
static enum dig_status read_thing(const char *const path, struct thing *const thing,
                                  struct dig_error *const error)
{
    *thing = (struct thing){ .name = "" };
    return dig_yaml_read(path, &schema, take, thing, error);
}

static void refuse(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    (void)path;
    dig_require(c, false, "inner.weight_kg: %g, expected 3",
                ((const struct thing *)loaded)->inner.weight_kg);
}

TEST(what_the_taker_refuses_is_refused)
{
    struct dig_error error = { "" };
    struct thing     thing = { .name = "" };
    assert_refused(dig_yaml_read(scratch_write("good.yaml", GOOD), &schema, refuse, &thing, &error),
                   error, DIG_EINVAL, "good.yaml:9: inner.weight_kg: 1, expected 3");
    assert_string_equal(thing.name, ""); // and nothing was written
}

TEST(what_fits_the_schema_is_loaded)
{
    struct dig_error          error = { "" };
    struct thing              thing;
    const struct thing *const t = &thing;
    assert_int_equal(read_thing(scratch_write("good.yaml", GOOD), &thing, &error), DIG_OK);
    assert_string_equal(t->name, "hammer");
    assert_int_equal(t->kind, 2);
    assert_int_equal(t->small, -128);
    assert_int_equal(t->id, 0x18FF79E8);
    assert_true(t->on);
    assert_close(t->pair[0], 1.5e-3, 1e-18);
    assert_close(t->pair[1], -2.0, 0.0);
    assert_close(t->inner.weight_kg, 1.0, 0.0);
    assert_int_equal(t->parts_count, 2);
    assert_string_equal(t->parts[0].name, "head");
    assert_close(t->parts[1].weight_kg, 3.0, 0.0);
}

TEST(numbers_are_kept_in_the_units_of_the_struct_and_what_is_absent_keeps_its_default)
{
    struct dig_error error = { "" };
    struct thing     thing;
    assert_int_equal(read_thing(scratch_write("good.yaml", GOOD), &thing, &error), DIG_OK);
    assert_close(thing.step_s, 7.0, 0.0);
    assert_int_equal(thing.level, 2);
    assert_false(thing.has_rate);
    assert_int_equal(
        read_thing(scratch_write("units.yaml", GOOD "turn_deg: -90\nrate_Hz: 50\nlevel: -3\n"),
                   &thing, &error),
        DIG_OK);
    assert_close(thing.turn_rad, -1.570796325, 1e-12);
    assert_close(thing.step_s, 0.02, 1e-15);
    assert_int_equal(thing.level, -3);
    assert_true(thing.has_rate);
}

TEST(a_comma_as_the_users_decimal_point_changes_nothing)
{
    struct thing thing;
    const char  *before = setlocale(LC_NUMERIC, "de_DE.UTF-8");
    assert_int_equal(read_thing(scratch_write("good.yaml", GOOD), &thing, NULL), DIG_OK);
    assert_close(thing.pair[0], 1.5e-3, 1e-18);
    (void)before; // where that locale is not installed nothing was changed, and nothing is shown
    (void)setlocale(LC_NUMERIC, "C");
}

// Every defect by file, line, key and expectation, and nothing is loaded.
TEST(every_defect_is_told_by_line_key_and_expectation)
{
    static const struct {
        const char *text, *line, *says;
    } bad[] = {
        { "", ":1: ", "empty, expected YAML" },
        { "# only this\n", ":1: ", "empty" },
        { "- a\n- b\n", ":1: ", "a list, expected a mapping of name, kind" },
        { "name: [\n", ":2: ", "expected YAML" },
        { "name: a\n\tkind: b\n", ":2: ", "expected YAML" },
        { "name: \"a\nb: c\n", ":3: ", "expected YAML" },
        { "name: \xff\xfe\n", ":1: ", "expected YAML" },
        { "name: a\npair: [1, 2]\n", ":1: ", "inner: missing, expected a mapping" },
        { "pair: [1, 2]\ninner: {weight_kg: 1}\n", ":1: ", "name: missing, expected a text" },
        { "name: a\npair: [1, 2]\ninner:\n  name: b\n",
          ":4: ", "inner.weight_kg: missing, expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\ncolour: red\n", ":4: ",
          "colour: unknown key, expected one of name, kind, small, id, on, pair, inner, parts, "
          "turn_deg" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\nname: b\n",
          ":4: ", "name: again (first on line 1), expected once" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: heavy}\n",
          ":3: ", "inner.weight_kg: \"heavy\", expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: nan}\n",
          ":3: ", "\"nan\", expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: .inf}\n", ":3: ", "expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 0x10}\n", ":3: ", "expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1e999}\n", ":3: ", "expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1 kg}\n", ":3: ", "expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: }\n",
          ":3: ", "inner.weight_kg: nothing, expected a number" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: [1]}\n", ":3: ", "a list, expected a number" },
        { "name: a\npair: [1]\ninner: {weight_kg: 1}\n", ":2: ", "pair: 1 values, expected 2" },
        { "name: a\npair: [1, 2, 3]\ninner: {weight_kg: 1}\n", ":2: ", "3 values, expected 2" },
        { "name: a\npair: [1, x]\ninner: {weight_kg: 1}\n",
          ":2: ", "pair[1]: \"x\", expected a number" },
        { "name: a\npair: 1\ninner: {weight_kg: 1}\n", ":2: ", "pair: \"1\", expected a list" },
        { "name: a\npair: [1, 2]\ninner: 5\n", ":3: ", "\"5\", expected a mapping of weight_kg" },
        { "name: {a: b}\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":1: ", "name: a mapping, expected a text" },
        { "name:\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":1: ", "name: nothing, expected a text" },
        { "name: a name that is much too long\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":1: ", "28 characters, expected at most 15" },
        { "name: a\nkind: oval\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":2: ", "kind: \"oval\", expected one of round, square" },
        { "name: a\nsmall: 128\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":2: ", "small: \"128\", expected a whole number" },
        { "name: a\nid: -1\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":2: ", "id: \"-1\", expected a whole number, not negative" },
        { "name: a\nid: 4294967296\npair: [1, 2]\ninner: {weight_kg: 1}\n", ":2: ", "id: " },
        { "name: a\nid: 1.5\npair: [1, 2]\ninner: {weight_kg: 1}\n", ":2: ", "id: " },
        { "name: a\non: maybe\npair: [1, 2]\ninner: {weight_kg: 1}\n",
          ":2: ", "on: \"maybe\", expected true or false" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\nparts:\n  - weight_kg: 1\n  - name: b\n",
          ":6: ", "parts[1].weight_kg: missing" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\nparts: [{weight_kg: 1}, {weight_kg: 1}, "
          "{weight_kg: 1}, {weight_kg: 1}]\n",
          ":4: ", "parts: 4 values, expected 0 to 3" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\n---\nname: b\n",
          ":5: ", "a second document, expected one" },
        { "name: a\npair: [1, 2]\ninner: *nowhere\n", ":3: ", "expected YAML" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\nrate_Hz: 0.5\n",
          ":4: ", "rate_Hz: 0.5, expected 1 … 100" },
        { "name: a\npair: [1, 2]\ninner: {weight_kg: 1}\nlevel: 4\n",
          ":4: ", "level: 4, expected -3 … 3" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_error  error = { "" };
        struct thing      thing;
        const char *const path = scratch_write("bad.yaml", bad[i].text);
        assert_int_equal(read_thing(path, &thing, &error), DIG_EINVAL);
        assert_string_equal(thing.name, "");
        assert_ptr_equal(strstr(error.text, path), error.text);
        assert_ptr_equal(strstr(error.text + strlen(path), bad[i].line), error.text + strlen(path));
        assert_contains(error.text, bad[i].says);
        assert_null(strchr(error.text, '\n'));
    }
}

TEST(a_file_that_cannot_be_read_is_told_with_the_systems_words)
{
    struct dig_error error = { "" };
    struct thing     thing;
    assert_int_equal(read_thing(scratch_path("absent.yaml"), &thing, &error), DIG_EIO);
    assert_contains(error.text, "absent.yaml: No such file");
    assert_int_equal(read_thing(scratch_dir, &thing, &error), DIG_EINVAL);
    assert_contains(error.text, "no regular file");
    assert_refused(read_thing(scratch_write_bytes("nul.yaml", "a: b\nc\0d", 8), &thing, &error),
                   error, DIG_EINVAL, "nul.yaml:2: a NUL byte, expected a text file");
}

TEST(a_value_is_found_by_its_dotted_key)
{
    const char *const path = scratch_write("good.yaml", GOOD);
    assert_int_equal(dig_yaml_line(path, "name"), 2);
    assert_int_equal(dig_yaml_line(path, "inner.weight_kg"), 9);
    assert_int_equal(dig_yaml_line(path, "pair[1]"), 7);
    assert_int_equal(dig_yaml_line(path, "parts[0].name"), 11);
    assert_int_equal(dig_yaml_line(path, "parts[1].weight_kg"), 12);
    assert_int_equal(dig_yaml_line(path, "parts[2].weight_kg"), 0);
    assert_int_equal(dig_yaml_line(path, "parts[1].name"), 0);
    assert_int_equal(dig_yaml_line(path, "name.first"), 0);
    assert_int_equal(dig_yaml_line(path, "nothing"), 0);
    assert_int_equal(dig_yaml_line(scratch_path("absent.yaml"), "name"), 0);
}

TEST(a_refusal_after_loading_names_the_nearest_line)
{
    const char *const path  = scratch_write("good.yaml", GOOD);
    struct dig_error  error = { "" };
    assert_refused(dig_yaml_refuse(path, &error, "parts[1].weight_kg: %d, expected 4", 3), error,
                   DIG_EINVAL, "good.yaml:12: parts[1].weight_kg: 3, expected 4");
    assert_int_equal(dig_yaml_refuse(path, &error, "parts[1].name: expected one"), DIG_EINVAL);
    assert_contains(error.text, "good.yaml:12: parts[1].name: expected one");
}

TEST(a_file_that_cannot_be_read_is_told_with_the_line_that_names_it)
{
    const char *const path  = scratch_write("good.yaml", GOOD);
    struct dig_error  error = { "x.csv: No such file" };
    assert_int_equal(dig_yaml_tell_namer(path, "parts[0].name", DIG_OK, &error), DIG_OK);
    assert_int_equal(dig_yaml_tell_namer(path, "parts[0].name", DIG_EINVAL, &error), DIG_EINVAL);
    assert_string_equal(error.text, "x.csv: No such file");
    assert_int_equal(dig_yaml_tell_namer(path, "parts[0].name", DIG_EIO, NULL), DIG_EIO);
    assert_refused(dig_yaml_tell_namer(path, "parts[0].name", DIG_EIO, &error), error, DIG_EIO,
                   "good.yaml:11: parts[0].name: x.csv: No such file");
}

// Whatever the bytes, the answer is a struct or a refusal. Each byte of a good file is replaced by
// bytes that mean something to YAML, and the file is cut at each length.
TEST(damaged_bytes_never_do_worse_than_a_refusal)
{
    static const char evil[] = "\x01\xff:{[&*!|>-%@'\"\n#\t ,";
    char              text[] = GOOD;
    for (size_t i = 0; i + 1 < sizeof text; i++) {
        for (size_t e = i % 3; e + 1 < sizeof evil; e += 3) {
            const char kept = text[i];
            text[i]         = evil[e];

            struct dig_error      error = { "" };
            struct thing          thing;
            const enum dig_status status =
                read_thing(scratch_write("evil.yaml", text), &thing, &error);
            assert_true((status == DIG_OK) == (thing.name[0] != '\0'));
            assert_true(status == DIG_OK || strstr(error.text, "evil.yaml:") != NULL);
            text[i] = kept;
        }
        struct dig_error      error = { "" };
        struct thing          thing;
        const enum dig_status cut =
            read_thing(scratch_write_bytes("cut.yaml", text, i), &thing, &error);
        assert_true((cut == DIG_OK) == (thing.name[0] != '\0'));
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
