// CPU affinity is a GNU extension.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "firmware_host/threads/rt.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#define STACK_BYTES (64 * 1024)

// Locks later mappings too only without a limit: beyond one the mapping itself fails, and a thread
// or LCM with it.
static bool lock_memory(void)
{
    struct rlimit limit;
    const bool    unlimited =
        getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    const bool all = unlimited || geteuid() == 0;
    return mlockall(all ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0;
}

// Touches the stack's pages, which stay locked with mlockall(), or at least mapped.
static void prefault_stack(void)
{
    volatile char stack[STACK_BYTES];
    for (size_t i = 0; i < sizeof stack; i += 1024) {
        stack[i] = 1;
    }
    (void)stack[0];
}

struct dig_rt_grant dig_rt_enter(const struct dig_rt_settings *const settings)
{
    assert(settings != NULL);
    struct dig_rt_grant grant = { 0 };
    if (settings->lock_memory) {
        grant.memory_locked = lock_memory();
    }
    if (settings->cpu >= 0 && settings->cpu < CPU_SETSIZE) {
        cpu_set_t cpus;
        CPU_ZERO(&cpus);
        CPU_SET((size_t)settings->cpu, &cpus);
        grant.pinned = pthread_setaffinity_np(pthread_self(), sizeof cpus, &cpus) == 0;
    }
    if (settings->priority > 0) {
        const struct sched_param priority = { .sched_priority = settings->priority };
        grant.realtime = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
    }
    prefault_stack();
    return grant;
}

void dig_rt_describe(const struct dig_rt_settings *const settings,
                     const struct dig_rt_grant *const grant, const size_t size, char text[])
{
    assert(settings != NULL && grant != NULL && text != NULL);
    char priority[48];
    char cpu[48];
    (void)snprintf(priority, sizeof priority, "SCHED_FIFO %d %s", settings->priority,
                   grant->realtime ? "granted" : "refused");
    (void)snprintf(cpu, sizeof cpu, "CPU %d %s", settings->cpu,
                   grant->pinned ? "granted" : "refused");
    (void)snprintf(text, size, "%s, %s, %s",
                   settings->priority > 0 ? priority : "SCHED_OTHER as configured",
                   grant->memory_locked    ? "memory locked"
                   : settings->lock_memory ? "locking memory refused"
                                           : "memory not locked as configured",
                   settings->cpu >= 0 ? cpu : "any CPU");
}
