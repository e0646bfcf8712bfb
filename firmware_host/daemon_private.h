// What the daemon is made of: daemon.c makes and connects it, daemon_run.c runs its threads.

#ifndef DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H
#define DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H

#include "firmware_host/config/load.h"
#include "firmware_host/daemon.h"
#include "firmware_host/publish/publish.h"

#include <limits.h>
#include <semaphore.h>

#define READINGS  4096
#define RECORDS   4096
#define DIGS      4 // recordings of digs on the way, at most
#define DIGS_MORE 3 // memory for them, beside the estimator's for two, of which the tick has one
#define RESULTS   16
#define ESTIMATES 4096 // seconds of them, for a matcher that is at work

/// Bytes behind the handoffs, in one block with everything else the threads touch.
struct handoff_memory {
    struct dig_reading           readings[READINGS];
    struct dig_record            records[RECORDS];
    struct dig_recorded_dig     *digs[DIGS], *spares[DIGS];
    struct dig_estimate          estimates[ESTIMATES];
    struct dig_fit_result        results[RESULTS];
    struct dig_prediction_basis  basis[3], table[3];
    struct dig_table_update      tables[3];
    struct dig_prediction_record predictions[3];
    struct dig_tick_status       tick_status[3];
    struct dig_log_line          input_log[3], fit_log[3];
};

struct dig_daemon {
    char                     path[PATH_MAX];
    struct dig_loaded        loaded;
    struct dig_estimator    *estimator;
    struct dig_recorded_dig *dig_memory[DIGS_MORE];
    struct dig_input         input;
    struct dig_loop          loop;
    struct dig_fit           fit;
    struct dig_publisher     publisher;
    struct dig_early_match   early;
    struct dig_handoffs      handoffs;
    atomic_llong             publisher_generation;
    struct handoff_memory    memory;
    sem_t                    granted;
    atomic_bool              stop;         // input, tick, matcher
    atomic_bool              stop_publish; // after them
};

#endif // DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H
