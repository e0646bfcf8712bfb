// A graphics card as a device. Its side (offline_dem/cuda/card.cu) is a library of its own, made by
// `make cuda` with nvcc and loaded on demand: from DIG_CUDA_LIBRARY, else as libdig_cuda.so where
// the dynamic loader looks. Nothing else of Digsight depends on CUDA.

#ifndef DIG_OFFLINE_DEM_DEVICE_DEVICE_CUDA_H
#define DIG_OFFLINE_DEM_DEVICE_DEVICE_CUDA_H

#include "core/error.h"
#include "offline_dem/world/device.h"

/// NULL where the library, a card or memory is missing; *error says which. Half a second the first
/// time a process asks.
struct dig_device *dig_device_cuda_create(struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DEVICE_DEVICE_CUDA_H
