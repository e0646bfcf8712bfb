// A table with some bytes changed: the input is a list of patches of a good one, each three bytes
// of offset, one of length and the bytes.

#include "tables/load.h"
#include "tests/fuzz/coverage/as_file.h"

#include <string.h>

#define GOOD      "tests/data/formats/table.sqlite"
#define BYTES_MAX (1 << 18)
#define HEAD      4

static uint8_t good[BYTES_MAX];
static size_t  good_size;

static void load_good(void)
{
    FILE *const file = fopen(GOOD, "rb");
    good_size        = file != NULL ? fread(good, 1, sizeof good, file) : 0;
    if (file == NULL || fclose(file) != 0 || good_size == 0) {
        (void)fprintf(stderr, "%s: missing\n", GOOD);
        exit(2);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (good_size == 0) {
        load_good();
    }
    static uint8_t patched[BYTES_MAX];
    memcpy(patched, good, good_size);
    while (size > HEAD) {
        const size_t at    = (data[0] | (size_t)data[1] << 8 | (size_t)data[2] << 16) % good_size;
        size_t       bytes = data[3];
        bytes              = bytes < size - HEAD ? bytes : size - HEAD;
        bytes              = bytes < good_size - at ? bytes : good_size - at;
        memcpy(patched + at, data + HEAD, bytes);
        data += HEAD + bytes;
        size -= HEAD + bytes;
    }
    struct dig_error      error  = { "" };
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_load(as_file(patched, good_size), &set, &error);
    expect_word(status, &error);
    dig_curve_set_destroy(set);
    return 0;
}
