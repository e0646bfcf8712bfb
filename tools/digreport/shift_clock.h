// A clock that is set while a log is written: a controller without a battery, before the network
// tells it the time. Messages carry the daemon's monotonic clock, too, which goes on meanwhile.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_CLOCK_H
#define DIG_TOOLS_DIGREPORT_SHIFT_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

/// Of one log; zeroed at its beginning.
struct digreport_clock {
    bool    any;
    int64_t time_us;  // of the log, at the last message
    int64_t time_ns;  // monotonic, of that message
    int64_t moved_us; // what is added to the log's time so that it goes on
};

/// True where the clock was set since the message before: back by a second or more, or ahead by
/// more than a minute and a hundred times what the monotonic clock went on by (a bench may scale
/// it). moved_us then is another. A monotonic clock that stands, or begins anew, tells no leap.
bool digreport_clock_is_set(struct digreport_clock *clock, int64_t time_us, int64_t time_ns);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_CLOCK_H
