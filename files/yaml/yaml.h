// YAML through libcyaml: schema-checked into C structs, with errors a person can act on.

#ifndef DIG_FILES_YAML_YAML_H
#define DIG_FILES_YAML_YAML_H

#include "core/error.h"

#include <cyaml/cyaml.h>

/// Loads path by schema and hands it to take(path, loaded, into, c), which may change what was
/// loaded, and is to write *into only where all its conditions hold. Their words begin with the
/// dotted key of a value ("parts[3].weight_kg: %g, expected …"). Unknown keys, missing keys and
/// values of the wrong type are refused; *error reads "FILE:LINE: KEY: what was found, expected …".
DIG_MUST_CHECK enum dig_status dig_yaml_read(const char *path, const cyaml_schema_value_t *schema,
                                             void (*take)(const char *path, cyaml_data_t *loaded,
                                                          void *into, struct dig_conditions *c),
                                             void *into, struct dig_error *error);

/// The line on which the value at dotted key ("cylinders.boom.bore_m", "recordings[2].file")
/// stands, or 0 when it is not there: so that a check made after loading can name the line too.
int dig_yaml_line(const char *path, const char *key);

/// Refuses a loaded value. What is formatted begins with its dotted key ("parts[3].weight_kg: %g,
/// expected …"); *error becomes "FILE:LINE: " and that. Returns DIG_EINVAL.
__attribute__((format(printf, 3, 4))) enum dig_status
dig_yaml_refuse(const char *path, struct dig_error *error, const char *format, ...);

/// A number of a file, and what it may be.
struct dig_yaml_range {
    const char *key;
    double      value, least, most;
};

/// at: the key they stand in, "messages[3]"; "": none.
void dig_yaml_check_ranges(const char *at, size_t count, const struct dig_yaml_range range[],
                           struct dig_conditions *c);

/// Of a file that could not be read, which is DIG_EIO: *error begins with FILE:LINE: KEY: of the
/// key that names it. Returns status, and leaves *error with any other.
enum dig_status dig_yaml_tell_namer(const char *path, const char *key, enum dig_status status,
                                    struct dig_error *error);

#endif // DIG_FILES_YAML_YAML_H
