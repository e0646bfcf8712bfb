// Rate limit of the log: a burst, then a line a second. Further lines are held back and counted;
// the next line names their number. A bus that comes and goes many times a second would fill a disk
// otherwise; programs read HEALTH, which counts everything.

#ifndef DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H
#define DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H

#include <stdbool.h>
#include <stdint.h>

#define DIG_LOG_LIMIT_BURST    20           // lines at once
#define DIG_LOG_LIMIT_EVERY_ns 1000000000LL // then one in this time
#define DIG_LOG_LIMIT_SILENT_ns                                                                    \
    5000000000LL // so long after the last line held back, the number is logged

/// Zeroed: no line yet. Times are of one clock that does not go back.
struct dig_log_limit {
    int64_t full_ns; // from then on a whole burst is allowed
    int64_t held;    // lines held back and not named yet
    int64_t held_ns; // the last of them
};

/// True when a line is allowed now; otherwise it counts as held back.
bool dig_log_limit_allows(struct dig_log_limit *limit, int64_t now_ns);

/// Number of lines held back, and resets it: at once, with a line that is logged; or, without one,
/// only after DIG_LOG_LIMIT_SILENT_ns or when the daemon ends, else 0.
int64_t dig_log_limit_held(struct dig_log_limit *limit);
int64_t dig_log_limit_held_before(struct dig_log_limit *limit, int64_t now_ns, bool ends);

#endif // DIG_FIRMWARE_HOST_THREADS_LOG_LIMIT_H
