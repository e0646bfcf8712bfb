#include "tools/digtable/engine.h"

#include "offline_dem/device/engine_cuda.h"
#include "offline_dem/reference/engine_ode.h"

struct dig_engine dig_cli_engine(const struct dig_arguments *const a)
{
    switch (a->engine) {
    case DIG_ENGINE_KERNEL: return dig_engine_kernel();
    case DIG_ENGINE_ODE: return dig_engine_ode();
    case DIG_ENGINE_CUDA: return dig_engine_cuda();
    case DIG_ENGINE_SINGLE: break;
    }
    return dig_engine_single(a->threads);
}
