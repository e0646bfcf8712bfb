// Checks a grid that was read against what a table can be computed at.

#ifndef DIG_FILES_GRID_CHECK_H
#define DIG_FILES_GRID_CHECK_H

#include "files/grid_yaml.h"

/// Axes, points, effects and names.
void dig_grid_check(const struct dig_grid *grid, struct dig_conditions *c);

/// A list at a key: ascending.
void dig_grid_check_ascending(const char *list, size_t count, const double value[],
                              struct dig_conditions *c);

#endif // DIG_FILES_GRID_CHECK_H
