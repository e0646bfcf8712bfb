// Checks a grid that was read against what a table can be computed at.

#ifndef DIG_FILES_GRID_CHECK_H
#define DIG_FILES_GRID_CHECK_H

#include "files/grid_yaml.h"

/// Axes, points, effects and names.
void dig_grid_check(const char *path, const struct dig_grid *grid, struct dig_conditions *c);

/// A list at a key: ascending, within the range.
void dig_grid_check_values(const char *list, size_t count, const double value[], double least,
                           double most, struct dig_conditions *c);

/// A number of packings at a key.
void dig_grid_check_packings(const char *key, size_t packings, struct dig_conditions *c);

#endif // DIG_FILES_GRID_CHECK_H
