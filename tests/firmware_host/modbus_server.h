// libmodbus' own server on loopback: twelve input registers, here and far off. It counts what it is
// asked for, and misbehaves on request.

#ifndef DIG_TESTS_FIRMWARE_HOST_MODBUS_SERVER_H
#define DIG_TESTS_FIRMWARE_HOST_MODBUS_SERVER_H

#include <modbus/modbus.h>
#include <pthread.h>
#include <stdatomic.h>

#define MODBUS_SERVER_FAR 1000 // where the registers stand once more

/// Zeroed but for what it is to do.
struct modbus_server {
    int               listener, port;
    modbus_mapping_t *mapping;
    atomic_bool       stop;
    atomic_bool       hang_up;          // end the connection instead of answering
    atomic_int        refuse;           // answer so many requests with an exception
    atomic_int        refused;          // requests for this register get an exception; 0: none
    atomic_int        muted;            // requests for this register get no answer; 0: none
    atomic_int        slow_ms;          // before each byte of an answer; 0: at once
    atomic_int        first, registers; // of the last request
    atomic_int        reads, writes, connections, unanswered;
    pthread_t         thread;
};

/// Takes a port, where connections are refused until it is started.
void modbus_server_bind(struct modbus_server *s);
void modbus_server_start(struct modbus_server *s);
/// Both.
void modbus_server_open(struct modbus_server *s);
void modbus_server_stop(struct modbus_server *s);

#endif // DIG_TESTS_FIRMWARE_HOST_MODBUS_SERVER_H
