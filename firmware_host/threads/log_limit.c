#include "firmware_host/threads/log_limit.h"

#include <assert.h>
#include <stddef.h>

bool dig_log_limit_allows(struct dig_log_limit *const limit, const int64_t now_ns)
{
    assert(limit != NULL);
    const int64_t from_ns = limit->full_ns > now_ns ? limit->full_ns : now_ns;
    if (from_ns - now_ns > (DIG_LOG_LIMIT_BURST - 1) * DIG_LOG_LIMIT_EVERY_ns) {
        limit->held++;
        limit->held_ns = now_ns;
        return false;
    }
    limit->full_ns = from_ns + DIG_LOG_LIMIT_EVERY_ns;
    return true;
}

int64_t dig_log_limit_held(struct dig_log_limit *const limit)
{
    assert(limit != NULL);
    const int64_t held = limit->held;
    limit->held        = 0;
    return held;
}

int64_t dig_log_limit_held_before(struct dig_log_limit *const limit, const int64_t now_ns,
                                  const bool ends)
{
    assert(limit != NULL);
    return ends || now_ns - limit->held_ns > DIG_LOG_LIMIT_SILENT_ns ? dig_log_limit_held(limit)
                                                                     : 0;
}
