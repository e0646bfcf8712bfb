#include "core/log_normal.h"

#include <math.h>

// The standard normal's quantile, by bisection of its distribution function: read once a scene.
static double normal_quantile(const double share)
{
    double low  = -10.0;
    double high = 10.0;
    for (int i = 0; i < 64; i++) {
        const double middle = 0.5 * (low + high);
        if (0.5 * erfc(-middle / sqrt(2.0)) < share) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

enum dig_status dig_log_normal_classes(const double median_m, const double sigma,
                                       const uint32_t classes, struct dig_size size[])
{
    if (!(median_m > 0.0 && isfinite(median_m)) || !(sigma > 0.0 && sigma <= 2.0) || classes < 2 ||
        classes > DIG_SIZES_MAX) {
        return DIG_EINVAL;
    }
    for (uint32_t i = 0; i < classes; i++) {
        const double share = (2.0 * i + 1.0) / (2.0 * classes);
        size[i] = (struct dig_size){ .diameter_m = median_m * exp(sigma * normal_quantile(share)),
                                     .mass_fraction = 1.0 / classes };
    }
    return DIG_OK;
}
