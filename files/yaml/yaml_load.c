// Takes a document by a schema.

#include "files/yaml/yaml_tree.h"

#include "core/did_you_mean.h"
#include "core/text.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
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
static const char *const wanted[] = {
    [DIG_YAML_NUMBER] = "a number",    [DIG_YAML_WHOLE] = "a whole number",
    [DIG_YAML_BOOL] = "true or false", [DIG_YAML_COUNT] = "a whole number, not negative",
    [DIG_YAML_WORD] = "a text",        [DIG_YAML_TEXT] = "a text",
    [DIG_YAML_MAPPING] = "a mapping",  [DIG_YAML_LIST] = "a list",
    [DIG_YAML_ANY] = "a value",
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

// The bits of a whole number that its field has room for.
static bool read_whole(const struct dig_yaml_field *const field, const char *const text,
                       uint64_t *const bits)
{
    const unsigned spare = 64U - 8U * (unsigned)field->size;
    char          *end   = NULL;
    bool           fits  = false;
    errno                = 0;
    if (field->kind == DIG_YAML_WHOLE) {
        const long long most   = INT64_MAX >> spare;
        const long long number = strtoll(text, &end, 0);
        fits  = !isspace((unsigned char)text[0]) && number <= most && number >= -most - 1;
        *bits = (uint64_t)number;
    } else {
        const unsigned long long number = strtoull(text, &end, 0);
        fits  = isdigit((unsigned char)text[0]) && number <= UINT64_MAX >> spare;
        *bits = number;
    }
    return fits && end != text && *end == '\0' && errno == 0;
}

static bool read_bool(const char *const text, uint64_t *const bits)
{
    *bits = strcasecmp(text, "true") == 0 || strcasecmp(text, "yes") == 0 ? 1 : 0;
    return *bits == 1 || strcasecmp(text, "false") == 0 || strcasecmp(text, "no") == 0;
}

static void store(const uint64_t bits, const size_t size, void *const to)
{
    const uint8_t  one  = (uint8_t)bits;
    const uint16_t two  = (uint16_t)bits;
    const uint32_t four = (uint32_t)bits;
    const void    *from = size == 1   ? (const void *)&one
                          : size == 2 ? (const void *)&two
                          : size == 4 ? (const void *)&four
                                      : (const void *)&bits;
    memcpy(to, from, size);
}

static enum dig_status take_word(const struct check *const check, const yaml_node_t *const node,
                                 const struct dig_yaml_field *const field,
                                 const struct key *const key, void *const to)
{
    char list[200] = "";
    for (const struct dig_yaml_word *w = field->word; w->word != NULL; w++) {
        if (strcmp(w->word, dig_yaml_text_of(node)) == 0) {
            store((uint64_t)w->value, field->size, to);
            return DIG_OK;
        }
        dig_text_list(sizeof list, list, w->word);
    }
    return refuse(check, node, key, "\"%.60s\", expected one of %s", dig_yaml_text_of(node), list);
}

static enum dig_status take_text(const struct check *const check, const yaml_node_t *const node,
                                 const struct dig_yaml_field *const field,
                                 const struct key *const key, void *const to)
{
    // libyaml lets through what an escape such as "\\x1b" puts into a text.
    const char *const text = dig_yaml_text_of(node);
    const char       *c    = text;
    for (size_t n;
         (n = dig_text_character(c)) > 0 && !(field->size > 0 && (*c == '\n' || *c == '\t'));) {
        c += n;
    }
    if (*c != '\0') {
        return refuse(check, node, key,
                      "\"%.60s\" with a control character or a line break, expected none", text);
    }
    const size_t length = strlen(text);
    if (length < field->least) {
        return refuse(check, node, key, "%s, expected a text of at least %zu characters",
                      length == 0 ? "nothing" : "too short", field->least);
    }
    if (field->size > 0 && length >= field->size) {
        return refuse(check, node, key, "\"%.30s…\" of %zu characters, expected at most %zu", text,
                      length, field->size - 1);
    }
    memcpy(to, text, field->size > 0 ? length + 1 : 0);
    return DIG_OK;
}

static double kept(const struct dig_yaml_field *const field, const double number)
{
    return field->factor > 0.0   ? number * field->factor
           : field->factor < 0.0 ? 1.0 / number
                                 : number;
}

static enum dig_status take_scalar(const struct check *const check, const yaml_node_t *const node,
                                   const struct dig_yaml_field *const field,
                                   const struct key *const key, void *const to)
{
    char seen[80];
    if (node->type != YAML_SCALAR_NODE) {
        return refuse(check, node, key, "%s, expected %s", stands(node, sizeof seen, seen),
                      wanted[field->kind]);
    }
    if (field->kind == DIG_YAML_WORD) {
        return take_word(check, node, field, key, to);
    }
    if (field->kind == DIG_YAML_TEXT) {
        return take_text(check, node, field, key, to);
    }
    double            number = 0.0;
    uint64_t          bits   = 0;
    const char *const text   = dig_yaml_text_of(node);
    const bool        real   = field->kind == DIG_YAML_NUMBER;
    const bool        fits   = real                           ? dig_text_number(text, &number)
                               : field->kind == DIG_YAML_BOOL ? read_bool(text, &bits)
                                                              : read_whole(field, text, &bits);
    if (!fits) {
        return refuse(check, node, key, "%s, expected %s", stands(node, sizeof seen, seen),
                      wanted[field->kind]);
    }
    const double value = real                            ? number
                         : field->kind == DIG_YAML_WHOLE ? (double)(int64_t)bits
                                                         : (double)bits;
    if (field->low < field->high && !(value >= field->low && value <= field->high)) {
        return refuse(check, node, key, "%.60s, expected %.10g … %.10g", text, field->low,
                      field->high);
    }
    if (real) {
        number = kept(field, number);
        memcpy(to, &number, sizeof number);
    } else {
        store(bits, field->size, to);
    }
    return DIG_OK;
}

// These call each other as deep as the schema nests, and lists are as long as their arrays at most:
// an alias within its own anchor, or many that stand for many, take no more time.
static enum dig_status take_value(const struct check *check, const yaml_node_t *node,
                                  const struct dig_yaml_field *field, const struct key *key,
                                  char *base);

static const struct dig_yaml_field *field_of(const struct dig_yaml_field fields[],
                                             const char *const           name)
{
    const struct dig_yaml_field *field = fields;
    while (field->key != NULL && strcmp(field->key, name) != 0) {
        field++;
    }
    return field->key != NULL ? field : NULL;
}

static const char *keys_of(const struct dig_yaml_field fields[], const size_t size,
                           char text[const])
{
    text[0] = '\0';
    for (const struct dig_yaml_field *f = fields; f->key != NULL; f++) {
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

// One key of a mapping and its value.
// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status take_pair(const struct check *const check, const yaml_node_t *const map,
                                 const yaml_node_pair_t *const pair,
                                 const struct dig_yaml_field fields[], const struct key *const at,
                                 char *const base)
{
    char                     list[200];
    char                     seen[80];
    const yaml_node_t *const name = yaml_document_get_node(check->document, pair->key);
    if (name->type != YAML_SCALAR_NODE) {
        return refuse(check, name, at, "%s as a key, expected a text",
                      stands(name, sizeof seen, seen));
    }
    const struct key                   key   = member_of(at, dig_yaml_text_of(name));
    const struct dig_yaml_field *const field = field_of(fields, dig_yaml_text_of(name));
    if (field == NULL) {
        char             text[DIG_GUESS_SIZE];
        struct dig_guess guess = dig_guess(dig_yaml_text_of(name));
        for (const struct dig_yaml_field *f = fields; f->key != NULL; f++) {
            dig_guess_try(&guess, f->key);
        }
        return refuse(check, name, &key, "unknown key, expected one of %s%s",
                      keys_of(fields, sizeof list, list), dig_guess_text(&guess, "", text));
    }
    const int before = line_before(check, map, pair);
    if (before != 0) {
        return refuse(check, name, &key, "again (first on line %d), expected once", before);
    }
    if (field->given > 0) {
        base[field->given - 1] = (char)true;
    }
    return take_value(check, yaml_document_get_node(check->document, pair->value), field, &key,
                      base);
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status take_mapping(const struct check *const check, const yaml_node_t *const map,
                                    const struct dig_yaml_field fields[],
                                    const struct key *const at, char *const base)
{
    char list[200];
    char seen[80];
    if (map->type != YAML_MAPPING_NODE) {
        return refuse(check, map, at, "%s, expected a mapping of %s",
                      stands(map, sizeof seen, seen), keys_of(fields, sizeof list, list));
    }
    for (const yaml_node_pair_t *pair = map->data.mapping.pairs.start;
         pair < map->data.mapping.pairs.top; pair++) {
        const enum dig_status status = take_pair(check, map, pair, fields, at, base);
        if (status != DIG_OK) {
            return status;
        }
    }
    for (const struct dig_yaml_field *f = fields; f->key != NULL; f++) {
        if (!f->optional && dig_yaml_value(check->document, map, f->key) == NULL) {
            const struct key key = member_of(at, f->key);
            return refuse(check, map, &key, "missing, expected %s", wanted[f->kind]);
        }
    }
    return DIG_OK;
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status take_list(const struct check *const check, const yaml_node_t *const list,
                                 const struct dig_yaml_field *const field,
                                 const struct key *const at, char *const base)
{
    char seen[80];
    if (list->type != YAML_SEQUENCE_NODE) {
        return refuse(check, list, at, "%s, expected a list", stands(list, sizeof seen, seen));
    }
    const yaml_node_item_t *const first = list->data.sequence.items.start;
    const size_t                  count = (size_t)(list->data.sequence.items.top - first);
    const size_t                  most  = field->size / field->of->size;
    const size_t                  least = field->count > 0 ? field->least : most;
    if (count < least || count > most) {
        return least == most
                   ? refuse(check, list, at, "%zu values, expected %zu", count, most)
                   : refuse(check, list, at, "%zu values, expected %zu to %zu", count, least, most);
    }
    for (size_t i = 0; i < count; i++) {
        const struct key      key = element_of(at, i);
        const enum dig_status status =
            take_value(check, yaml_document_get_node(check->document, first[i]), field->of, &key,
                       base + field->at + i * field->of->size);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (field->count > 0) {
        memcpy(base + field->count - 1, &count, sizeof count);
    }
    return DIG_OK;
}

// NOLINTNEXTLINE(misc-no-recursion)
static enum dig_status take_value(const struct check *const check, const yaml_node_t *const node,
                                  const struct dig_yaml_field *const field,
                                  const struct key *const key, char *const base)
{
    switch (field->kind) {
    case DIG_YAML_MAPPING: return take_mapping(check, node, field->of, key, base + field->at);
    case DIG_YAML_LIST: return take_list(check, node, field, key, base);
    case DIG_YAML_ANY: return DIG_OK;
    case DIG_YAML_NUMBER:
    case DIG_YAML_WHOLE:
    case DIG_YAML_COUNT:
    case DIG_YAML_BOOL:
    case DIG_YAML_WORD:
    case DIG_YAML_TEXT: break;
    }
    return take_scalar(check, node, field, key, base + field->at);
}

enum dig_status dig_yaml_load(const char *const path, yaml_document_t *const document,
                              const struct dig_yaml_field fields[], void *const into,
                              struct dig_error *const error)
{
    const struct check check = { path, document, error };
    const struct key   root  = { "" };
    return take_mapping(&check, yaml_document_get_root_node(document), fields, &root, into);
}
