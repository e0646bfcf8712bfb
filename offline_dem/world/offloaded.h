// A world whose grains a device steps (device.h). Lists are made here, as for the kernel: when a
// grain is about to leave its margin, motions and contacts come back, the neighbour list is made
// anew, and everything goes out again. Between that only the tool's pose travels.

#ifndef DIG_OFFLINE_DEM_WORLD_OFFLOADED_H
#define DIG_OFFLINE_DEM_WORLD_OFFLOADED_H

#include "offline_dem/world/device.h"
#include "offline_dem/world/world.h"

/// Hands the world's steps to the device, which the world does not own and which serves no other
/// world meanwhile. The world has no bodies. DIG_ENOMEM leaves it with the kernel.
DIG_MUST_CHECK enum dig_status dig_offload(struct dig_world *world, struct dig_device *device);

/// What dig_world_step(), dig_world_sync_motion() and dig_world_sync() do in an offloaded world. A
/// grain that outruns its margin between two looks at it is DIG_EINVAL, as one that moves its
/// radius in a step is.
DIG_MUST_CHECK enum dig_status dig_offloaded_step(struct dig_world *world);
DIG_MUST_CHECK enum dig_status dig_offloaded_sync_motion(struct dig_world *world);
DIG_MUST_CHECK enum dig_status dig_offloaded_sync(struct dig_world *world);

/// NULL is allowed. The device stays its owner's.
void dig_offloaded_destroy(struct dig_offloaded *offloaded);

#endif // DIG_OFFLINE_DEM_WORLD_OFFLOADED_H
