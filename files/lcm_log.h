// An LCM event log (lcm-logger's) of the daemon: its samples as a machine recording, and its other
// messages one by one.
//
// A log is a sequence of events: sync word 0xEDA1DA01, event number, time, channel, data, all
// big-endian. A log cut off in its last event (a logger that was killed) is read up to there.

#ifndef DIG_FILES_LCM_LOG_H
#define DIG_FILES_LCM_LOG_H

#include "core/error.h"
#include "core/recording.h"

#include "messages/digsight_estimate_t.h"
#include "messages/digsight_health_t.h"
#include "messages/digsight_match_t.h"
#include "messages/digsight_prediction_t.h"

#include <stdbool.h>

/// True when path begins as an LCM log does.
bool dig_lcm_log_is(const char *path);

/// The channel DIGSIGHT_SAMPLE as a machine recording that begins at 0 s. Samples that repeat a
/// time are dropped. DIG_EINVAL: no log, a message of another version of the type, fewer than two
/// samples; DIG_EIO: it cannot be opened. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_lcm_log_read(const char                   *path,
                                                struct dig_machine_recording *recording,
                                                struct dig_error             *error);

/// What to do with each kind of message; NULL: passed over. Messages are valid during the call
/// only. time_us is the logger's wall clock.
struct dig_lcm_log_reader {
    void *context;
    void (*estimate)(void *context, int64_t time_us, const digsight_estimate_t *message);
    void (*match)(void *context, int64_t time_us, const digsight_match_t *message);
    void (*prediction)(void *context, int64_t time_us, const digsight_prediction_t *message);
    void (*health)(void *context, int64_t time_us, const digsight_health_t *message);
};

/// All messages of the daemon's channels in the order they were logged. Errors as above, an empty
/// log is none.
DIG_MUST_CHECK enum dig_status dig_lcm_log_each(const char                      *path,
                                                const struct dig_lcm_log_reader *reader,
                                                struct dig_error                *error);

#endif // DIG_FILES_LCM_LOG_H
