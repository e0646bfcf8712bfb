#include "firmware_host/threads/log_limit.h"

#include <assert.h>
#include <stddef.h>

bool dig_log_limit_allows(struct dig_log_limit *const talk, const int64_t now_ns)
{
    assert(talk != NULL);
    const int64_t from_ns = talk->full_ns > now_ns ? talk->full_ns : now_ns;
    if (from_ns - now_ns > (DIG_LOG_LIMIT_BURST - 1) * DIG_LOG_LIMIT_EVERY_ns) {
        talk->held++;
        talk->held_ns = now_ns;
        return false;
    }
    talk->full_ns = from_ns + DIG_LOG_LIMIT_EVERY_ns;
    return true;
}

int64_t dig_log_limit_held(struct dig_log_limit *const talk)
{
    assert(talk != NULL);
    const int64_t held = talk->held;
    talk->held         = 0;
    return held;
}

int64_t dig_log_limit_held_before(struct dig_log_limit *const talk, const int64_t now_ns,
                                  const bool ends)
{
    assert(talk != NULL);
    return ends || now_ns - talk->held_ns > DIG_LOG_LIMIT_SILENT_ns ? dig_log_limit_held(talk) : 0;
}
