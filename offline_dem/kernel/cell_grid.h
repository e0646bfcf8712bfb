// Grains by the cells of a grid, which a list of pairs is made with and grains are sorted by.

#ifndef DIG_OFFLINE_DEM_KERNEL_CELL_GRID_H
#define DIG_OFFLINE_DEM_KERNEL_CELL_GRID_H

#include "core/status.h"
#include "offline_dem/kernel/grains.h"

#include <stddef.h>
#include <stdint.h>

struct dig_crew;

/// A box of cells around all grains. The number of cells is bounded whatever the spread of the
/// grains: a grain thrown far away makes cells larger, not memory.
struct dig_cell_grid {
    double    low_m[3];
    double    cell_m;
    ptrdiff_t count[3];
    int axis[3]; // rows of cells run along axis[0]: the shortest, so that what is near in space
                 // is near in memory
    size_t    cells;
    uint32_t *start;  // [cells + 1]
    uint32_t *member; // [n], cell by cell
};

/// The cell of x_m along an axis; the outermost beyond the box.
static inline ptrdiff_t dig_cell_grid_along(const struct dig_cell_grid *const g, const int axis,
                                            const double x_m)
{
    const double c = (x_m - g->low_m[axis]) / g->cell_m;
    if (!(c >= 1.0)) {
        return 0;
    }
    return c < (double)g->count[axis] ? (ptrdiff_t)c : g->count[axis] - 1;
}

/// Sorts the grains into cells of edge cell_m, or wider. The crew (NULL: the caller alone) shares
/// the work. Finish it. DIG_ENOMEM leaves nothing to finish. O(n).
DIG_MUST_CHECK enum dig_status dig_cell_grid_fill(const struct dig_grains *grains, double cell_m,
                                                  struct dig_crew *crew, struct dig_cell_grid *g);

void dig_cell_grid_finish(struct dig_cell_grid *g);

/// Sorts the grains along the cells of a grid of edge cell_m, rows of cells along the shortest
/// axis: grain order[k] belongs at index k. Stable. The crew is dig_cell_grid_fill's. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_cell_grid_sort(const struct dig_grains *grains, double cell_m,
                                                  struct dig_crew *crew, uint32_t order[]);

#endif // DIG_OFFLINE_DEM_KERNEL_CELL_GRID_H
