// Checks a document against a schema.

#include "files/yaml/yaml_tree.h"

#include "core/did_you_mean.h"
#include "core/text.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define KEY_SIZE 160

// Where the check stands: the dotted key of the value being looked at.
struct check {
    const char       *path;
    yaml_document_t  *document;
    struct dig_error *error;
};

struct key {
    char text[KEY_SIZE];
};

static struct key member_of(const struct key *const parent, const char *const name)
{
    struct key key;
    (void)snprintf(key.text, sizeof key.text, "%.100s%s%.56s", parent->text,
                   parent->text[0] == '\0' ? "" : ".", name);
    return key;
}

static struct key element_of(const struct key *const parent, const size_t index)
{
    struct key key;
    (void)snprintf(key.text, sizeof key.text, "%.130s[%zu]", parent->text, index);
    return key;
}

__attribute__((format(printf, 4, 5))) static enum dig_status refuse(const struct check *const check,
                                                                    const yaml_node_t *const  at,
                                                                    const struct key *const   key,
                                                                    const char *const format, ...)
{
    char    why[320];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return dig_error_set(check->error, DIG_EINVAL, "%s:%d: %s%s%s", check->path,
                         dig_yaml_line_of(at), key->text, key->text[0] == '\0' ? "" : ": ", why);
}

// What a schema wants, for people.
static const char *const wanted[CYAML__TYPE_COUNT] = {
    [CYAML_INT] = "a whole number",    [CYAML_UINT] = "a whole number, not negative",
    [CYAML_BOOL] = "true or false",    [CYAML_ENUM] = "a text",
    [CYAML_STRING] = "a text",         [CYAML_FLOAT] = "a number",
    [CYAML_MAPPING] = "a mapping",     [CYAML_SEQUENCE] = "a list",

    [CYAML_SEQUENCE_FIXED] = "a list",
};

// What stands there instead.
static const char *stands(const yaml_node_t *const node, const size_t size, char text[const])
{
    if (node->type == YAML_MAPPING_NODE) {
        return "a mapping";
    }
    if (node->type == YAML_SEQUENCE_NODE) {
        return "a list";
    }
    if (dig_yaml_text_of(node)[0] == '\0') {
        return "nothing";
    }
    (void)snprintf(text, size, "\"%.60s\"", dig_yaml_text_of(node));
    return text;
}

static bool is_signed(const char *const text, const uint32_t bytes)
{
    char *end              = NULL;
    errno                  = 0;
    const long long number = strtoll(text, &end, 0);
    if (isspace((unsigned char)text[0]) || end == text || *end != '\0' || errno != 0) {
        return false;
    }
    const long long most = bytes >= 8 ? INT64_MAX : (1LL << (8 * bytes - 1)) - 1;
    return number <= most && number >= -most - 1;
}

static bool is_unsigned(const char *const text, const uint32_t bytes)
{
    char *end                       = NULL;
    errno                           = 0;
    const unsigned long long number = strtoull(text, &end, 0);
    if (!isdigit((unsigned char)text[0]) || end == text || *end != '\0' || errno != 0) {
        return false;
    }
    return bytes >= 8 || number < (1ULL << (8 * bytes));
}

// libcyaml takes every word it does not know for true.
static bool is_bool(const char *const text)
{
    return strcasecmp(text, "true") == 0 || strcasecmp(text, "false") == 0 ||
           strcasecmp(text, "yes") == 0 || strcasecmp(text, "no") == 0;
}

static enum dig_status check_word(const struct check *const check, const yaml_node_t *const node,
                                  const cyaml_schema_value_t *const schema,
                                  const struct key *const           key)
{
    char list[200] = "";
    for (uint32_t i = 0; i < schema->enumeration.count; i++) {
        const char *const word = schema->enumeration.strings[i].str;
        if (strcmp(word, dig_yaml_text_of(node)) == 0) {
            return DIG_OK;
        }
        dig_text_list(sizeof list, list, word);
    }
    return refuse(check, node, key, "\"%.60s\", expected one of %s", dig_yaml_text_of(node), list);
}

