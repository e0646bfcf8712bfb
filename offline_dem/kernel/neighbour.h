// Pairs that may touch before the next rebuild: a Verlet half list made with a grid of cells.
//
// Every grain has its own margin: skin + speed x time. A pair is listed when the gap between its
// surfaces is below the sum of both margins. The list is valid as long as no grain has moved
// farther than its margin, so one grain flying off the bucket does not force rebuilds on thousands
// at rest.

#ifndef DIG_OFFLINE_DEM_KERNEL_NEIGHBOUR_H
#define DIG_OFFLINE_DEM_KERNEL_NEIGHBOUR_H

#include "core/status.h"
#include "offline_dem/kernel/grains.h"

#include <stddef.h>
#include <stdint.h>

struct dig_crew;

struct dig_neighbours {
    size_t    n;     // grains it was made for
    uint32_t *start; // [n + 1]: the pairs found by grain i are start[i] … start[i + 1] - 1
    uint32_t *other; // [start[n]]
    size_t    room;  // of other
    size_t    reach; // largest distance in memory between the two grains of a pair
    double (*reference_m)[4]; // [n] position when the list was made, and the margin
};

/// Lists every pair once, but not those within a clump, under the grain with the larger margin (on
/// a tie the lower index). margin_m[i] > 0 for every grain. *list is zeroed or was filled by this
/// function, which reuses its memory. A crew shares the search, NULL: the caller alone; the list is
/// the same. DIG_ENOMEM leaves an empty list. O(n) for grains of similar size.
DIG_MUST_CHECK enum dig_status dig_neighbours_build(const struct dig_grains *grains,
                                                    double period_y_m, const double margin_m[],
                                                    struct dig_crew       *crew,
                                                    struct dig_neighbours *list);

void dig_neighbours_finish(struct dig_neighbours *list);

#endif // DIG_OFFLINE_DEM_KERNEL_NEIGHBOUR_H
