// A model as digloop trace --add writes it and the daemon loads it.

#include "files/model_json.h"
#include "tests/fuzz/as_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    struct dig_error      error  = { "" };
    struct dig_model      read   = { 0 };
    const enum dig_status status = dig_model_read(as_file(data, size), &read, &error);
    expect_word(status, &error);
    return 0;
}