static enum dig_status check_length(const struct check *const check, const yaml_node_t *const node,
                                    const cyaml_schema_value_t *const schema,
                                    const struct key *const           key)
{
    // libyaml lets through what an escape such as "\\x1b" puts into a text.
    const bool  in_one_line = schema->string.max != CYAML_UNLIMITED;
    const char *c           = dig_yaml_text_of(node);
    for (size_t n;
         (n = dig_text_character(c)) > 0 && !(in_one_line && (*c == '\n' || *c == '\t'));) {
        c += n;
    }
    if (*c != '\0') {
        return refuse(check, node, key,
                      "\"%.60s\" with a control character or a line break, expected none",
                      dig_yaml_text_of(node));
    }
    const size_t length = strlen(dig_yaml_text_of(node));
    if (length < schema->string.min) {
        return refuse(check, node, key, "%s, expected a text of at least %u characters",
                      length == 0 ? "nothing" : "too short", schema->string.min);
    }
    if (length > schema->string.max) {
        return refuse(check, node, key, "\"%.30s…\" of %zu characters, expected at most %u",
                      dig_yaml_text_of(node), length, schema->string.max);
    }
    return DIG_OK;
}

static enum dig_status check_scalar(const struct check *const check, const yaml_node_t *const node,
                                    const cyaml_schema_value_t *const schema,
                                    const struct key *const           key)
{
    char seen[80];
    if (node->type != YAML_SCALAR_NODE) {
        return refuse(check, node, key, "%s, expected %s", stands(node, sizeof seen, seen),
                      wanted[schema->type]);
    }
    if (schema->type == CYAML_ENUM) {
        return check_word(check, node, schema, key);
    }
    if (schema->type == CYAML_STRING) {
        return check_length(check, node, schema, key);
    }
    double            number = 0.0;
    const char *const text   = dig_yaml_text_of(node);
    const bool        fits   = schema->type == CYAML_INT    ? is_signed(text, schema->data_size)
                               : schema->type == CYAML_UINT ? is_unsigned(text, schema->data_size)
                               : schema->type == CYAML_BOOL ? is_bool(text)
                                                            : dig_text_number(text, &number);
    return fits ? DIG_OK
                : refuse(check, node, key, "%s, expected %s", stands(node, sizeof seen, seen),
                         wanted[schema->type]);
}

// These call each other as deep as the schema nests, which is finite; the document, with its
// aliases, need not be.
static enum dig_status check_value(const struct check *check, const yaml_node_t *node,
                                   const cyaml_schema_value_t *schema, const struct key *key);

static const cyaml_schema_field_t *field_of(const cyaml_schema_value_t *const schema,
                                            const char *const                 name)
{
    const cyaml_schema_field_t *field = schema->mapping.fields;
    while (field->key != NULL && strcmp(field->key, name) != 0) {
        field++;
    }
    return field->key != NULL ? field : NULL;
}

static const char *keys_of(const cyaml_schema_value_t *const schema, const size_t size,
                           char text[const])
{
    text[0] = '\0';
    for (const cyaml_schema_field_t *f = schema->mapping.fields; f->key != NULL; f++) {
        dig_text_list(size, text, f->key);
    }
    return text;
}

