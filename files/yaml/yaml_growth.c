// What a text grows to. With nested aliases a kilobyte stands for more values than memory holds,
// and who reads it by its schema, alias for alias, never ends. Without any, a value of two bytes
// takes libyaml a hundred times as much.

#include "files/yaml/yaml_tree.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer takes the stack of open values, zeroed as a whole, for uninitialised.
#pragma GCC diagnostic ignored "-Wanalyzer-use-of-uninitialized-value"
#endif

#define GROWTH_MAX 100000  // values that aliases may stand for
#define VALUES_MAX 1000000 // that stand there: some 200 MB while they are read
#define DIRECTIVES 8       // libyaml compares each with all before it
#define DEPTH_MAX  64      // no file of ours nests deeper than ten
#define ANCHORS    256

struct anchor {
    char  *name;
    size_t values; // it stands for; 0: it is open still
};

// Where the count stands.
struct growth {
    struct anchor anchor[ANCHORS];
    size_t        anchors;
    size_t        values, grown; // in all, and by aliases
    size_t        depth;
    size_t        opened[DEPTH_MAX], values_before[DEPTH_MAX]; // anchor + 1 of each open value; 0
};

static enum dig_status refuse(const char *const path, const yaml_event_t *const event,
                              const char *const what, struct dig_error *const error)
{
    return dig_error_set(error, DIG_EINVAL, "%s:%d: %s", path, (int)event->start_mark.line + 1,
                         what);
}

// Remembers the anchor of a value; *at becomes its number + 1, 0 where it has none.
static enum dig_status add_anchor(struct growth *const g, const yaml_char_t *const name,
                                  const char *const path, const yaml_event_t *const event,
                                  size_t *const at, struct dig_error *const error)
{
    *at = 0;
    if (name == NULL) {
        return DIG_OK;
    }
    if (g->anchors == ANCHORS) {
        return refuse(path, event, "more than 256 anchors, expected fewer", error);
    }
    char *const kept = strdup((const char *)name);
    if (kept == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    g->anchor[g->anchors++] = (struct anchor){ .name = kept };
    *at                     = g->anchors;
    return DIG_OK;
}

static enum dig_status add_alias(struct growth *const g, const char *const path,
                                 const yaml_event_t *const event, struct dig_error *const error)
{
    size_t i = g->anchors;
    while (i > 0 && strcmp(g->anchor[i - 1].name, (const char *)event->data.alias.anchor) != 0) {
        i--;
    }
    if (i == 0) {
        return DIG_OK; // libyaml's own words say that it is not there
    }
    if (g->anchor[i - 1].values == 0) {
        return refuse(path, event, "an alias within its own anchor, expected a value that ends",
                      error);
    }
    g->values += g->anchor[i - 1].values;
    g->grown += g->anchor[i - 1].values;
    return g->grown <= GROWTH_MAX
               ? DIG_OK
               : refuse(path, event, "aliases stand for more than 100000 values, expected fewer",
                        error);
}

static enum dig_status begin_value(struct growth *const g, const char *const path,
                                   const yaml_event_t *const event, const yaml_char_t *const name,
                                   struct dig_error *const error)
{
    if (g->values - g->grown >= VALUES_MAX) {
        return refuse(path, event, "more than 1000000 values, expected fewer", error);
    }
    if (g->depth == DEPTH_MAX) {
        return refuse(path, event, "nested deeper than 64, expected less", error);
    }
    g->values_before[g->depth] = g->values++;
    return add_anchor(g, name, path, event, &g->opened[g->depth++], error);
}

static void end_value(struct growth *const g)
{
    const size_t at = g->opened[--g->depth];
    if (at > 0) {
        g->anchor[at - 1].values = g->values - g->values_before[g->depth];
    }
}

static enum dig_status count(struct growth *const g, const char *const path,
                             const yaml_event_t *const event, struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    switch (event->type) {
    case YAML_ALIAS_EVENT: return add_alias(g, path, event, error);
    case YAML_SEQUENCE_START_EVENT:
        return begin_value(g, path, event, event->data.sequence_start.anchor, error);
    case YAML_MAPPING_START_EVENT:
        return begin_value(g, path, event, event->data.mapping_start.anchor, error);
    case YAML_SCALAR_EVENT:
        status = begin_value(g, path, event, event->data.scalar.anchor, error);
        if (status == DIG_OK) {
            end_value(g);
        }
        return status;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT: end_value(g); break;
    case YAML_NO_EVENT:
    case YAML_STREAM_START_EVENT:
    case YAML_STREAM_END_EVENT:
    case YAML_DOCUMENT_START_EVENT:
    case YAML_DOCUMENT_END_EVENT: break;
    }
    return DIG_OK;
}

// Whether a line begins at text + at, as libyaml counts them: behind LF, CR, NEL, LS or PS.
static bool begins_line(const char *const text, const size_t at)
{
    static const char *const breaks[] = { "\n", "\r", "\xC2\x85", "\xE2\x80\xA8", "\xE2\x80\xA9" };
    if (at > 0 && text[at - 1] == '\r' && text[at] == '\n') {
        return false;
    }
    bool begins = at == 0;
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0] && !begins; i++) {
        const size_t length = strlen(breaks[i]);
        begins              = at >= length && memcmp(text + at - length, breaks[i], length) == 0;
    }
    return begins;
}

static enum dig_status check_directives(const char *const path, const char *const text,
                                        const size_t size, struct dig_error *const error)
{
    int    line       = 0;
    size_t directives = 0;
    for (size_t at = 0; at < size; at++) {
        const bool begins = begins_line(text, at);
        line += begins ? 1 : 0;
        directives += begins && text[at] == '%' ? 1 : 0;
        if (directives > DIRECTIVES) {
            return dig_error_set(error, DIG_EINVAL,
                                 "%s:%d: more than %d directives (lines that "
                                 "begin with %%), expected fewer",
                                 path, line, DIRECTIVES);
        }
    }
    return DIG_OK;
}

enum dig_status dig_yaml_check_growth(const char *const path, const char *const text,
                                      const size_t size, struct dig_error *const error)
{
    enum dig_status status = check_directives(path, text, size, error);
    if (status != DIG_OK) {
        return status;
    }
    yaml_parser_t parser;
    struct growth g = { .anchors = 0 };
    if (!yaml_parser_initialize(&parser)) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
    for (bool more = true; more && status == DIG_OK;) {
        yaml_event_t event;
        if (!yaml_parser_parse(&parser, &event)) {
            break; // a syntax error: who parses it says where
        }
        status = count(&g, path, &event, error);
        more   = event.type != YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    for (size_t i = 0; i < g.anchors; i++) {
        free(g.anchor[i].name);
    }
    yaml_parser_delete(&parser);
    return status;
}
