// The publishing thread: publishes the other threads' queues over LCM, writes the log, and feeds
// the service manager's watchdog.

#ifndef DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_H
#define DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_H

#include "firmware_host/publish/output.h"
#include "firmware_host/threads/log_limit.h"

#define DIG_STATE_STARTING "starting"
#define DIG_STATE_WAITING  "waiting for bus"
#define DIG_STATE_RUNNING  "running"
#define DIG_STATE_STOPPING "stopping"

struct dig_publisher {
    const struct dig_config    *config;
    const struct dig_curve_set *set;
    struct dig_handoffs        *handoffs;
    const atomic_bool          *stop;
    atomic_llong               *generation; // out: of the table in use here
    void (*say)(
        const char *line);    // a line of the log, on this thread, as often as log_limit.h allows
    struct dig_health health; // rt, tick_s, input and fit fixed at start

    // the thread's own
    struct dig_output    *output;
    struct dig_log_line   note;
    struct dig_fit_result result; // the last one
    bool                  any_result;
    int64_t next_health_ns, next_match_ns, next_watchdog_ns, next_lcm_ns, next_drops_ns;
    int64_t lcm_pause_ns;
    struct dig_table_update update; // a table, from when the tick uses it
    int64_t                 logged_drops;
    struct dig_log_limit    log_limit; // of lines that repeat as a bus comes and goes
    uint64_t                record_count;
    bool                    seen[DIG_SIGNALS]; // signals that had a value since the last HEALTH
    bool                    any_seen;
};

/// The thread: returns after *stop, when all that was left is published.
void dig_publisher_run(struct dig_publisher *publisher);

#endif // DIG_FIRMWARE_HOST_PUBLISH_PUBLISH_H
