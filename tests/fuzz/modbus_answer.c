// Answers of a Modbus TCP server through libmodbus and the daemon's input, over the loopback: the
// input is a list of answers, each a byte of flags, one of length and the bytes. The server hangs
// up after the last. No reading may hold a number that is not finite.

#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"

#include <arpa/inet.h>
#include <math.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define WAIT_ms     1 // for a request; then the answer comes unasked
#define ANSWERS_MAX 4 // of one input, so that none takes long

enum { ITS_OWN_TRANSACTION = 1, IN_TWO_PARTS = 2 };

static struct {
    int            listening;
    const uint8_t *data;
    size_t         size;
    sem_t          go, done;
} server;

static struct dig_signal_map map;
static struct dig_input      input;
static struct dig_reading    memory[64];
static struct dig_log_line   log_lines[3];
static struct dig_ring       readings;
static struct dig_latest     last_line;
static atomic_bool           stop;

static void answer(const int client, const uint8_t *data, size_t size)
{
    for (int answers = 0; size >= 2 && answers < ANSWERS_MAX; answers++) {
        uint8_t       request[260] = { 0 };
        struct pollfd ready        = { .fd = client, .events = POLLIN };
        if (poll(&ready, 1, WAIT_ms) > 0 && recv(client, request, sizeof request, 0) <= 0) {
            return;
        }
        uint8_t      bytes[256];
        const size_t count = data[1] < size - 2 ? data[1] : size - 2;
        memcpy(bytes, data + 2, count);
        if ((data[0] & ITS_OWN_TRANSACTION) == 0 && count > 2) {
            memcpy(bytes, request, 2);
        }
        const size_t part = (data[0] & IN_TWO_PARTS) != 0 ? count / 2 : count;
        (void)send(client, bytes, part, MSG_NOSIGNAL);
        (void)send(client, bytes + part, count - part, MSG_NOSIGNAL);
        data += 2 + count;
        size -= 2 + count;
    }
}

static void *serve(void *const unused)
{
    for (;;) {
        while (sem_wait(&server.go) != 0) {
        }
        const int client = accept(server.listening, NULL, NULL);
        if (client < 0) {
            return unused;
        }
        answer(client, server.data, server.size);
        // No port is to wait for stragglers: thousands of connections a second would use them up.
        const struct linger now = { .l_onoff = 1 };
        (void)setsockopt(client, SOL_SOCKET, SO_LINGER, &now, sizeof now);
        (void)close(client);
        (void)sem_post(&server.done);
    }
}

static void start(void)
{
    struct sockaddr_in address = { .sin_family = AF_INET, .sin_addr = { htonl(INADDR_LOOPBACK) } };
    socklen_t          length  = sizeof address;
    pthread_t          thread;
    server.listening = socket(AF_INET, SOCK_STREAM, 0);
    if (bind(server.listening, (struct sockaddr *)&address, length) != 0 ||
        listen(server.listening, 1) != 0 ||
        getsockname(server.listening, (struct sockaddr *)&address, &length) != 0 ||
        sem_init(&server.go, 0, 0) != 0 || sem_init(&server.done, 0, 0) != 0 ||
        pthread_create(&thread, NULL, serve, NULL) != 0 || pthread_detach(thread) != 0) {
        exit(2);
    }
    const struct dig_modbus_address where = {
        .host = "127.0.0.1", .port = ntohs(address.sin_port), .unit = 1, .poll_s = 1e-6
    };
    dig_ring_init(&readings, sizeof memory[0], sizeof memory / sizeof memory[0], memory);
    dig_latest_init(&last_line, sizeof log_lines[0], log_lines);
    if (dig_signal_map_read("config/signals/modbus_default.yaml", NULL, &map, NULL) != DIG_OK ||
        dig_input_modbus_create(&input, &where, &map) != DIG_OK) {
        exit(2);
    }
    input.readings = &readings;
    input.log      = &last_line;
    input.stop     = &stop;
}

static void check_readings(void)
{
    struct dig_reading reading;
    while (dig_ring_pop(&readings, &reading)) {
        for (size_t i = 0; i < DIG_SIGNALS; i++) {
            if (reading.state[i] == DIG_READING_OK && !isfinite(reading.value[i])) {
                (void)fprintf(stderr, "a reading that is not finite\n");
                abort();
            }
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    if (map.groups == 0) {
        start();
    }
    server.data            = data;
    server.size            = size;
    struct dig_error error = { "" };
    (void)sem_post(&server.go);
    if (input.ops->open(&input, &error) == DIG_OK) { // or it hung up at once
        while (input.ops->read(&input, &error) == DIG_OK) {
            check_readings();
        }
        input.ops->close(&input);
    }
    while (sem_wait(&server.done) != 0) {
    }
    return 0;
}
