// What comes off a bus, damaged, under AddressSanitizer and UBSan: CAN frames of a mutated DBC
// through map and assembler, and replies of a Modbus server through the daemon's own input.
//
//   fuzz_bus can|modbus SECONDS [SEED] [CORPUS]
//
// CORPUS holds what mutation starts from: tests/fuzz/corpus/can.txt (candump -L lines) and
// modbus.txt (replies in hex, a line each). Prints how much was taken and refused. No sample may
// hold a number that is not finite.

#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/tick/assemble.h"
#include "tests/fuzz/random.h"

#include <arpa/inet.h>
#include <math.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define LINES 256
#define BYTES 512

struct piece {
    uint32_t id;
    size_t   size;
    uint8_t  data[BYTES];
};

static struct piece corpus[LINES];
static size_t       pieces;
// "(1.0) vcan0 18FF79E8#6937323732370000", or hex alone.
static void load_corpus(const char *const path)
{
    char        line[2 * BYTES + 64];
    FILE *const file = fopen(path, "r");
    while (file != NULL && pieces < LINES && fgets(line, sizeof line, file) != NULL) {
        struct piece *const p    = &corpus[pieces];
        char *const         hash = strchr(line, '#');
        const char         *hex  = hash != NULL ? hash + 1 : line;
        if (hash != NULL) {
            *hash = '\0';
            p->id = (uint32_t)strtoul(strrchr(line, ' ') + 1, NULL, 16);
        }
        for (unsigned byte; p->size < BYTES && sscanf(hex, "%2x", &byte) == 1; hex += 2) {
            p->data[p->size++] = (uint8_t)byte;
        }
        pieces += p->size > 0;
    }
    if (file == NULL || fclose(file) != 0 || pieces == 0) {
        (void)fprintf(stderr, "%s: no corpus\n", path);
        exit(2);
    }
}

static struct piece mutated(void)
{
    struct piece p = corpus[below(pieces)];
    for (size_t edits = below(6); edits > 0; edits--) {
        switch (below(4)) {
        case 0: p.data[below(p.size)] = (uint8_t)next(); break;
        case 1: p.data[below(p.size)] ^= (uint8_t)(1U << below(8)); break;
        case 2: p.size = 1 + below(p.size); break;
        default:
            if (p.size + 9 < BYTES) {
                p.data[p.size] = (uint8_t)next();
                p.size += 1 + below(8);
            }
            break;
        }
    }
    return p;
}

// A DBC with some numbers changed, and our map over it; false when it is refused.
static bool make_map(struct dig_signal_map *const map)
{
    static char    good[1 << 16];
    static size_t  size;
    struct dig_dbc dbc;
    char           path[64];
    if (size == 0) {
        FILE *const file = fopen("tests/data/sealed/zx200_sealed.dbc", "rb");
        size             = file != NULL ? fread(good, 1, sizeof good - 1, file) : 0;
        (void)(file != NULL && fclose(file));
    }
    static char text[sizeof good];
    memcpy(text, good, size);
    for (size_t edits = below(6); edits > 0; edits--) {
        char *const at = text + below(size);
        *at            = *at >= '0' && *at <= '9' ? (char)('0' + below(10)) : *at;
    }
    (void)snprintf(path, sizeof path, "/tmp/fuzz_bus.%d.dbc", (int)getpid());
    FILE *const file = fopen(path, "wb");
    if (file == NULL || fwrite(text, 1, size, file) != size || fclose(file) != 0) {
        exit(2);
    }
    bool made = dig_dbc_read(path, &dbc, NULL) == DIG_OK;
    if (made) {
        made = dig_signal_map_read("tests/data/sealed/signals.yaml", &dbc, map, NULL) == DIG_OK;
        dig_dbc_finish(&dbc);
    }
    (void)remove(path);
    return made;
}

static void check_sample(const struct dig_sample *const sample)
{
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (!isfinite(sample->value[i])) {
            (void)fprintf(stderr, "a sample that is not finite\n");
            abort();
        }
    }
}

