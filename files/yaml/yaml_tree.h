// A YAML text as a tree with line numbers, and how a schema takes it. Internal to files/.

#ifndef DIG_FILES_YAML_YAML_TREE_H
#define DIG_FILES_YAML_YAML_TREE_H

#include "core/error.h"
#include "files/yaml/yaml_schema.h"

#include <yaml.h>

/// Parses text, the content of path, into *document (free with yaml_document_delete()). Refuses
/// syntax errors, an empty text, a second document, and what would take libyaml minutes or a GB,
/// with file and line.
DIG_MUST_CHECK enum dig_status dig_yaml_parse(const char *path, const char *text, size_t size,
                                              yaml_document_t *document, struct dig_error *error);

/// Writes the values of the document into the struct of the fields; keys that are absent leave it
/// as it is. Refuses the first thing that does not fit: a key unknown, missing or given twice, a
/// value of the wrong type, length or range, a number that is not finite. The struct is half
/// written then.
DIG_MUST_CHECK enum dig_status dig_yaml_load(const char *path, yaml_document_t *document,
                                             const struct dig_yaml_field fields[], void *into,
                                             struct dig_error *error);

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
