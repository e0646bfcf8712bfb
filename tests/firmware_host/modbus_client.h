// The daemon's Modbus input on a thread of its own, with all that it hands on.

#ifndef DIG_TESTS_FIRMWARE_HOST_MODBUS_CLIENT_H
#define DIG_TESTS_FIRMWARE_HOST_MODBUS_CLIENT_H

#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"
#include "tests/testlib.h"

#include <pthread.h>
#include <stdbool.h>
#include <time.h>

struct client {
    struct dig_signal_map map;
    struct dig_input      input;
    struct dig_ring       readings;
    struct dig_latest     log;
    struct dig_reading    reading_memory[256];
    struct dig_log_line   log_memory[3];
    atomic_bool           stop;
    pthread_t             thread;
};

/// Not started yet.
static inline void client_make(struct client *const                   c,
                               const struct dig_modbus_address *const address,
                               const char *const                      map)
{
    *c = (struct client){ 0 };
    assert_int_equal(dig_signal_map_read(map, NULL, &c->map, NULL), DIG_OK);
    assert_int_equal(dig_input_modbus_create(&c->input, address, &c->map), DIG_OK);
    dig_ring_init(&c->readings, sizeof c->reading_memory[0], 256, c->reading_memory);
    dig_latest_init(&c->log, sizeof c->log_memory[0], c->log_memory);
    c->input.readings = &c->readings;
    c->input.log      = &c->log;
    c->input.stop     = &c->stop;
}

static inline void *client_main(void *const context)
{
    dig_input_run(&((struct client *)context)->input);
    return NULL;
}

static inline void client_run(struct client *const c)
{
    assert_int_equal(pthread_create(&c->thread, NULL, client_main, c), 0);
}

static inline void client_stop(struct client *const c)
{
    atomic_store(&c->stop, true);
    assert_int_equal(pthread_join(c->thread, NULL), 0);
    dig_input_destroy(&c->input);
}

static inline void pause_ms(void)
{
    const struct timespec pause = { .tv_nsec = 1000000 };
    (void)nanosleep(&pause, NULL);
}

/// Until the next reading, or for ten seconds.
static inline bool next_reading(struct client *const c, struct dig_reading *const reading)
{
    for (int i = 0; i < 10000; i++) {
        if (dig_ring_pop(&c->readings, reading)) {
            return true;
        }
        pause_ms();
    }
    return false;
}

#endif // DIG_TESTS_FIRMWARE_HOST_MODBUS_CLIENT_H