// The line on which this name stood before, in the same mapping; 0 if it did not.
static int line_before(const struct check *const check, const yaml_node_t *const map,
                       const yaml_node_pair_t *const until)
{
    const yaml_node_t *const again = yaml_document_get_node(check->document, until->key);
    for (const yaml_node_pair_t *pair = map->data.mapping.pairs.start; pair < until; pair++) {
        const yaml_node_t *const key = yaml_document_get_node(check->document, pair->key);
        if (strcmp(dig_yaml_text_of(key), dig_yaml_text_of(again)) == 0) {
            return dig_yaml_line_of(key);
        }
    }
    return 0;
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status check_mapping(const struct check *const check, const yaml_node_t *const map,
                                     const cyaml_schema_value_t *const schema,
                                     const struct key *const           at)
{
    char list[200] = "";
    char seen[80];
    if (map->type != YAML_MAPPING_NODE) {
        return refuse(check, map, at, "%s, expected a mapping of %s",
                      stands(map, sizeof seen, seen), keys_of(schema, sizeof list, list));
    }
    for (const yaml_node_pair_t *pair = map->data.mapping.pairs.start;
         pair < map->data.mapping.pairs.top; pair++) {
        const yaml_node_t *const name = yaml_document_get_node(check->document, pair->key);
        if (name->type != YAML_SCALAR_NODE) {
            return refuse(check, name, at, "%s as a key, expected a text",
                          stands(name, sizeof seen, seen));
        }
        const struct key                  key   = member_of(at, dig_yaml_text_of(name));
        const cyaml_schema_field_t *const field = field_of(schema, dig_yaml_text_of(name));
        if (field == NULL) {
            char             text[DIG_GUESS_SIZE];
            struct dig_guess guess = dig_guess(dig_yaml_text_of(name));
            for (const cyaml_schema_field_t *f = schema->mapping.fields; f->key != NULL; f++) {
                dig_guess_try(&guess, f->key);
            }
            return refuse(check, name, &key, "unknown key, expected one of %s%s",
                          keys_of(schema, sizeof list, list), dig_guess_text(&guess, "", text));
        }
        const int before = line_before(check, map, pair);
        if (before != 0) {
            return refuse(check, name, &key, "again (first on line %d), expected once", before);
        }
        const enum dig_status status = check_value(
            check, yaml_document_get_node(check->document, pair->value), &field->value, &key);
        if (status != DIG_OK) {
            return status;
        }
    }
    for (const cyaml_schema_field_t *f = schema->mapping.fields; f->key != NULL; f++) {
        if ((f->value.flags & CYAML_FLAG_OPTIONAL) == 0 &&
            dig_yaml_value(check->document, map, f->key) == NULL) {
            const struct key key = member_of(at, f->key);
            return refuse(check, map, &key, "missing, expected %s", wanted[f->value.type]);
        }
    }
    return DIG_OK;
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status check_list(const struct check *const check, const yaml_node_t *const list,
                                  const cyaml_schema_value_t *const schema,
                                  const struct key *const           at)
{
    char seen[80];
    if (list->type != YAML_SEQUENCE_NODE) {
        return refuse(check, list, at, "%s, expected a list", stands(list, sizeof seen, seen));
    }
    const yaml_node_item_t *const first = list->data.sequence.items.start;
    const size_t                  count = (size_t)(list->data.sequence.items.top - first);
    if (count < schema->sequence.min || count > schema->sequence.max) {
        if (schema->sequence.min == schema->sequence.max) {
            return refuse(check, list, at, "%zu values, expected %u", count, schema->sequence.min);
        }
        return refuse(check, list, at, "%zu values, expected %u to %u", count, schema->sequence.min,
                      schema->sequence.max);
    }
    for (size_t i = 0; i < count; i++) {
        const struct key      key    = element_of(at, i);
        const enum dig_status status = check_value(
            check, yaml_document_get_node(check->document, first[i]), schema->sequence.entry, &key);
        if (status != DIG_OK) {
            return status;
        }
    }
    return DIG_OK;
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status check_value(const struct check *const check, const yaml_node_t *const node,
                                   const cyaml_schema_value_t *const schema,
                                   const struct key *const           key)
{
    const bool may_be_null = (schema->flags & CYAML_FLAG_POINTER_NULL) == CYAML_FLAG_POINTER_NULL;
    if (may_be_null && node->type == YAML_SCALAR_NODE && dig_yaml_text_of(node)[0] == '\0') {
        return DIG_OK;
    }
    // No file of ours has flags or bit fields.
    assert(schema->type != CYAML_FLAGS && schema->type != CYAML_BITFIELD);
    if (schema->type == CYAML_MAPPING) {
        return check_mapping(check, node, schema, key);
    }
    if (schema->type == CYAML_SEQUENCE || schema->type == CYAML_SEQUENCE_FIXED) {
        return check_list(check, node, schema, key);
    }
    return schema->type == CYAML_IGNORE ? DIG_OK : check_scalar(check, node, schema, key);
}

enum dig_status dig_yaml_check(const char *const path, yaml_document_t *const document,
                               const cyaml_schema_value_t *const schema,
                               struct dig_error *const           error)
{
    const struct check check = { path, document, error };
    const struct key   root  = { "" };
    return check_value(&check, yaml_document_get_root_node(document), schema, &root);
}
