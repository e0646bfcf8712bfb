// Checks a grid that was read against what a table can be computed at.

#ifndef DIG_FILES_GRID_CHECK_H
#define DIG_FILES_GRID_CHECK_H

#include "files/grid_yaml.h"

/// Axes, points, effects and names. DIG_EINVAL names file, line, key and what was expected.
DIG_MUST_CHECK enum dig_status dig_grid_check(const char *path, const struct dig_grid *grid,
                                              struct dig_error *error);

/// A list at a key: ascending, within the range.
DIG_MUST_CHECK enum dig_status dig_grid_check_values(const char *path, const char *list,
                                                     size_t count, const double value[],
                                                     double least, double most,
                                                     struct dig_error *error);

/// A number of packings at a key.
DIG_MUST_CHECK enum dig_status dig_grid_check_packings(const char *path, const char *key,
                                                       size_t packings, struct dig_error *error);

#endif // DIG_FILES_GRID_CHECK_H
