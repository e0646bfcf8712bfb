// What a program does with the clock, for tests/system/simclock.sh; each prints the clock's seconds
// when it is done:
//   clock_user sleep SECONDS
//   clock_user compute CPU_SECONDS      and then sleeps a millisecond
//   clock_user poll PIPE SECONDS        with "ready" before it when something can be read, else
//   "silent" clock_user write PIPE SECONDS       sleeps first clock_user signal SECONDS with "USR1"
//   before it when that came, else "none"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double now_s(const clockid_t clock)
{
    struct timespec t;
    (void)clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static struct timespec in_timespec(const double s)
{
    return (struct timespec){ .tv_sec  = (time_t)s,
                              .tv_nsec = (long)(1e9 * (s - (double)(time_t)s)) };
}

int main(const int argc, char *argv[])
{
    const char *const     what = argc > 2 ? argv[1] : "";
    const double          s    = argc > 2 ? strtod(argv[argc - 1], NULL) : 0.0;
    const struct timespec wait = in_timespec(s);
    const char           *word = "";
    if (strcmp(what, "sleep") == 0) {
        (void)nanosleep(&wait, NULL);
    } else if (strcmp(what, "compute") == 0) {
        const double end_s = now_s(CLOCK_PROCESS_CPUTIME_ID) + s;
        while (now_s(CLOCK_PROCESS_CPUTIME_ID) < end_s) {
        }
        const struct timespec moment = in_timespec(1e-3);
        (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &moment, NULL);
    } else if (strcmp(what, "poll") == 0 && argc == 4) {
        struct pollfd pipe = { .fd = open(argv[2], O_RDWR), .events = POLLIN };
        word               = poll(&pipe, 1, (int)(1e3 * s)) > 0 ? "ready " : "silent ";
    } else if (strcmp(what, "write") == 0 && argc == 4) {
        const int pipe = open(argv[2], O_RDWR);
        (void)nanosleep(&wait, NULL);
        word = write(pipe, "x", 1) == 1 ? "wrote " : "failed ";
        (void)poll(NULL, 0, 1000); // a pipe that all have left forgets what is in it
    } else if (strcmp(what, "signal") == 0) {
        sigset_t set;
        (void)sigemptyset(&set);
        (void)sigaddset(&set, SIGUSR1);
        (void)sigprocmask(SIG_BLOCK, &set, NULL);
        word = sigtimedwait(&set, NULL, &wait) == SIGUSR1 ? "USR1 " : "none ";
    } else {
        return 2;
    }
    (void)printf("%s%.3f\n", word, now_s(CLOCK_MONOTONIC) - 1000.0);
    return 0;
}
