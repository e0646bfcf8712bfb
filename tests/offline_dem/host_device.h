// The device interface on the processor itself, one grain after the other: the reference that a
// device which rounds alike meets bit for bit.

#ifndef DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H
#define DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H

#include "core/error.h"
#include "offline_dem/world/device.h"
#include "offline_dem/world/world.h"

/// NULL when memory is short. Works on the arrays of the view itself.
struct dig_device *dem_host_device_create(void);

/// Of a struct dig_stepper: one for each world.
enum dig_status dem_host_take_over(struct dig_world *world, struct dig_error *error);

#endif // DIG_TESTS_OFFLINE_DEM_HOST_DEVICE_H
