// The bucket of the rig, for the tests of its plates.

#ifndef DIG_TESTS_OFFLINE_DEM_RIG_BUCKET_H
#define DIG_TESTS_OFFLINE_DEM_RIG_BUCKET_H

#include "core/scene.h"

#include <math.h>

static const struct dig_bucket rig_bucket = {
    .points  = 5,
    .x_m     = { 0.0, -0.04, -0.052, -0.04, -0.012 },
    .z_m     = { -0.09, -0.072, -0.042, -0.012, 0.0 },
    .width_m = 0.07,
};

static inline double distance(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

#endif // DIG_TESTS_OFFLINE_DEM_RIG_BUCKET_H
