// Notifies a service manager (sd_notify's protocol): datagrams to $NOTIFY_SOCKET, nothing when it
// is not set. No libsystemd.

#ifndef DIG_FIRMWARE_HOST_THREADS_NOTIFY_H
#define DIG_FIRMWARE_HOST_THREADS_NOTIFY_H

#include "core/status.h"

#include <stdint.h>

/// Sends one message ("READY=1", "WATCHDOG=1", "STOPPING=1", "STATUS=…"). DIG_OK also when no one
/// listens for it ($NOTIFY_SOCKET unset); DIG_EINVAL: a socket name that cannot be; DIG_EIO. May be
/// ignored: a manager that does not hear us acts on its own.
enum dig_status dig_notify(const char *message);

/// Half of $WATCHDOG_USEC in ns, the interval to send WATCHDOG=1 at; 0 when none is asked for.
int64_t dig_notify_watchdog_ns(void);

#endif // DIG_FIRMWARE_HOST_THREADS_NOTIFY_H
