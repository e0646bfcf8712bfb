#include "files/yaml/yaml_tree.h"

#include "core/text.h"

#include <stdlib.h>
#include <string.h>

#define KEY_SIZE 160

#define SIZE_MOST  (2 << 20) // a hundred times as much in memory
#define SIGNS_MOST 1000
#define DEPTH_MOST 64 // no file of ours nests deeper than ten

// Takes libyaml the square of their number: it compares each anchor and each directive with all
// before it, and each bracket with all around it. What begins one is counted, be it in a text or
// not: nobody's file has so many.
static enum dig_status check_amount(const char *const path, const char *const text,
                                    const size_t size, struct dig_error *const error)
{
    size_t anchors    = 0;
    size_t directives = 0;
    size_t depth      = 0;
    if (size > SIZE_MOST) {
        return dig_error_set(error, DIG_EINVAL, "%s:1: %zu bytes, expected at most %d", path, size,
                             SIZE_MOST);
    }
    for (size_t at = 0; at < size; at++) {
        anchors += text[at] == '&' ? 1 : 0;
        directives += text[at] == '%' ? 1 : 0;
        depth += text[at] == '[' || text[at] == '{' ? 1 : 0;
        depth -= (text[at] == ']' || text[at] == '}') && depth > 0 ? 1 : 0;
        if (anchors > SIGNS_MOST || directives > SIGNS_MOST || depth > DEPTH_MOST) {
            return dig_error_set(
                error, DIG_EINVAL, "%s:%d: more than %d %s, expected fewer", path,
                dig_text_line(text, at), depth > DEPTH_MOST ? DEPTH_MOST : SIGNS_MOST,
                depth > DEPTH_MOST ? "open brackets" : "anchors (&) or directives (%)");
        }
    }
    return DIG_OK;
}

static enum dig_status refuse_syntax(const char *const path, const char *const text,
                                     const size_t size, const yaml_parser_t *const parser,
                                     struct dig_error *const error)
{
    if (parser->error == YAML_MEMORY_ERROR) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    // Of a byte that is no text libyaml knows the place, not the line.
    const size_t at   = parser->problem_offset < size ? parser->problem_offset : size;
    const int    line = parser->error == YAML_READER_ERROR ? dig_text_line(text, at)
                                                           : (int)parser->problem_mark.line + 1;
    return dig_error_set(error, DIG_EINVAL, "%s:%d: %s%s%s, expected YAML", path, line,
                         parser->context != NULL ? parser->context : "",
                         parser->context != NULL ? ": " : "",
                         parser->problem != NULL ? parser->problem : "not readable");
}

// A file holds one document; what follows it would silently be ignored.
static enum dig_status refuse_more(const char *const path, const char *const text,
                                   const size_t size, yaml_parser_t *const parser,
                                   struct dig_error *const error)
{
    yaml_document_t more;
    if (!yaml_parser_load(parser, &more)) {
        return refuse_syntax(path, text, size, parser, error);
    }
    const yaml_node_t *const root   = yaml_document_get_root_node(&more);
    enum dig_status          status = DIG_OK;
    if (root != NULL) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s:%d: a second document, expected one document in the file", path,
                               dig_yaml_line_of(root));
    }
    yaml_document_delete(&more);
    return status;
}

enum dig_status dig_yaml_parse(const char *const path, const char *const text, const size_t size,
                               yaml_document_t *const document, struct dig_error *const error)
{
    yaml_parser_t   parser;
    enum dig_status status = check_amount(path, text, size, error);
    if (status != DIG_OK) {
        return status;
    }
    if (!yaml_parser_initialize(&parser)) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);

    yaml_document_t loaded;
    if (!yaml_parser_load(&parser, &loaded)) {
        status = refuse_syntax(path, text, size, &parser, error);
    } else if (yaml_document_get_root_node(&loaded) == NULL) {
        status = dig_error_set(error, DIG_EINVAL, "%s:1: empty, expected YAML", path);
        yaml_document_delete(&loaded);
    } else {
        status = refuse_more(path, text, size, &parser, error);
        if (status == DIG_OK) {
            *document = loaded;
        } else {
            yaml_document_delete(&loaded);
        }
    }
    yaml_parser_delete(&parser);
    return status;
}

const yaml_node_t *dig_yaml_value(yaml_document_t *const document, const yaml_node_t *const map,
                                  const char *const name)
{
    for (const yaml_node_pair_t *pair = map->data.mapping.pairs.start;
         pair < map->data.mapping.pairs.top; pair++) {
        const yaml_node_t *const key = yaml_document_get_node(document, pair->key);
        if (key->type == YAML_SCALAR_NODE && strcmp(dig_yaml_text_of(key), name) == 0) {
            return yaml_document_get_node(document, pair->value);
        }
    }
    return NULL;
}

// One step down: `name` in a mapping or `[n]` in a list.
static const yaml_node_t *step(yaml_document_t *const document, const yaml_node_t *const node,
                               const char **const key)
{
    if (**key == '[') {
        char               *end   = NULL;
        const unsigned long index = strtoul(*key + 1, &end, 10);
        const size_t        count =
            node->type == YAML_SEQUENCE_NODE
                       ? (size_t)(node->data.sequence.items.top - node->data.sequence.items.start)
                       : 0;
        *key = *end == ']' ? end + 1 : end;
        return index < count
                   ? yaml_document_get_node(document, node->data.sequence.items.start[index])
                   : NULL;
    }
    char         name[KEY_SIZE];
    const size_t length = strcspn(*key, ".[");
    if (node->type != YAML_MAPPING_NODE || length >= sizeof name) {
        return NULL;
    }
    memcpy(name, *key, length);
    name[length] = '\0';
    *key += length;
    return dig_yaml_value(document, node, name);
}

const yaml_node_t *dig_yaml_find(yaml_document_t *const document, const char *key, int *const found)
{
    const yaml_node_t *node = yaml_document_get_root_node(document);
    *found                  = 0;
    while (node != NULL && *key != '\0') {
        key += *key == '.';
        const yaml_node_t *const below = step(document, node, &key);
        if (below == NULL) {
            return node;
        }
        node = below;
    }
    *found = node != NULL;
    return node;
}
