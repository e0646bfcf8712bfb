// An LCM log: its samples as a recording, and its other messages one by one.

#include "files/lcm/lcm_log.h"
#include "tests/fuzz/as_file.h"

#define IGNORE(type)                                                                               \
    static void ignore_##type(void *context, int64_t time_us, const digsight_##type##_t *message)  \
    {                                                                                              \
        (void)context, (void)time_us, (void)message;                                               \
    }
IGNORE(estimate)
IGNORE(match)
IGNORE(prediction)
IGNORE(health)

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    const struct dig_lcm_reader  all       = { .estimate   = ignore_estimate,
                                               .match      = ignore_match,
                                               .prediction = ignore_prediction,
                                               .health     = ignore_health };
    const char *const            path      = as_file(data, size);
    struct dig_error             error     = { "" };
    struct dig_machine_recording recording = { 0 };
    const enum dig_status        status    = dig_lcm_log_read(path, &recording, &error);
    expect_word(status, &error);
    dig_machine_recording_finish(&recording);

    struct dig_error each_error = { "" };
    expect_word(dig_lcm_log_each(path, &all, &each_error), &each_error);
    return 0;
}
