// YAML, and JSON, which is YAML: read by a schema into C structs, with errors a person can act on.

#ifndef DIG_FILES_YAML_YAML_H
#define DIG_FILES_YAML_YAML_H

#include "core/error.h"
#include "files/yaml/yaml_schema.h"

#include <stdio.h>

/// Loads path by its schema and hands it to take(path, loaded, c), which may change what was
/// loaded; *into is written only where all its conditions hold. Their words begin with the dotted
/// key of a value ("parts[3].weight_kg: %g, expected …"). Unknown keys, missing keys and values of
/// the wrong type or out of range are refused; *error reads "FILE:LINE: KEY: what was found,
/// expected …".
DIG_MUST_CHECK enum dig_status dig_yaml_read(const char *path, const struct dig_yaml_file *schema,
                                             void (*take)(const char *path, void *loaded,
                                                          struct dig_conditions *c),
                                             void *into, struct dig_error *error);

/// Writes the struct as one JSON object that dig_yaml_read() reads back, and a line feed. What is
/// optional is left out where its `given` is false, a number is 0 or none, a list is empty. Another
/// number that is none becomes 0; a control character becomes '?'.
void dig_json_write(FILE *to, const struct dig_yaml_file *schema, const void *from);

/// The line on which the value at dotted key ("cylinders.boom.bore_m", "recordings[2].file")
/// stands, or 0 when it is not there.
int dig_yaml_line(const char *path, const char *key);

/// Refuses a loaded value. What is formatted begins with its dotted key ("parts[3].weight_kg: %g,
/// expected …"); *error becomes "FILE:LINE: " and that. Returns DIG_EINVAL.
__attribute__((format(printf, 3, 4))) enum dig_status
dig_yaml_refuse(const char *path, struct dig_error *error, const char *format, ...);

/// Of a file that could not be read, which is DIG_EIO: *error begins with FILE:LINE: KEY: of the
/// key that names it. Returns status, and leaves *error with any other.
enum dig_status dig_yaml_tell_namer(const char *path, const char *key, enum dig_status status,
                                    struct dig_error *error);

#endif // DIG_FILES_YAML_YAML_H
