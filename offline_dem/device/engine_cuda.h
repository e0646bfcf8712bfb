// Engine "cuda": the kernel's digs with the grains stepped by a graphics card. All else is the
// kernel's code, and the law is the same source. Sums have another order, so a curve is another
// realisation of the same dig (docs/numerics/dem.md, "On a graphics card").

#ifndef DIG_OFFLINE_DEM_DEVICE_ENGINE_CUDA_H
#define DIG_OFFLINE_DEM_DEVICE_ENGINE_CUDA_H

#include "offline_dem/sweep/sweep.h"

/// stepper.threads make the lists of a large bed. No movable rocks. DIG_EIO where the library or a
/// card is missing; *error says which.
struct dig_engine dig_engine_cuda(void);

#endif // DIG_OFFLINE_DEM_DEVICE_ENGINE_CUDA_H
