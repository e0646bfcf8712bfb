// A log-normal distribution of grain sizes by mass, cut into classes of equal mass.

#ifndef DIG_CORE_LOG_NORMAL_H
#define DIG_CORE_LOG_NORMAL_H

#include "core/scene.h"

#include <stdint.h>

/// Half of the mass is in grains smaller than median_m; the logarithm of the diameter spreads by
/// sigma. Each class is given the diameter below which half of its own mass is: the
/// (2 i + 1) / (2 classes) quantile. DIG_EINVAL, with size[] untouched, unless median_m > 0,
/// 0 < sigma <= 2 and 2 <= classes <= DIG_SIZES_MAX.
DIG_MUST_CHECK enum dig_status dig_log_normal_classes(double median_m, double sigma,
                                                      uint32_t classes, struct dig_size size[]);

#endif // DIG_CORE_LOG_NORMAL_H
