#include "closed_loop/recordings/force_check.h"

#include <assert.h>
#include <math.h>

// Half way, by factors, from one unit to the next.
static const double factor = 31.6;

// Channels [first, end) and what they are called.
struct channels {
    size_t      first, end;
    const char *columns, *unit;
};

// Of some channels along what a dig tells: products with an entry of the table, summed.
struct products {
    double of_entry, of_dig, across;
};

static bool is_told(const struct dig_measured *const dig, const size_t point)
{
    const double at = (double)point / (DIG_CURVE_POINTS - 1);
    return at >= dig->first && at <= dig->last;
}

static struct products multiply(const struct dig_curve *const    entry,
                                const struct dig_measured *const dig,
                                const struct channels *const     channels)
{
    struct products sum = { 0.0, 0.0, 0.0 };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        for (size_t c = channels->first; c < channels->end && is_told(dig, k); c++) {
            const double expected = (double)entry->mean[c][k];
            sum.of_entry += expected * expected;
            sum.of_dig += dig->value[c][k] * dig->value[c][k];
            sum.across += expected * dig->value[c][k];
        }
    }
    return sum;
}

// Whether every channel has one value all along, but for rounding.
static bool stands_still(const struct dig_measured *const dig,
                         const struct channels *const     channels)
{
    double range = 0.0;
    double most  = 0.0;
    for (size_t c = channels->first; c < channels->end; c++) {
        double low  = INFINITY;
        double high = -INFINITY;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            low  = is_told(dig, k) ? fmin(low, dig->value[c][k]) : low;
            high = is_told(dig, k) ? fmax(high, dig->value[c][k]) : high;
        }
        range = fmax(range, high - low);
        most  = fmax(most, fmax(fabs(high), fabs(low)));
    }
    return !(range > 1e-9 * most);
}

// Against all gravels of the table.
static enum dig_status check(const struct dig_curve_set *const set,
                             const struct dig_measured *const  dig,
                             const struct channels *const channels, struct dig_error *const error)
{
    const char *const columns = channels->columns;
    double            least   = INFINITY;
    double            most    = 0.0;
    double            size    = 0.0;
    bool              against = true;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t at = e * set->trajectories + (size_t)dig->trajectory;
        if (set->packings[at] > 0) {
            const struct products sum = multiply(&set->curve[at], dig, channels);
            least                     = fmin(least, sqrt(sum.of_entry));
            most                      = fmax(most, sqrt(sum.of_entry));
            size                      = sqrt(sum.of_dig);
            against                   = against && sum.across < 0.0;
        }
    }
    if (!(most > 0.0)) {
        return DIG_OK;
    }
    if (stands_still(dig, channels)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: one value all along the dig, expected what a sensor reads",
                             columns);
    }
    if (size < least / factor) {
        return dig_error_set(
            error, DIG_EINVAL,
            "%s: %.2g of what the table's weakest gravel resists with, expected %s", columns,
            size / least, channels->unit);
    }
    if (size > most * factor) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: %.2g times what the table's strongest gravel resists with, "
                             "expected N and N m",
                             columns, size / most);
    }
    if (against) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: against what every gravel of the table resists with, expected "
                             "what the soil does to the bucket, not the bucket to the soil",
                             columns);
    }
    return DIG_OK;
}

enum dig_status dig_force_check(const struct dig_curve_set *const set,
                                const struct dig_measured *const dig, struct dig_error *const error)
{
    assert(set != NULL && dig != NULL && dig->trajectory >= 0);
    static const struct channels moment = { DIG_CHANNEL_MY_Nm, DIG_CHANNEL_FX_N, "My_Nm",
                                            "N m, not kN m" };
    static const struct channels forces = { DIG_CHANNEL_FX_N, DIG_FORCE_CHANNELS, "Fx_N, Fz_N",
                                            "N, not kN" };
    const enum dig_status        status = check(set, dig, &moment, error);
    return status == DIG_OK && dig->measured[DIG_CHANNEL_FX_N] && dig->measured[DIG_CHANNEL_FZ_N]
               ? check(set, dig, &forces, error)
               : status;
}
