// A world whose grains a device steps (device.h). Lists are made on the host, as for the kernel:
// when a grain nears its margin, motions and contacts are downloaded, the neighbour list is
// rebuilt, and all is uploaded again. In between only the tool's pose travels.

#ifndef DIG_OFFLINE_DEM_WORLD_OFFLOADED_H
#define DIG_OFFLINE_DEM_WORLD_OFFLOADED_H

#include "offline_dem/world/device.h"
#include "offline_dem/world/world.h"

/// Hands the world's steps to the device, which from then on is the world's and ends with it. No
/// rock of the world is movable. DIG_ENOMEM ends the device and leaves the world with the kernel.
/// From then on dig_world_step() gives DIG_EINVAL for a grain that leaves its margin between two
/// polls, as for one that moves its radius in a step.
DIG_MUST_CHECK enum dig_status dig_offload(struct dig_world *world, struct dig_device *device);

#endif // DIG_OFFLINE_DEM_WORLD_OFFLOADED_H
