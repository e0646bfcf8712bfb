// Reads a scene YAML (schema: docs/formats.md) into core/scene.h's struct.

#ifndef DIG_FILES_SCENE_YAML_H
#define DIG_FILES_SCENE_YAML_H

#include "core/error.h"
#include "core/scene.h"

/// *error names file, line, key and what was expected. Writes *scene on success only.
DIG_MUST_CHECK enum dig_status dig_scene_read(const char *path, struct dig_scene *scene,
                                              struct dig_error *error);

#endif // DIG_FILES_SCENE_YAML_H
