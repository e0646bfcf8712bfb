// Parts of the daemon: daemon.c makes and connects them, daemon_run.c runs its threads.

#ifndef DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H
#define DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H

#include "firmware_host/config/load.h"
#include "firmware_host/daemon.h"
#include "firmware_host/handoff_memory.h"

#include <limits.h>
#include <semaphore.h>

#define DIGS_MORE 3 // memory for digs, beside the estimator's for two, of which the tick has one

struct dig_daemon {
    char                      path[PATH_MAX];
    struct dig_loaded         loaded;
    struct dig_estimator     *estimator;
    struct dig_recorded_dig  *dig_memory[DIGS_MORE];
    struct dig_input          input;
    struct dig_loop           loop;
    struct dig_fit            fit;
    struct dig_publisher      publisher;
    struct dig_early_match    early;
    struct dig_handoffs       handoffs;
    atomic_llong              publisher_generation;
    struct dig_handoff_memory memory;
    sem_t                     granted;
    atomic_bool               stop;         // input, tick, matcher
    atomic_bool               stop_publish; // after them
};

#endif // DIG_FIRMWARE_HOST_DAEMON_PRIVATE_H
