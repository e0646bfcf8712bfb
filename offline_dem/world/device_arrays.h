// The arrays of a device (device.h), and the copies between them and a world's contact lists.

#ifndef DIG_OFFLINE_DEM_WORLD_DEVICE_ARRAYS_H
#define DIG_OFFLINE_DEM_WORLD_DEVICE_ARRAYS_H

#include "offline_dem/world/device.h"
#include "offline_dem/world/world.h"

struct dig_device_arrays {
    struct dig_device_view view;
    struct dig_law         pair_law[DIG_DEVICE_LAWS];
    void                  *memory; // of the view's arrays of grains and pairs
    size_t                 grain_room, surface_room, pair_room;
};

/// DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_device_arrays_init(struct dig_device_arrays *arrays);

void dig_device_arrays_finish(struct dig_device_arrays *arrays);

/// Fills the view from a world whose neighbour list has just been rebuilt; the world's crew shares
/// the work. The view points to the world's grains and neighbours. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_device_arrays_write(struct dig_world         *world,
                                                       struct dig_device_arrays *arrays);

/// The same without the state of contacts, which the device keeps. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_device_arrays_write_lists(struct dig_world         *world,
                                                             struct dig_device_arrays *arrays);

/// Makes the world's contact lists from the view. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_device_arrays_read(const struct dig_device_arrays *arrays,
                                                      struct dig_world               *world);

#endif // DIG_OFFLINE_DEM_WORLD_DEVICE_ARRAYS_H
