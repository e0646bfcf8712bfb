#include "firmware_host/bus/stuck.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

// Stores the values; true when they changed.
static bool changed(const size_t count, const double value[], double kept[])
{
    const bool same = memcmp(value, kept, count * sizeof value[0]) == 0;
    memcpy(kept, value, count * sizeof value[0]);
    return !same;
}

// Widens the range of each value, or starts it anew; returns the widest. A NaN has no range.
static double widen(const size_t count, const double value[], const bool anew, double low[],
                    double high[])
{
    double widest = 0.0;
    for (size_t i = 0; i < count; i++) {
        low[i]  = anew ? value[i] : fmin(low[i], value[i]);
        high[i] = anew ? value[i] : fmax(high[i], value[i]);
        widest  = fmax(widest, high[i] - low[i]);
    }
    return widest;
}

bool dig_stuck_step(struct dig_stuck *const stuck, const double stuck_s,
                    const struct dig_sample *const sample)
{
    assert(stuck != NULL && sample != NULL);
    const double *const angle = &sample->value[DIG_SIGNAL_BOOM_rad];
    double              pressure[6];
    for (size_t i = 0; i < 6; i++) {
        const size_t s = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + i;
        pressure[i]    = sample->valid[s] ? sample->value[s] : (double)NAN;
    }
    const bool angles_moved    = changed(3, angle, stuck->angle_rad) || !stuck->started;
    const bool pressures_moved = changed(6, pressure, stuck->pressure_Pa) || !stuck->started ||
                                 !dig_sample_is_complete(sample);
    stuck->started   = true;
    stuck->angles_ns = angles_moved ? sample->time_ns : stuck->angles_ns;

    const double went_Pa    = widen(6, pressure, angles_moved, stuck->low_Pa, stuck->high_Pa);
    const double turned_rad = widen(2, angle, pressures_moved, stuck->low_rad, stuck->high_rad);
    const double stood_s    = 1e-9 * (double)(sample->time_ns - stuck->angles_ns);
    return turned_rad > DIG_STUCK_rad || (stood_s > stuck_s && went_Pa > DIG_STUCK_Pa);
}
