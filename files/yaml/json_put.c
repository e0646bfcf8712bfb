// Writes by a schema: the other half of files/yaml/yaml_load.c. JSON is YAML.

#include "core/text.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static double number_at(const struct dig_yaml_field *const field, const char *const at)
{
    double kept;
    memcpy(&kept, at, sizeof kept);
    return field->factor > 0.0 ? kept / field->factor : field->factor < 0.0 ? 1.0 / kept : kept;
}

static uint64_t bits_at(const struct dig_yaml_field *const field, const char *const at)
{
    uint8_t  one;
    uint32_t four;
    uint64_t eight;
    switch (field->size) {
    case sizeof one: memcpy(&one, at, sizeof one); return one;
    case sizeof four: memcpy(&four, at, sizeof four); return four;
    default: memcpy(&eight, at, sizeof eight); return eight;
    }
}

static size_t length_of(const struct dig_yaml_field *const list, const char *const base)
{
    size_t length = list->size / list->of->size;
    if (list->count > 0) {
        memcpy(&length, base + list->count - 1, sizeof length);
    }
    return length;
}

// What reading leaves as it is anyway.
static bool is_left_out(const struct dig_yaml_field *const field, const char *const base)
{
    const double number =
        field->kind == DIG_YAML_NUMBER ? number_at(field, base + field->at) : (double)NAN;
    return field->kind == DIG_YAML_ANY ||
           (field->optional && (field->given > 0 ? base[field->given - 1] == 0
                                : field->kind == DIG_YAML_NUMBER
                                    ? !isfinite(number) || !(fabs(number) > 0.0)
                                    : field->kind == DIG_YAML_LIST && length_of(field, base) == 0));
}

// A reader refuses what is more than one line, and other control characters: they become '?'.
static void put_text(FILE *const to, const char *const text)
{
    char clean[4096];
    dig_text_copy(sizeof clean, clean, text);
    for (char *c = clean; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\t') {
            *c = '?';
        }
    }
    dig_text_put_json(to, clean);
}

static void put_scalar(FILE *const to, const struct dig_yaml_field *const field,
                       const char *const at)
{
    if (field->kind == DIG_YAML_TEXT) {
        put_text(to, at);
    } else if (field->kind == DIG_YAML_NUMBER) {
        const double number = number_at(field, at);
        (void)fprintf(to, "%.9g", isfinite(number) ? number : 0.0);
    } else if (field->kind == DIG_YAML_BOOL) {
        (void)fputs(bits_at(field, at) != 0 ? "true" : "false", to);
    } else if (field->kind == DIG_YAML_WORD) {
        const struct dig_yaml_word *word = field->word;
        while ((uint32_t)word->value != (uint32_t)bits_at(field, at)) {
            word++;
        }
        dig_text_put_json(to, word->word);
    } else {
        (void)fprintf(to, "%llu", (unsigned long long)bits_at(field, at));
    }
}

// These call each other as deep as the schema nests.
static void put_mapping(FILE *to, const struct dig_yaml_field fields[], const char *base,
                        int depth);

static void put_gap(FILE *const to, const int depth)
{
    (void)fprintf(to, "\n%*s", depth, "");
}

// Numbers sixteen a line, else an entry a line.
// NOLINTNEXTLINE(misc-no-recursion)
static void put_list(FILE *const to, const struct dig_yaml_field *const field,
                     const char *const base, const int depth)
{
    const bool   mappings = field->of->kind == DIG_YAML_MAPPING;
    const size_t length   = length_of(field, base);
    (void)fputc('[', to);
    for (size_t i = 0; i < length; i++) {
        const char *const at = base + field->at + i * field->of->size;
        (void)fputs(i > 0 ? "," : "", to);
        if (mappings) {
            put_gap(to, depth + 1);
            put_mapping(to, field->of->of, at, depth + 2);
        } else {
            assert(field->of->kind != DIG_YAML_LIST); // no file of ours that is written has any
            if (i > 0 && i % 16 == 0) {
                put_gap(to, depth + 1);
            } else {
                (void)fputs(i > 0 ? " " : "", to);
            }
            put_scalar(to, field->of, at);
        }
    }
    (void)fputc(']', to);
}

// What is more than a number or a text stands on lines of its own.
// NOLINTNEXTLINE(misc-no-recursion)
static void put_mapping(FILE *const to, const struct dig_yaml_field fields[],
                        const char *const base, const int depth)
{
    bool first  = true;
    bool before = false;
    (void)fputc('{', to);
    for (const struct dig_yaml_field *f = fields; f->key != NULL; f++) {
        if (is_left_out(f, base)) {
            continue;
        }
        const bool large = f->kind == DIG_YAML_MAPPING || f->kind == DIG_YAML_LIST;
        (void)fputs(first ? "" : ",", to);
        if (!first && (large || before)) {
            put_gap(to, depth);
        } else {
            (void)fputs(first ? "" : " ", to);
        }
        (void)fprintf(to, "\"%s\": ", f->key);
        if (f->kind == DIG_YAML_MAPPING) {
            put_mapping(to, f->of, base + f->at, depth + 1);
        } else if (f->kind == DIG_YAML_LIST) {
            put_list(to, f, base, depth + 1);
        } else {
            put_scalar(to, f, base + f->at);
        }
        first  = false;
        before = large;
    }
    (void)fputc('}', to);
}

void dig_json_write(FILE *const to, const struct dig_yaml_file *const schema,
                    const void *const from)
{
    assert(to != NULL && schema != NULL && from != NULL);
    put_mapping(to, schema->of, from, 1);
    (void)fputc('\n', to);
}
