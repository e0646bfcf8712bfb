#include "core/sample.h"

#include <assert.h>
#include <stdio.h>
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

bool dig_signal_tells_moment(const enum dig_signal signal)
{
    return signal <= DIG_SIGNAL_BUCKET_rad || signal == DIG_SIGNAL_BUCKET_HEAD_Pa ||
           signal == DIG_SIGNAL_BUCKET_ROD_Pa;
}

bool dig_sample_has_moment(const struct dig_sample *const sample)
{
    assert(sample != NULL);
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        if (!sample->valid[i] && dig_signal_tells_moment((enum dig_signal)i)) {
            return false;
        }
    }
    return true;
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

void dig_signal_name_missing(const bool valid[const DIG_SIGNALS], const size_t size,
                             char text[const])
{
    assert(valid != NULL && size > 0 && text != NULL);
    size_t used = 0;
    text[0]     = '\0';
    for (int i = 0; i < DIG_SIGNALS_NEEDED && used < size; i++) {
        if (!valid[i]) {
            (void)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", names[i]);
            used = strlen(text);
        }
    }
}
