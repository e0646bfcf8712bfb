// The reference engine, `--engine ode`: digs whose grains are ODE bodies (ode_bed.h), in beds that
// the grain kernel has poured. A hundred times slower than the kernel; every release is compared
// with it on short digs.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H
#define DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H

#include "offline_dem/sweep/sweep.h"

/// As dig_engine_kernel(). Its digs know spheres of any size and material and every contact law;
/// DIG_EINVAL, naming the key, for clumps, obstacles, periodic sides and earlier digs, and for
/// pictures.
struct dig_engine dig_engine_ode(void);

#endif // DIG_OFFLINE_DEM_REFERENCE_ENGINE_ODE_H
