#include "estimator/wrench/cylinder.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Perfect vacuum, as a gauge shows it.
static const double vacuum_Pa = -1e5;

static const double seal_share = 0.01;

double dig_reading_sigma(const double step, const double sigma)
{
    return sqrt(step * step / 12.0 + sigma * sigma);
}

double dig_reading_slow(const double step, const double sigma)
{
    if (!(step > 0.0)) {
        return 0.0;
    }
    const double dither    = sigma / step;
    const double amplitude = step / DIG_PI * exp(-2.0 * DIG_PI * DIG_PI * dither * dither);
    return fmin(amplitude / sqrt(2.0), step / sqrt(12.0));
}

enum dig_status dig_cylinder_push(const struct dig_cylinder *const cylinder, const double head_Pa,
                                  const double rod_Pa, const double step_Pa,
                                  struct dig_push *const push)
{
    assert(cylinder != NULL && push != NULL);
    if (!isfinite(head_Pa) || !isfinite(rod_Pa)) {
        return DIG_EINVAL;
    }

    const double head_m2   = cylinder->count * dig_cylinder_head_m2(cylinder);
    const double rod_m2    = cylinder->count * dig_cylinder_rod_m2(cylinder);
    const double sigma_Pa  = cylinder->pressure_sigma_Pa;
    const double margin_Pa = 0.5 * step_Pa + 3.0 * sigma_Pa;
    const double areas_m2  = sqrt(head_m2 * head_m2 + rod_m2 * rod_m2);

    *push = (struct dig_push){
        .push_N  = head_Pa * head_m2 - rod_Pa * rod_m2,
        .sigma_N = areas_m2 * dig_reading_sigma(step_Pa, sigma_Pa),
        .slow_N  = areas_m2 * dig_reading_slow(step_Pa, sigma_Pa),
        .valid   = fmax(head_Pa, rod_Pa) < cylinder->relief_Pa - margin_Pa &&
                 fmin(head_Pa, rod_Pa) > vacuum_Pa - margin_Pa,
    };
    return DIG_OK;
}

double dig_cylinder_seal_N(const struct dig_cylinder *const cylinder)
{
    assert(cylinder != NULL);
    return seal_share * cylinder->count * cylinder->relief_Pa * dig_cylinder_head_m2(cylinder);
}

bool dig_cylinder_is_clear(const struct dig_cylinder *const cylinder, const double length_m)
{
    return length_m > cylinder->min_length_m + DIG_CYLINDER_STOP_MARGIN_m &&
           length_m < cylinder->max_length_m - DIG_CYLINDER_STOP_MARGIN_m;
}
