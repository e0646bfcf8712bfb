// A YAML text as a tree with line numbers, and what is wrong with it in the eyes of a schema.
// Internal to files/: libcyaml loads, this explains.

#ifndef DIG_FILES_YAML_YAML_TREE_H
#define DIG_FILES_YAML_YAML_TREE_H

#include "core/error.h"

#include <cyaml/cyaml.h>
#include <yaml.h>

/// Refuses a text that its aliases make grow without bounds, or that nests without: 100000 values
/// that aliases stand for, 64 deep. What is no YAML passes. O(size).
DIG_MUST_CHECK enum dig_status dig_yaml_check_growth(const char *path, const char *text,
                                                     size_t size, struct dig_error *error);

/// Parses text, the content of path, into *document (free with yaml_document_delete()). Refuses
/// syntax errors, an empty text, a second document, and what dig_yaml_check_growth() does, with
/// file and line.
DIG_MUST_CHECK enum dig_status dig_yaml_parse(const char *path, const char *text, size_t size,
                                              yaml_document_t *document, struct dig_error *error);

/// Refuses the first thing in the document that does not fit the schema: a key unknown, missing or
/// given twice, a value of the wrong type or length, a number that is not finite.
DIG_MUST_CHECK enum dig_status dig_yaml_check(const char *path, yaml_document_t *document,
                                              const cyaml_schema_value_t *schema,
                                              struct dig_error           *error);

/// The node at a dotted key, or the deepest one on the way to it; *found says which.
const yaml_node_t *dig_yaml_find(yaml_document_t *document, const char *key, int *found);

/// The value of a name in a mapping node, or NULL.
const yaml_node_t *dig_yaml_value(yaml_document_t *document, const yaml_node_t *map,
                                  const char *name);

/// The line a node begins on, from 1.
static inline int dig_yaml_line_of(const yaml_node_t *const node)
{
    return (int)node->start_mark.line + 1;
}

/// The text of a scalar node.
static inline const char *dig_yaml_text_of(const yaml_node_t *const scalar)
{
    return (const char *)scalar->data.scalar.value;
}

#endif // DIG_FILES_YAML_YAML_TREE_H
