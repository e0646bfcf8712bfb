// The device interface on the processor itself, one grain after the other: what a device must give,
// bit for bit where it rounds alike. For tests; the kernel is ten times as fast.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_HOST_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_HOST_H

#include "offline_dem/world/device.h"

/// NULL when memory is short. Works on the arrays of the view itself.
struct dig_device *dig_device_host_create(void);

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_HOST_H
