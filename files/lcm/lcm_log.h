// An LCM event log (lcm-logger's) of the daemon: its samples as a machine recording, and its other
// messages one by one.
//
// A log is a sequence of events: sync word 0xEDA1DA01, event number, time, channel, data, all
// big-endian. A log cut off in its last event (a logger that was killed) is read up to there.

#ifndef DIG_FILES_LCM_LCM_LOG_H
#define DIG_FILES_LCM_LCM_LOG_H

#include "core/error.h"
#include "core/recording.h"
#include "files/lcm/lcm_message.h"

#include <stdbool.h>

/// True when path begins as an LCM log does.
bool dig_lcm_log_is(const char *path);

/// The channel DIGSIGHT_SAMPLE as a machine recording that begins at 0 s. Samples that repeat a
/// time are dropped. DIG_EINVAL: no log, a message of another version of the type, fewer than two
/// samples; DIG_EIO: it cannot be opened. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_lcm_log_read(const char                   *path,
                                                struct dig_machine_recording *recording,
                                                struct dig_error             *error);

/// A log being read, event by event.
struct dig_lcm_log;

/// Close it with dig_lcm_log_close(); path must live as long. DIG_EINVAL: no log; DIG_EIO: it
/// cannot be opened; DIG_ENOMEM. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_lcm_log_open(const char *path, struct dig_lcm_log **log,
                                                struct dig_error *error);

/// The next event, valid until the next call; NULL at the end. Of channels that are not the
/// daemon's the data are left out. DIG_EINVAL, where the log is damaged: nothing behind it is read.
DIG_MUST_CHECK enum dig_status dig_lcm_log_next(struct dig_lcm_log          *log,
                                                const struct dig_lcm_event **event,
                                                struct dig_error            *error);

/// NULL is allowed.
void dig_lcm_log_close(struct dig_lcm_log *log);

/// Hands take(context, log, event) every event in the order they were logged, until one is not
/// DIG_OK, which is returned; log is as dig_lcm_log_next() has it. Errors as above, an empty log is
/// none.
DIG_MUST_CHECK enum dig_status dig_lcm_log_walk(
    const char *path,
    enum dig_status (*take)(void *context, const struct dig_lcm_log *log,
                            const struct dig_lcm_event *event, struct dig_error *error),
    void *context, struct dig_error *error);

/// All messages of the daemon's channels likewise. DIG_ESCHEMA: one of another version of its type.
DIG_MUST_CHECK enum dig_status
dig_lcm_log_each(const char *path, const struct dig_lcm_reader *reader, struct dig_error *error);

#endif // DIG_FILES_LCM_LCM_LOG_H
