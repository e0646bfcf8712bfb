// The publisher's text output: the log.

#ifndef DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_LOG_H
#define DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_LOG_H

#include "firmware_host/publish/publish.h"

/// Logs a line.
__attribute__((format(printf, 2, 3))) void dig_publisher_log(const struct dig_publisher *publisher,
                                                             const char *format, ...);

/// Logs a line that may repeat, errors and states that come and go, within the rate limit.
__attribute__((format(printf, 2, 3))) void
dig_publisher_log_limited(struct dig_publisher *publisher, const char *format, ...);

/// Logs the number of lines held back; nothing for 0.
void dig_publisher_log_held(const struct dig_publisher *publisher, int64_t held);

/// Logs the gravel of the last result, or what to do where none is known.
void dig_publisher_log_match(const struct dig_publisher *publisher);

/// Logs the counters of dropped values when they changed, at most every ten seconds: HEALTH has
/// them for programs.
void dig_publisher_log_drops(struct dig_publisher *publisher, int64_t now_ns);

#endif // DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_LOG_H
