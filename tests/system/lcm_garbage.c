// Says on the daemon's channels what a daemon does not: lcm_garbage URL [TIMES]. Random bytes of
// any length, and a HEALTH whose texts are escape sequences.

#include "messages/digsight_health_t.h"
#include "tests/fuzz/random.h"

#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static void say_health(lcm_t *const lcm)
{
    char                    hostile[] = "\033[2J\033[?1049l\r\n\007\x9b"
                                        "31mOWNED\xe2\x80\xae\xff";
    char                    empty[]   = "";
    const digsight_health_t h         = { .time_ns         = 1000000000,
                                          .state           = hostile,
                                          .input           = hostile,
                                          .note            = hostile,
                                          .missing_signals = hostile,
                                          .table           = empty,
                                          .advice          = empty };
    (void)digsight_health_t_publish(lcm, "DIGSIGHT_HEALTH", &h);
}

int main(const int argc, char *argv[])
{
    static const char *const channel[] = { "DIGSIGHT_ESTIMATE", "DIGSIGHT_MATCH",
                                           "DIGSIGHT_PREDICTION", "DIGSIGHT_HEALTH",
                                           "DIGSIGHT_\033[2J" };
    lcm_t *const             lcm       = argc > 1 ? lcm_create(argv[1]) : NULL;
    if (lcm == NULL) {
        (void)fprintf(stderr, "usage: lcm_garbage URL [TIMES]\n");
        return 2;
    }
    const long times = argc > 2 ? strtol(argv[2], NULL, 10) : 1000;
    for (long n = 0; n < times; n++) {
        uint8_t      bytes[2000];
        const size_t size = below(sizeof bytes);
        for (size_t i = 0; i < size; i++) {
            bytes[i] = (uint8_t)next();
        }
        (void)lcm_publish(lcm, channel[n % 5], bytes, (unsigned)size);
    }
    // The flood may have filled the reader's buffer: what is lost once is said again.
    for (int again = 0; again < 20; again++) {
        const struct timespec pause = { .tv_nsec = 50000000 };
        say_health(lcm);
        (void)nanosleep(&pause, NULL);
    }
    lcm_destroy(lcm);
    return 0;
}
