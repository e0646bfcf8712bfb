// A recording, of forces and of a machine: both readers get every input.

#include "files/recording_csv.h"
#include "tests/fuzz/as_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    const char *const     path     = as_file(data, size);
    struct dig_error      error    = { "" };
    struct dig_recording  force    = { 0 };
    const enum dig_status as_force = dig_recording_read(path, &force, &error);
    expect_word(as_force, &error);
    dig_recording_finish(&force);

    struct dig_error             machine_error = { "" };
    struct dig_machine_recording machine       = { 0 };
    const enum dig_status as_machine = dig_machine_recording_read(path, &machine, &machine_error);
    expect_word(as_machine, &machine_error);
    dig_machine_recording_finish(&machine);
    return 0;
}
