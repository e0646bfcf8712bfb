#include "closed_loop/recordings/force_units.h"

#include <assert.h>
#include <math.h>

// Half way, by factors, from one unit to the next.
static const double factor = 31.6;

// Squares of one channel at one point.
static double square_of(const struct dig_curve *const curve, const struct dig_measured *const dig,
                        const size_t channel, const size_t point)
{
    const double value =
        curve != NULL ? (double)curve->mean[channel][point] : dig->value[channel][point];
    return value * value;
}

// Rms of channels [first, end) of an entry, or of the dig, along what the dig tells.
static double size_of(const struct dig_curve *const curve, const struct dig_measured *const dig,
                      const size_t first, const size_t end)
{
    double sum   = 0.0;
    double count = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        for (size_t c = first; c < end && at >= dig->first && at <= dig->last; c++) {
            sum += square_of(curve, dig, c, k);
            count += 1.0;
        }
    }
    return count > 0.0 ? sqrt(sum / count) : 0.0;
}

// The size of these channels against that of the table's gravels.
static enum dig_status check(const struct dig_curve_set *const set,
                             const struct dig_measured *const dig, const size_t first,
                             const size_t end, const char *const columns, const char *const unit,
                             struct dig_error *const error)
{
    double least = INFINITY;
    double most  = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t at = e * set->trajectories + (size_t)dig->trajectory;
        if (set->packings[at] > 0) {
            const double size = size_of(&set->curve[at], dig, first, end);
            least             = fmin(least, size);
            most              = fmax(most, size);
        }
    }
    const double size = size_of(NULL, dig, first, end);
    if (most > 0.0 && size < least / factor) {
        return dig_error_set(
            error, DIG_EINVAL,
            "%s: %.2g of what the table's weakest gravel resists with, expected %s", columns,
            size / least, unit);
    }
    if (most > 0.0 && size > most * factor) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: %.2g times what the table's strongest gravel resists with, "
                             "expected N and N m",
                             columns, size / most);
    }
    return DIG_OK;
}

enum dig_status dig_force_units_check(const struct dig_curve_set *const set,
                                      const struct dig_measured *const  dig,
                                      struct dig_error *const           error)
{
    assert(set != NULL && dig != NULL && dig->trajectory >= 0);
    enum dig_status status =
        check(set, dig, DIG_CHANNEL_MY_Nm, DIG_CHANNEL_FX_N, "My_Nm", "N m, not kN m", error);
    if (status == DIG_OK && dig->measured[DIG_CHANNEL_FX_N] && dig->measured[DIG_CHANNEL_FZ_N]) {
        status =
            check(set, dig, DIG_CHANNEL_FX_N, DIG_FORCE_CHANNELS, "Fx_N, Fz_N", "N, not kN", error);
    }
    return status;
}
