// A DBC: what a machine's maker says of its CAN frames.

#include "firmware_host/bus/dbc.h"
#include "tests/fuzz/as_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    struct dig_error      error  = { "" };
    struct dig_dbc        read   = { 0 };
    const enum dig_status status = dig_dbc_read(as_file(data, size), &read, &error);
    expect_word(status, &error);
    dig_dbc_finish(&read);
    return 0;
}
