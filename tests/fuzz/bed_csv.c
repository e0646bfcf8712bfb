// A bed, and curves of another code: both readers get every input.

#include "files/bed_csv.h"
#include "files/curves_csv.h"
#include "tests/fuzz/as_file.h"

static enum dig_status visit(void *const context, const struct dig_foreign_dig *const dig,
                             struct dig_error *const error)
{
    (void)context, (void)dig, (void)error;
    return DIG_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    static struct dig_curve_map map;
    if (map.scene[0] == '\0' &&
        dig_curve_map_read("tests/data/formats/curve_map.yaml", &map, NULL) != DIG_OK) {
        exit(2);
    }
    const char *const     path   = as_file(data, size);
    struct dig_error      error  = { "" };
    struct dig_bed        bed    = { 0 };
    const enum dig_status as_bed = dig_bed_read(path, &bed, &error);
    expect_word(as_bed, &error);
    dig_bed_finish(&bed);

    const struct dig_foreign_visitor visitor      = { .visit = visit };
    struct dig_error                 curves_error = { "" };
    expect_word(dig_curves_read(path, &map, &visitor, &curves_error), &curves_error);
    return 0;
}
