// Pictures of a dig for ParaView: legacy VTK files, a set a frame, and an index of each over time
// (*.vtk.series, which ParaView opens; its PVD index takes XML files only).

#ifndef DIG_OFFLINE_DEM_DIG_VTK_H
#define DIG_OFFLINE_DEM_DIG_VTK_H

#include "core/status.h"
#include "offline_dem/shapes/tool.h"
#include "offline_dem/world/world.h"

/// Writes DIR/grains_NNNN.vtk (points with radius, name, clump, velocity, contact force, and
/// load_N, half the sum of contact forces; draw them as spheres of that radius),
/// DIR/bucket_NNNN.vtk and, with rocks, DIR/rocks_NNNN.vtk (polygons). DIR must exist. DIG_EIO:
/// errno says why; DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_vtk_write(const char *dir, size_t frame,
                                             const struct dig_world *world,
                                             const struct dig_tool  *tool);

/// Writes DIR/grains.vtk.series, bucket.vtk.series and, with rocks, rocks.vtk.series: frames files
/// each, step_s apart. DIG_EIO.
DIG_MUST_CHECK enum dig_status dig_vtk_index(const char *dir, size_t frames, double step_s,
                                             bool rocks);

#endif // DIG_OFFLINE_DEM_DIG_VTK_H
