// The device interface on the processor itself, one grain after the other: the reference that a
// device which rounds alike meets bit for bit.

#ifndef DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H
#define DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H

#include "offline_dem/world/device.h"

/// NULL when memory is short. Works on the arrays of the view itself.
struct dig_device *dem_host_device_create(void);

#endif // DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H
