// Finds where before and after a dig the machine moves in free air: clear of the soil, after the
// load is dumped, and not in another dig.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_FREE_AIR_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_FREE_AIR_H

#include "closed_loop/machine_digs/machine_dig.h"

/// The path of a recording, in rig scale, as points some way apart, and the sample of each.
struct dig_vertices {
    size_t                 count;
    struct dig_path_point *point;
    size_t                *sample;
};

/// Writes before, before_end, after and after_end of a dig whose contact and end are known. It goes
/// from vertex start to vertex end.
void dig_free_air_find(const struct dig_vertices *v, size_t start, size_t end, double tooth_m,
                       struct dig_machine_dig *dig);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_FREE_AIR_H
