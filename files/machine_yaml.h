// Reads a machine YAML (schema: docs/formats.md) into core/machine.h's struct.

#ifndef DIG_FILES_MACHINE_YAML_H
#define DIG_FILES_MACHINE_YAML_H

#include "core/error.h"
#include "core/machine.h"

/// Reads and checks (dig_machine_check(), dig_geometry_check()). *error names file, line, key and
/// what was expected. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_machine_read(const char *path, struct dig_machine *machine,
                                                struct dig_error *error);

#endif // DIG_FILES_MACHINE_YAML_H
