// The reference engine, `--engine ode`: digs whose grains are ODE bodies (ode_bed.h), in beds
// poured by the grain kernel. A hundred times slower than the kernel; every release is compared
// with it on short digs.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H
#define DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H

#include "offline_dem/sweep/sweep.h"

/// As dig_engine_kernel(). Spheres of any size and material, rocks and every contact law;
/// DIG_EINVAL, naming the key, for clumps, periodic sides, earlier digs and pictures.
struct dig_engine dig_engine_ode(void);

#endif // DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H
