// A settled bed: the result of pouring and the start of a dig. One index a grain, or a sphere of a
// clump.

#ifndef DIG_CORE_BED_H
#define DIG_CORE_BED_H

#include "core/scene.h"
#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Settled pose of a movable rock: body to world, real part first.
struct dig_rock_pose {
    double x_m[3], q[4];
};

/// Owned by the caller, freed with dig_bed_finish().
struct dig_bed {
    size_t    grains;
    double   *x_m, *y_m, *z_m, *radius_m; // [grains]
    uint8_t  *material;                   // [grains] as in core/scene.h; NULL: all gravel
    uint32_t *clump; // [grains] from 1, the spheres of one clump in a row and in the shape's order;
                     // NULL: grains are spheres
    size_t               rocks; // 0: the scene's obstacles are where the scene has them
    struct dig_rock_pose rock[DIG_OBSTACLES_MAX];
};

/// Room for this many grains, all zero. DIG_ENOMEM leaves *bed as it was.
DIG_MUST_CHECK enum dig_status dig_bed_create(size_t grains, bool materials, bool clumps,
                                              struct dig_bed *bed);

/// NULL and a zeroed bed are allowed.
void dig_bed_finish(struct dig_bed *bed);

#endif // DIG_CORE_BED_H
