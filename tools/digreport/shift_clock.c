#include "tools/digreport/shift_clock.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#define BACK_us       1000000
#define AHEAD_us      60000000.0
#define SCALE_MOST    100.0              // of time_scale
#define MOVED_MOST_us (INT64_C(1) << 54) // a log that says more is nobody's

bool digreport_clock_is_set(struct digreport_clock *const clock, const int64_t time_us,
                            const int64_t time_ns)
{
    assert(clock != NULL && time_us >= 0 && time_us <= INT64_C(1) << 53);
    const struct digreport_clock before  = *clock;
    const int64_t                went_us = time_us - before.time_us;
    const double                 mono_us = 1e-3 * ((double)time_ns - (double)before.time_ns);
    const bool                   back    = went_us < -BACK_us;
    const bool ahead = mono_us > 0.0 && (double)went_us > AHEAD_us + SCALE_MOST * mono_us;
    clock->any       = true;
    clock->time_us   = time_us;
    clock->time_ns   = time_ns;
    if (!before.any || !(back || ahead)) {
        return false;
    }
    // Between the two messages it went on as the monotonic clock did, where that did not begin
    // anew.
    const double mono_most_us = 60e6;
    const double on_us        = mono_us > 0.0 && mono_us < mono_most_us ? mono_us : 0.0;
    clock->moved_us           = before.moved_us - went_us + (int64_t)on_us;
    if (llabs(clock->moved_us) > MOVED_MOST_us) {
        clock->moved_us = 0;
    }
    return true;
}
