#include "estimator/wrench/soil_wrench.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

struct dig_wrench dig_wrench_of_parts(const double part[const DIG_PARTS],
                                      const double variance[const DIG_PARTS],
                                      const double slow[const DIG_PARTS],
                                      const double geometry[const DIG_PARTS],
                                      const bool moment_valid, const bool force_valid)
{
    assert(part != NULL && variance != NULL && slow != NULL && geometry != NULL);
    struct dig_wrench w = { .moment_valid = moment_valid, .force_valid = force_valid };
    if (moment_valid) {
        w.My_Nm            = part[DIG_PART_MY];
        w.sigma_My_Nm      = sqrt(variance[DIG_PART_MY]);
        w.slow_sigma_My_Nm = sqrt(slow[DIG_PART_MY]);

        w.geometry_sigma_My_Nm = sqrt(geometry[DIG_PART_MY]);
    }
    if (force_valid) {
        w.Fx_N            = part[DIG_PART_FX];
        w.Fz_N            = part[DIG_PART_FZ];
        w.sigma_Fx_N      = sqrt(variance[DIG_PART_FX]);
        w.sigma_Fz_N      = sqrt(variance[DIG_PART_FZ]);
        w.slow_sigma_Fx_N = sqrt(slow[DIG_PART_FX]);
        w.slow_sigma_Fz_N = sqrt(slow[DIG_PART_FZ]);

        w.geometry_sigma_Fx_N = sqrt(geometry[DIG_PART_FX]);
        w.geometry_sigma_Fz_N = sqrt(geometry[DIG_PART_FZ]);
    }
    return w;
}
