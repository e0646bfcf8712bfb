// Tests for tools/rig/bus/serve_modbus.c: RTU over a pseudo terminal, with a libmodbus client

#define _XOPEN_SOURCE 600 // posix_openpt() and its kin

#include "tools/rig/bus/serve_modbus.h"

#include "tests/rig/modbus_rig.h"

#include <errno.h>
#include <fcntl.h>
#include <modbus/modbus.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

// Two pseudo terminals back to back, as a cable between two serial ports: bytes that come out of
// one master go into the other until the pipe says stop.
struct cable {
    int             master[2];
    char            name[2][64];
    int             keep[2]; // the slaves' ends held open, or a closed one would hang the master up
    pthread_t       thread;
    bool            stop;
    pthread_mutex_t lock;
};

static bool is_cut(struct cable *const cable)
{
    (void)pthread_mutex_lock(&cable->lock);
    const bool stop = cable->stop;
    (void)pthread_mutex_unlock(&cable->lock);
    return stop;
}

static void *carry(void *const argument)
{
    struct cable *const cable = argument;
    while (!is_cut(cable)) {
        bool moved = false;
        for (int i = 0; i < 2; i++) {
            uint8_t       bytes[256];
            const ssize_t n = read(cable->master[i], bytes, sizeof bytes);
            if (n > 0) {
                moved = true;
                if (write(cable->master[1 - i], bytes, (size_t)n) != n) {
                    return NULL;
                }
            }
        }
        if (!moved) {
            const struct timespec wait = { 0, 1000000 };
            (void)nanosleep(&wait, NULL);
        }
    }
    return NULL;
}

static void plug_in(struct cable *const cable)
{
    memset(cable, 0, sizeof *cable);
    (void)pthread_mutex_init(&cable->lock, NULL);
    for (int i = 0; i < 2; i++) {
        cable->master[i] = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
        assert_true(cable->master[i] >= 0);
        assert_int_equal(grantpt(cable->master[i]), 0);
        assert_int_equal(unlockpt(cable->master[i]), 0);
        (void)snprintf(cable->name[i], sizeof cable->name[i], "%s", ptsname(cable->master[i]));
        cable->keep[i] = open(cable->name[i], O_RDWR | O_NOCTTY);
        struct termios raw;
        assert_int_equal(tcgetattr(cable->keep[i], &raw), 0);
        raw.c_iflag = raw.c_oflag = raw.c_lflag = 0;
        assert_int_equal(tcsetattr(cable->keep[i], TCSANOW, &raw), 0);
    }
    assert_int_equal(pthread_create(&cable->thread, NULL, carry, cable), 0);
}

static void unplug(struct cable *const cable)
{
    (void)pthread_mutex_lock(&cable->lock);
    cable->stop = true;
    (void)pthread_mutex_unlock(&cable->lock);
    (void)pthread_join(cable->thread, NULL);
    for (int i = 0; i < 2; i++) {
        (void)close(cable->keep[i]);
        (void)close(cable->master[i]);
    }
    (void)pthread_mutex_destroy(&cable->lock);
}

TEST(slave_1_on_a_serial_line_serves_reads_and_refuses_writes)
{
    struct cable cable;
    plug_in(&cable);
    struct rig       rig;
    char             where[200];
    char             address[100];
    struct dig_error error = { "" };
    memset(&rig, 0, sizeof rig);
    assert_true(dig_rig_board_init(&rig.board, &rig.faults));
    dig_rig_board_write(&rig.board, registers, 0.0);
    (void)snprintf(address, sizeof address, "%s:57600", cable.name[0]);
    assert_ok(
        dig_rig_modbus_start_rtu(address, &rig.board, sizeof where, where, &rig.server, &error),
        error);
    assert_non_null(strstr(where, "slave 1"));
    assert_non_null(strstr(where, "57600 baud"));

    modbus_t *const client = modbus_new_rtu(cable.name[1], 57600, 'N', 8, 1);
    assert_non_null(client);
    assert_int_equal(modbus_set_slave(client, 1), 0);
    assert_int_equal(modbus_connect(client), 0);
    modbus_set_response_timeout(client, 2, 0);
    uint16_t found[DIG_RIG_REGISTERS];
    for (int i = 0; i < 5; i++) {
        memset(found, 0, sizeof found);
        assert_int_equal(modbus_read_input_registers(client, 0, 12, found), 12);
        assert_memory_equal(found, registers, sizeof registers);
    }
    assert_int_equal(modbus_read_registers(client, 0, 12, found), 12);
    assert_int_equal(modbus_write_register(client, 0, 9), -1);
    assert_int_equal(errno, EMBXILFUN);

    // Another slave's requests are none of its business.
    assert_int_equal(modbus_set_slave(client, 2), 0);
    modbus_set_response_timeout(client, 0, 100000);
    assert_int_equal(modbus_read_registers(client, 0, 12, found), -1);
    assert_int_equal(errno, ETIMEDOUT);
    assert_int_equal(modbus_set_slave(client, 1), 0);
    modbus_set_response_timeout(client, 2, 0);
    assert_int_equal(modbus_read_registers(client, 0, 12, found), 12);

    leave(client);
    stop(&rig);
    unplug(&cable);
    assert_int_equal(rig.requests.served[4], 5);
    assert_int_equal(rig.requests.served[3], 2);
    assert_int_equal(rig.requests.refused[6], 1);
}
