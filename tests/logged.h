// Messages written into a log by LCM's own library.

#ifndef DIG_TESTS_LOGGED_H
#define DIG_TESTS_LOGGED_H

#include "tests/testlib.h"

#include <lcm/eventlog.h>
#include <stdio.h>
#include <stdlib.h>

/// Defines log_TYPE(log, channel, time_us, message).
#define LOG_TYPE(type)                                                                             \
    static void log_##type(lcm_eventlog_t *const log, const char *const channel,                   \
                           const int64_t time_us, const digsight_##type##_t *const message)        \
    {                                                                                              \
        const int            size  = digsight_##type##_t_encoded_size(message);                    \
        void *const          bytes = malloc((size_t)size);                                         \
        char                 name[32];                                                             \
        lcm_eventlog_event_t event = {                                                             \
            .timestamp = time_us, .datalen = size, .channel = name, .data = bytes                  \
        };                                                                                         \
        event.channellen = snprintf(name, sizeof name, "%s", channel);                             \
        assert_int_equal(digsight_##type##_t_encode(bytes, 0, size, message), size);               \
        assert_int_equal(lcm_eventlog_write_event(log, &event), 0);                                \
        free(bytes);                                                                               \
    }

#endif // DIG_TESTS_LOGGED_H
