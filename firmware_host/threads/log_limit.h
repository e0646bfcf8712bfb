// How much the daemon says to people: a burst, then a line a second. What is more is held back, and
// how much it was is said with the next line. A bus that comes and goes many times a second would
// fill a disk otherwise; programs read HEALTH, which counts everything.

#ifndef DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H
#define DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H

#include <stdbool.h>
#include <stdint.h>

#define DIG_LOG_LIMIT_BURST     20           // lines at once
#define DIG_LOG_LIMIT_EVERY_ns  1000000000LL // and one in so long
#define DIG_LOG_LIMIT_SILENT_ns 5000000000LL // nothing held back for so long: the flood is over

/// Zeroed: nothing was said yet. Times are of one clock that does not go back.
struct dig_log_limit {
    int64_t full_ns; // from then on a whole burst may be said
    int64_t held;    // lines held back that were not spoken of
    int64_t held_ns; // the last of them
};

/// True when a line may be said now; else it is held back, and counted.
bool dig_log_limit_allows(struct dig_log_limit *talk, int64_t now_ns);

/// Lines held back that are to be spoken of, which they are then taken to be: all of them when a
/// line is said, or, saying none, once none was held back for DIG_LOG_LIMIT_SILENT_ns or the daemon
/// ends.
int64_t dig_log_limit_held(struct dig_log_limit *talk);
int64_t dig_log_limit_held_before(struct dig_log_limit *talk, int64_t now_ns, bool ends);

#endif // DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H
