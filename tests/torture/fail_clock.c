// Preloaded, the wall clock jumps: every 0.2 s of monotonic time it takes another of seven offsets.
// The monotonic clock is as it is.

// syscall() is GNU's.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include <stddef.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define JUMP_ns 200000000L

static long offset_s(void)
{
    static const long offset[] = { 3600, -3600, 0, -1700000000, 500000000, 34560000, -157680000 };
    struct timespec   now;
    (void)syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
    const long jumps = now.tv_sec * (1000000000L / JUMP_ns) + now.tv_nsec / JUMP_ns;
    return offset[(unsigned long)jumps % (sizeof offset / sizeof offset[0])];
}

int clock_gettime(clockid_t clock, struct timespec *to)
{
    const int status = (int)syscall(SYS_clock_gettime, clock, to);
    if (status == 0 && clock == CLOCK_REALTIME) {
        to->tv_sec += offset_s();
    }
    return status;
}

int gettimeofday(struct timeval *to, void *zone)
{
    (void)zone;
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    *to = (struct timeval){ .tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000 };
    return 0;
}

time_t time(time_t *to)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    if (to != NULL) {
        *to = now.tv_sec;
    }
    return now.tv_sec;
}
