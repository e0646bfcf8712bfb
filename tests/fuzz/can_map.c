// A DBC that a map is laid over: where it is taken, each message is decoded of the DBC's own bytes.
// No reading may hold a number that is not finite.

#include "firmware_host/bus/signal_map.h"
#include "tests/fuzz/as_file.h"

#include <math.h>

static void check_reading(const struct dig_reading *const reading)
{
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (reading->state[i] == DIG_READING_OK && !isfinite(reading->value[i])) {
            (void)fprintf(stderr, "a reading that is not finite\n");
            abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    static struct dig_signal_map map;
    struct dig_dbc               dbc    = { 0 };
    struct dig_error             error  = { "" };
    enum dig_status              status = dig_dbc_read(as_file(data, size), &dbc, &error);
    expect_word(status, &error);
    if (status == DIG_OK) {
        status = dig_signal_map_read("config/signals/zx200_can.yaml", &dbc, &map, &error);
        expect_word(status, &error);
    }
    for (size_t at = 0; status == DIG_OK && at + 8 <= size; at += 8) {
        struct dig_reading reading;
        if (dig_signal_map_frame(&map, (unsigned)(at / 8 % map.groups), 8, data + at, 1,
                                 &reading) == DIG_OK) {
            check_reading(&reading);
        }
    }
    dig_dbc_finish(&dbc);
    return 0;
}
