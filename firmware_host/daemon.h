// The daemon behind its options: loads, runs and stops its threads.
//
//   input thread -> readings -> tick -> records, predictions, tick_status -> publisher -> LCM
//                               ^  |                                  ^
//                basis, table --+  +-- digs -> matcher -- results ----+

#ifndef DIG_FIRMWARE_HOST_DAEMON_H
#define DIG_FIRMWARE_HOST_DAEMON_H

#include "core/machine.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config.h"
#include "firmware_host/publish/publish.h"

#include <stdio.h>

struct dig_daemon;

/// Reads the configuration and everything it names: table, machine, DBC, map, recording.
/// DIG_EINVAL, DIG_ESCHEMA or DIG_EIO with the file, line, key and what was expected; also a table
/// whose scene is not the one asked for, or whose bucket is not of the machine's shape.
DIG_MUST_CHECK enum dig_status dig_daemon_create(const char *config, struct dig_daemon **daemon,
                                                 struct dig_error *error);

/// NULL is allowed.
void dig_daemon_destroy(struct dig_daemon *daemon);

/// Describes what was loaded, line by line through say, or as a JSON object.
void dig_daemon_describe(const struct dig_daemon *daemon, void (*say)(const char *line));
void dig_daemon_describe_json(const struct dig_daemon *daemon, FILE *file);

/// Runs until SIGTERM or SIGINT (SIGHUP exchanges the table), or until a replay has ended and all
/// of it is published. say: a line of the log. DIG_EIO: a thread could not be started.
DIG_MUST_CHECK enum dig_status
dig_daemon_run(struct dig_daemon *daemon, void (*say)(const char *line), struct dig_error *error);

#endif // DIG_FIRMWARE_HOST_DAEMON_H