static void fuzz_can(const time_t end)
{
    long maps = 0, frames = 0, taken = 0, samples = 0;
    while (time(NULL) < end) {
        static struct dig_signal_map map;
        if (!make_map(&map)) {
            continue;
        }
        maps++;
        struct dig_assembler_settings settings = { .time_scale = 1.0,
                                                   .coherent_s = map.coherent_s,
                                                   .frozen_s   = map.frozen_s,
                                                   .optional_s = 1.0,
                                                   .stuck_s    = map.stuck_s,
                                                   .has_alive  = map.has_alive,
                                                   .groups     = (unsigned)map.groups };
        for (size_t g = 0; g < map.groups; g++) {
            settings.needed[g]      = map.group[g].needed;
            settings.dispensable[g] = map.group[g].dispensable;
            settings.frame[g]       = map.group[g].frame;
        }
        for (size_t i = 0; i < DIG_SIGNALS; i++) {
            settings.max_rate[i] = map.entry[i].max_rate;
        }
        static struct dig_assembler a;
        dig_assembler_init(&a, &settings);
        for (int64_t i = 0; i < 2000; i++) {
            const struct piece p     = mutated();
            const int          group = dig_signal_map_group(&map, p.id, true);
            struct dig_reading reading;
            struct dig_sample  sample;
            frames++;
            if (group < 0 ||
                dig_signal_map_frame(&map, (unsigned)group, p.size < 8 ? p.size : 8, p.data,
                                     1000000000 + i * 2500000 - (int64_t)below(3) * 5000000,
                                     &reading) != DIG_OK) {
                continue;
            }
            taken++;
            if (dig_assembler_take(&a, &reading, &sample)) {
                samples++;
                check_sample(&sample);
            }
        }
    }
    (void)printf("can: %ld maps, %ld frames, %ld taken, %ld samples\n", maps, frames, taken,
                 samples);
}

// A server that answers whatever comes with a mutated reply, now and then the right one, and hangs
// up after a few.
static void *serve(void *const context)
{
    const int listening = *(int *)context;
    for (;;) {
        const int client = accept(listening, NULL, NULL);
        if (client < 0) {
            return NULL;
        }
        for (size_t left = 1 + below(2); left > 0; left--) {
            uint8_t request[BYTES];
            if (recv(client, request, sizeof request, 0) <= 0) {
                break;
            }
            struct piece p = mutated();
            if (below(3) != 0 && p.size > 2) {
                memcpy(p.data, request, 2); // the transaction it asked for
            }
            (void)send(client, p.data, p.size, MSG_NOSIGNAL);
        }
        (void)close(client);
    }
}

static void fuzz_modbus(const time_t end)
{
    struct sockaddr_in address = { .sin_family = AF_INET, .sin_addr = { htonl(INADDR_LOOPBACK) } };
    socklen_t          length  = sizeof address;
    int                listening = socket(AF_INET, SOCK_STREAM, 0);
    pthread_t          thread;
    if (bind(listening, (struct sockaddr *)&address, length) != 0 || listen(listening, 1) != 0 ||
        getsockname(listening, (struct sockaddr *)&address, &length) != 0 ||
        pthread_create(&thread, NULL, serve, &listening) != 0) {
        exit(2);
    }
    static struct dig_signal_map    map;
    static struct dig_reading       memory[64];
    static struct dig_log_line      lines[3];
    struct dig_ring                 readings;
    struct dig_latest               latest;
    struct dig_input                input = { 0 };
    atomic_bool                     stop  = false;
    const struct dig_modbus_address where = {
        .host = "127.0.0.1", .port = ntohs(address.sin_port), .unit = 1, .poll_s = 1e-5
    };
    dig_ring_init(&readings, sizeof memory[0], 64, memory);
    dig_latest_init(&latest, sizeof lines[0], lines);
    if (dig_signal_map_read("config/signals/modbus_default.yaml", NULL, &map, NULL) != DIG_OK ||
        dig_input_modbus_create(&input, &where, &map) != DIG_OK) {
        exit(2);
    }
    input.readings = &readings;
    input.log      = &latest;
    input.stop     = &stop;
    long opened    = 0;
    while (time(NULL) < end) {
        struct dig_error error = { "" };
        if (input.ops->open(&input, &error) != DIG_OK) {
            continue;
        }
        opened++;
        while (time(NULL) < end && input.ops->read(&input, &error) == DIG_OK) {
            struct dig_reading reading;
            while (dig_ring_pop(&readings, &reading)) {
            }
        }
        input.ops->close(&input);
    }
    (void)printf("modbus: %ld connections, %lld good, %lld malformed, %lld late\n", opened,
                 atomic_load(&input.frames), atomic_load(&input.malformed),
                 atomic_load(&input.timeouts));
    dig_input_destroy(&input);
}

int main(const int argc, char *argv[])
{
    if (argc < 3) {
        (void)fprintf(stderr, "usage: fuzz_bus can|modbus SECONDS [SEED] [CORPUS]\n");
        return 2;
    }
    const bool   can = strcmp(argv[1], "can") == 0;
    const time_t end = time(NULL) + (time_t)strtol(argv[2], NULL, 10);
    state            = argc > 3 ? strtoull(argv[3], NULL, 0) : 1;
    load_corpus(argc > 4 ? argv[4]
                : can    ? "tests/fuzz/corpus/can.txt"
                         : "tests/fuzz/corpus/modbus.txt");
    if (can) {
        fuzz_can(end);
    } else {
        fuzz_modbus(end);
    }
    (void)printf("1 passed, 0 failed\n");
    return 0;
}
