// Periodic sides: a grain that leaves at y = +P/2 enters at -P/2, and grains touch across.

#ifndef DIG_OFFLINE_DEM_LAW_PERIOD_H
#define DIG_OFFLINE_DEM_LAW_PERIOD_H

#include "offline_dem/law/both.h"

/// Nearest image of a distance in y, in [-period/2, period/2]; the distance itself for period 0.
/// Uses only operations that every processor rounds alike, and no branch, so that loops vectorise.
DIG_BOTH static inline double dig_period_fold(const double y_m, const double period_m,
                                              const double inverse_period)
{
    const double whole = 6755399441055744.0; // 1.5 x 2^52: adding it rounds to integers
    return y_m - period_m * ((y_m * inverse_period + whole) - whole);
}

/// 1 / period, 0 for none.
DIG_BOTH static inline double dig_period_inverse(const double period_m)
{
    return period_m > 0.0 ? 1.0 / period_m : 0.0;
}

#endif // DIG_OFFLINE_DEM_LAW_PERIOD_H
