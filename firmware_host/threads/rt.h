// Scheduling, memory and CPU of the real-time thread: requested and granted.

#ifndef DIG_FIRMWARE_HOST_THREADS_RT_H
#define DIG_FIRMWARE_HOST_THREADS_RT_H

#include <stdbool.h>
#include <stddef.h>

struct dig_rt_settings {
    int  priority;    // SCHED_FIFO 1 … 99; 0: not asked for
    bool lock_memory; // mlockall
    int  cpu;         // to run on alone; -1: any
};

/// A refusal is no failure: the daemon logs it and runs on.
struct dig_rt_grant {
    bool realtime, memory_locked, pinned;
};

/// For the calling thread (priority, cpu) and the process (memory). Touches 64 KiB of stack, so
/// that no page of it is fetched in a tick.
struct dig_rt_grant dig_rt_enter(const struct dig_rt_settings *settings);

/// One line for people: "SCHED_FIFO 80 granted, memory locked, any CPU".
void dig_rt_describe(const struct dig_rt_settings *settings, const struct dig_rt_grant *grant,
                     size_t size, char text[]);

#endif // DIG_FIRMWARE_HOST_THREADS_RT_H
