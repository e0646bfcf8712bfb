// Pictures of a dig for ParaView: legacy VTK files, one pair a frame.

#ifndef DIG_OFFLINE_DEM_VTK_H
#define DIG_OFFLINE_DEM_VTK_H

#include "core/status.h"
#include "offline_dem/grains.h"
#include "offline_dem/tool.h"

/// Writes DIR/grains_NNNN.vtk (points with radius, speed and name; draw them as spheres of that
/// radius) and DIR/bucket_NNNN.vtk (polygons). DIR must exist. DIG_EIO: errno says why.
DIG_MUST_CHECK enum dig_status dig_vtk_write(const char *dir, size_t frame,
                                             const struct dig_grains *grains,
                                             const struct dig_tool   *tool);

#endif // DIG_OFFLINE_DEM_VTK_H
