#include "core/sample.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

static const char *const names[DIG_SIGNALS] = {
    [DIG_SIGNAL_BOOM_rad]         = "boom_rad",
    [DIG_SIGNAL_ARM_rad]          = "arm_rad",
    [DIG_SIGNAL_BUCKET_rad]       = "bucket_rad",
    [DIG_SIGNAL_BOOM_HEAD_Pa]     = "boom_head_Pa",
    [DIG_SIGNAL_BOOM_ROD_Pa]      = "boom_rod_Pa",
    [DIG_SIGNAL_ARM_HEAD_Pa]      = "arm_head_Pa",
    [DIG_SIGNAL_ARM_ROD_Pa]       = "arm_rod_Pa",
    [DIG_SIGNAL_BUCKET_HEAD_Pa]   = "bucket_head_Pa",
    [DIG_SIGNAL_BUCKET_ROD_Pa]    = "bucket_rod_Pa",
    [DIG_SIGNAL_PITCH_rad]        = "pitch_rad",
    [DIG_SIGNAL_TEMPERATURE_degC] = "temperature_degC",
};

const char *dig_signal_name(const enum dig_signal signal)
{
    return (signal >= 0 && signal < DIG_SIGNALS) ? names[signal] : NULL;
}

int dig_signal_find(const char *const name)
{
    assert(name != NULL);
    for (int i = 0; i < DIG_SIGNALS; i++) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

bool dig_sample_is_complete(const struct dig_sample *const sample)
{
    assert(sample != NULL);
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        if (!sample->valid[i]) {
            return false;
        }
    }
    return true;
}
