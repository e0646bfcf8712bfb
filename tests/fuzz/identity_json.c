// An identity as digloop identify writes it, which is also the daemon's state.

#include "files/identity_json.h"
#include "tests/fuzz/as_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    struct dig_error      error = { "" };
    struct dig_identity   read;
    const enum dig_status status = dig_identity_read(as_file(data, size), &read, &error);
    expect_word(status, &error);
    return 0;
}
