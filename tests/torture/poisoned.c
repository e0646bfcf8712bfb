// How many samples a daemon published, and how many of them hold a value that no right sender sent:
//   poisoned LOG.lcm
// A poisoned pressure is 4660 kPa in all cylinders at once (0x1234 on Modbus, and the CAN flood's
// second sender's). Prints SAMPLES POISONED.

#include "files/lcm/lcm_log.h"

#include <math.h>
#include <stdio.h>

#define POISON_Pa 4660e3
#define NEAR_Pa   25e3 // CAN's step

static bool is_poison(const struct dig_sample *const sample, const enum dig_signal signal)
{
    return sample->valid[signal] && fabs(sample->value[signal] - POISON_Pa) <= NEAR_Pa;
}

int main(const int argc, char *argv[])
{
    struct dig_error             error   = { "" };
    struct dig_machine_recording samples = { 0 };
    if (argc != 2) {
        (void)fprintf(stderr, "usage: poisoned LOG.lcm\n");
        return 2;
    }
    if (dig_lcm_log_read(argv[1], &samples, &error) != DIG_OK) {
        (void)fprintf(stderr, "poisoned: %s\n", error.text);
        return 1;
    }
    size_t poisoned = 0;
    for (size_t i = 0; i < samples.rows; i++) {
        poisoned += is_poison(&samples.row[i], DIG_SIGNAL_BOOM_HEAD_Pa) &&
                            is_poison(&samples.row[i], DIG_SIGNAL_ARM_ROD_Pa) &&
                            is_poison(&samples.row[i], DIG_SIGNAL_BUCKET_ROD_Pa)
                        ? 1
                        : 0;
    }
    (void)printf("%zu %zu\n", samples.rows, poisoned);
    dig_machine_recording_finish(&samples);
    return 0;
}
