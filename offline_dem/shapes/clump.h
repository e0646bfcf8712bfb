// The shape of grains that are clumps of spheres: volume, centre of mass and inertia of the union
// of the spheres, not of their sum. Integrated over columns: exact along z, on a grid across.

#ifndef DIG_OFFLINE_DEM_SHAPES_CLUMP_H
#define DIG_OFFLINE_DEM_SHAPES_CLUMP_H

#include "core/scene.h"
#include "core/status.h"

/// Lengths in diameters of the sphere of equal volume, about the centre of mass, axes as given.
struct dig_clump_shape {
    size_t spheres; // 0: grains are spheres
    double at[DIG_CLUMP_MAX][3];
    double radius[DIG_CLUMP_MAX];
    double bound;         // farthest point of the shape from its centre of mass
    double inertia[3][3]; // per mass and diameter squared
    double inverse[3][3];
};

/// DIG_EINVAL for spheres without volume. A few milliseconds.
DIG_MUST_CHECK enum dig_status dig_clump_shape_make(const struct dig_clump *clump,
                                                    struct dig_clump_shape *shape);

/// Orientation of a clump whose spheres stand at at_m[spheres][3]: the rotation from the shape's
/// axes to the world's. About an axis of symmetry it is arbitrary.
void dig_clump_orientation(const struct dig_clump_shape *shape, const double at_m[][3],
                           double rotation[3][3]);

#endif // DIG_OFFLINE_DEM_SHAPES_CLUMP_H
