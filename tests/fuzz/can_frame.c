// CAN frames through the map and the assembler: the input is a list of frames of twelve bytes,
// message, length, time since the frame before, and data. No sample may hold a number that is not
// finite.

#include "firmware_host/bus/signal_map.h"
#include "firmware_host/tick/assemble.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAPS = 2, FRAME = 12 };

static struct dig_signal_map         map[MAPS];
static struct dig_assembler_settings settings[MAPS];

static void load(const size_t m, const char *const dbc_path, const char *const map_path)
{
    struct dig_dbc dbc = { 0 };
    if (dig_dbc_read(dbc_path, &dbc, NULL) != DIG_OK ||
        dig_signal_map_read(map_path, &dbc, &map[m], NULL) != DIG_OK) {
        (void)fprintf(stderr, "%s, %s: refused\n", dbc_path, map_path);
        exit(2);
    }
    dig_dbc_finish(&dbc);
    settings[m] = (struct dig_assembler_settings){
        .time_scale = 1.0,
        .coherent_s = map[m].coherent_s,
        .frozen_s   = map[m].frozen_s,
        .optional_s = 1.0,
        .stuck_s    = map[m].stuck_s,
        .has_alive  = map[m].has_alive,
        .groups     = (unsigned)map[m].groups,
    };
    for (size_t g = 0; g < map[m].groups; g++) {
        settings[m].needed[g]      = map[m].group[g].needed;
        settings[m].dispensable[g] = map[m].group[g].dispensable;
        settings[m].frame[g]       = map[m].group[g].frame;
    }
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        settings[m].max_rate[i] = map[m].entry[i].max_rate;
    }
}

static void check(const struct dig_sample *const sample)
{
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (sample->valid[i] && !isfinite(sample->value[i])) {
            (void)fprintf(stderr, "a sample that is not finite\n");
            abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (map[0].groups == 0) {
        load(0, "config/can/zx200.dbc", "config/signals/zx200_can.yaml");
        load(1, "tests/data/sealed/zx200_sealed.dbc", "tests/data/sealed/signals.yaml");
    }
    if (size == 0) {
        return 0;
    }
    const size_t                m = data[0] % MAPS;
    static struct dig_assembler assembler;
    dig_assembler_init(&assembler, &settings[m]);
    data++;
    size--;
    for (int64_t time_ns = 1000000000; size >= FRAME; data += FRAME, size -= FRAME) {
        const struct dig_map_group *const named = &map[m].group[data[0] % map[m].groups];
        const int group = dig_signal_map_group(&map[m], named->id, named->extended);
        time_ns += ((int64_t)data[2] << 8 | data[3]) * 10000;
        struct dig_reading reading;
        struct dig_sample  sample;
        if (dig_signal_map_frame(&map[m], (unsigned)group, data[1] % 9U, data + 4, time_ns,
                                 &reading) == DIG_OK &&
            dig_assembler_take(&assembler, &reading, &sample)) {
            check(&sample);
        }
    }
    return 0;
}
