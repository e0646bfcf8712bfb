// Loaded before libc into a program under test: its monotonic clock is the simulated one
// (simclock.h).

#define _GNU_SOURCE
#include "tests/simclock/simclock.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define NS_PER_S 1000000000LL

static struct sim   *sim;
static bool          terminals;
static pthread_key_t slot_key;
static __thread int  slot_number = -1;
static __thread int  pipe_fd     = -1;
static __thread int  signal_fd   = -1;

static void leave(void *const slot)
{
    atomic_store(&((struct sim_slot *)slot)->state, SIM_FREE);
    if (pipe_fd >= 0) {
        (void)close(pipe_fd);
    }
    if (signal_fd >= 0) {
        (void)close(signal_fd);
    }
}

__attribute__((constructor)) static void join(void)
{
    const char *const path = getenv("DIG_SIMCLOCK");
    const int         fd   = path != NULL ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (fd < 0) {
        return;
    }
    void *const memory = mmap(NULL, sizeof *sim, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    (void)close(fd);
    if (memory == MAP_FAILED) {
        return;
    }
    terminals = getenv("DIG_SIMCLOCK_TERMINALS") != NULL;
    if (getenv("DIG_SIMCLOCK_ONE_CPU") != NULL) {
        const struct sched_param lowest = { .sched_priority = 1 };
        (void)sched_setscheduler(0, SCHED_FIFO, &lowest);
    }
    (void)pthread_key_create(&slot_key, leave);
    sim              = memory;
    const int32_t me = (int32_t)getpid();
    for (int i = 0; i < SIM_SLOTS; i++) { // of the program that was here before an exec
        if (atomic_load(&sim->slot[i].pid) == me) {
            atomic_store(&sim->slot[i].state, SIM_FREE);
        }
    }
    for (int i = 0; i < SIM_PROGRAMS; i++) {
        int32_t none = 0;
        if (atomic_load(&sim->program[i]) == me ||
            atomic_compare_exchange_strong(&sim->program[i], &none, me)) {
            break;
        }
    }
    atomic_fetch_add(&sim->threads, 1);
}

static struct sim_slot *own_slot(void)
{
    for (int i = 0; slot_number < 0 && i < SIM_SLOTS; i++) {
        uint32_t free = SIM_FREE;
        if (atomic_compare_exchange_strong(&sim->slot[i].state, &free, SIM_TAKEN)) {
            atomic_store(&sim->slot[i].pid, (int32_t)getpid());
            atomic_store(&sim->slot[i].tid, (int32_t)syscall(SYS_gettid));
            atomic_store(&sim->slot[i].state, SIM_RUNNING);
            slot_number = i;
            (void)pthread_setspecific(slot_key, &sim->slot[i]);
        }
    }
    if (slot_number < 0) {
        static const char text[] = "simclock: more threads than slots\n";
        (void)!write(STDERR_FILENO, text, sizeof text - 1);
        abort();
    }
    return &sim->slot[slot_number];
}

static void tell_turn(void)
{
    if (atomic_fetch_add(&sim->turns, 1) + 1 == atomic_load(&sim->wanted)) {
        (void)syscall(SYS_futex, &sim->turns, FUTEX_WAKE, 1, NULL, NULL, 0);
    }
}

static int64_t now_ns(void)
{
    return atomic_load(&sim->now_ns);
}

static int64_t in_ns(const struct timespec *const t)
{
    return (int64_t)t->tv_sec * NS_PER_S + t->tv_nsec;
}

static void sleep_until(const int64_t due_ns)
{
    if (due_ns <= now_ns()) {
        return;
    }
    struct sim_slot *const slot = own_slot();
    atomic_store(&slot->due_ns, due_ns);
    atomic_store(&slot->state, SIM_SLEEPING);
    tell_turn();
    while (atomic_load(&slot->state) == SIM_SLEEPING) {
        (void)syscall(SYS_futex, &slot->state, FUTEX_WAIT, SIM_SLEEPING, NULL, NULL, 0);
    }
}

static int open_pipe(void)
{
    if (pipe_fd < 0) {
        char path[512];
        (void)snprintf(path, sizeof path, "%.480s.%d", getenv("DIG_SIMCLOCK"), slot_number);
        (void)mkfifo(path, 0600);
        pipe_fd = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    }
    return pipe_fd;
}

static void empty_pipe(void)
{
    char bytes[16];
    while (read(pipe_fd, bytes, sizeof bytes) > 0) {
    }
}

static int real_poll(struct pollfd fds[], const nfds_t count, const int timeout_ms)
{
    const struct timespec wait = { .tv_sec  = timeout_ms / 1000,
                                   .tv_nsec = timeout_ms % 1000 * 1000000L };
    return (int)syscall(SYS_ppoll, fds, count, timeout_ms < 0 ? NULL : &wait, NULL, 0);
}

static int poll_until(struct pollfd fds[], const nfds_t count, const int64_t due_ns)
{
    struct sim_slot *const slot      = own_slot();
    struct pollfd          all[1025] = { { 0 } };
    if (count > 1024 || open_pipe() < 0) {
        errno = EINVAL;
        return -1;
    }
    if (count > 0) {
        memcpy(all, fds, count * sizeof *fds);
    }
    all[count] = (struct pollfd){ .fd = pipe_fd, .events = POLLIN };
    int ready  = 0;
    for (;;) {
        atomic_store(&slot->due_ns, due_ns);
        atomic_store(&slot->state, SIM_POLLING);
        tell_turn();
        ready = real_poll(all, count + 1, -1);
        atomic_store(&slot->state, SIM_RUNNING);
        if (ready > 0 && all[count].revents != 0) {
            empty_pipe();
            ready--;
        }
        // A wake-up that was meant for the wait before ends none.
        if (ready != 0 || now_ns() >= due_ns) {
            break;
        }
    }
    if (count > 0) {
        memcpy(fds, all, count * sizeof *fds);
    }
    return ready;
}

int clock_gettime(const clockid_t clock, struct timespec *const t)
{
    if (sim == NULL || clock == CLOCK_PROCESS_CPUTIME_ID) {
        return (int)syscall(SYS_clock_gettime, clock, t);
    }
    const int64_t ns = now_ns() + (clock == CLOCK_REALTIME ? sim->utc_ns : 0);
    *t = (struct timespec){ .tv_sec = (time_t)(ns / NS_PER_S), .tv_nsec = (long)(ns % NS_PER_S) };
    return 0;
}

int clock_nanosleep(const clockid_t clock, const int flags, const struct timespec *const wait,
                    struct timespec *const left)
{
    if (sim == NULL || clock != CLOCK_MONOTONIC) {
        return syscall(SYS_clock_nanosleep, clock, flags, wait, left) == 0 ? 0 : errno;
    }
    sleep_until(in_ns(wait) + (flags == TIMER_ABSTIME ? 0 : now_ns()));
    return 0;
}

int nanosleep(const struct timespec *const wait, struct timespec *const left)
{
    if (sim == NULL) {
        return (int)syscall(SYS_nanosleep, wait, left);
    }
    sleep_until(now_ns() + in_ns(wait));
    return 0;
}

int usleep(const useconds_t wait_us)
{
    const struct timespec wait = { .tv_sec  = wait_us / 1000000,
                                   .tv_nsec = wait_us % 1000000 * 1000L };
    return nanosleep(&wait, NULL);
}

int poll(struct pollfd *const fds, const nfds_t count, const int timeout_ms)
{
    return sim == NULL || timeout_ms <= 0
               ? real_poll(fds, count, timeout_ms)
               : poll_until(fds, count, now_ns() + timeout_ms * 1000000LL);
}

int select(const int count, fd_set *const reads, fd_set *const writes, fd_set *const errors,
           struct timeval *const timeout)
{
    const int64_t wait_ns =
        timeout != NULL ? (int64_t)timeout->tv_sec * NS_PER_S + timeout->tv_usec * 1000LL : 0;
    if (sim == NULL || wait_ns <= 0 || errors != NULL) {
        struct timespec wait = { .tv_sec  = timeout != NULL ? timeout->tv_sec : 0,
                                 .tv_nsec = timeout != NULL ? timeout->tv_usec * 1000 : 0 };
        return (int)syscall(SYS_pselect6, count, reads, writes, errors,
                            timeout != NULL ? &wait : NULL, NULL);
    }
    struct pollfd fds[FD_SETSIZE];
    nfds_t        n = 0;
    for (int fd = 0; fd < count; fd++) {
        const bool in  = reads != NULL && FD_ISSET(fd, reads);
        const bool out = writes != NULL && FD_ISSET(fd, writes);
        if (in || out) {
            fds[n++] =
                (struct pollfd){ .fd     = fd,
                                 .events = (short)((in ? POLLIN : 0) | (out ? POLLOUT : 0)) };
        }
    }
    if (poll_until(fds, n, now_ns() + wait_ns) < 0) {
        return -1;
    }
    if (reads != NULL) {
        FD_ZERO(reads);
    }
    if (writes != NULL) {
        FD_ZERO(writes);
    }
    int ready = 0;
    for (nfds_t i = 0; i < n; i++) {
        if (fds[i].events & POLLIN && fds[i].revents & (POLLIN | POLLHUP | POLLERR)) {
            FD_SET(fds[i].fd, reads);
            ready++;
        }
        if (fds[i].events & POLLOUT && fds[i].revents & (POLLOUT | POLLERR)) {
            FD_SET(fds[i].fd, writes);
            ready++;
        }
    }
    return ready;
}

int sigtimedwait(const sigset_t *const set, siginfo_t *const info,
                 const struct timespec *const timeout)
{
    if (sim == NULL || timeout == NULL || in_ns(timeout) <= 0) {
        return (int)syscall(SYS_rt_sigtimedwait, set, info, timeout, (size_t)8);
    }
    signal_fd                    = signalfd(signal_fd, set, SFD_NONBLOCK | SFD_CLOEXEC);
    struct pollfd           wait = { .fd = signal_fd, .events = POLLIN };
    struct signalfd_siginfo got;
    if (poll_until(&wait, 1, now_ns() + in_ns(timeout)) <= 0 ||
        read(signal_fd, &got, sizeof got) != (ssize_t)sizeof got) {
        errno = EAGAIN;
        return -1;
    }
    if (info != NULL) {
        memset(info, 0, sizeof *info);
        info->si_signo = (int)got.ssi_signo;
    }
    return (int)got.ssi_signo;
}

// The kernel would stamp what it receives in its own time, which goes on while the simulated one
// stands still. Without stamps a receiver takes the time at which it reads.
int setsockopt(const int fd, const int level, const int name, const void *const value,
               const socklen_t size)
{
    if (sim != NULL && level == SOL_SOCKET && name == SO_TIMESTAMPNS) {
        errno = ENOPROTOOPT;
        return -1;
    }
    return (int)syscall(SYS_setsockopt, fd, level, name, value, size);
}

// A thread that begins is looked for before the clock moves on.
int pthread_create(pthread_t *const thread, const pthread_attr_t *const attributes,
                   void *(*const run)(void *), void *const              argument)
{
    static int (*create)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (create == NULL) {
        *(void **)&create = dlsym(RTLD_NEXT, "pthread_create");
    }
    const int status = create(thread, attributes, run, argument);
    if (sim != NULL) {
        atomic_fetch_add(&sim->threads, 1);
    }
    return status;
}

// Bytes on terminals, which a kernel thread carries: written and not yet read. What a reader throws
// away is no longer on the way either.
ssize_t write(const int fd, const void *const bytes, const size_t size)
{
    const bool counts = sim != NULL && terminals && isatty(fd);
    if (counts) {
        atomic_fetch_add(&sim->flying_bytes, (int64_t)size);
    }
    const ssize_t wrote = syscall(SYS_write, fd, bytes, size);
    if (counts) {
        atomic_fetch_add(&sim->flying_bytes, (wrote > 0 ? wrote : 0) - (int64_t)size);
    }
    return wrote;
}

ssize_t read(const int fd, void *const bytes, const size_t size)
{
    const ssize_t got = syscall(SYS_read, fd, bytes, size);
    if (got > 0 && sim != NULL && terminals && isatty(fd)) {
        atomic_fetch_sub(&sim->flying_bytes, got);
    }
    return got;
}

int tcflush(const int fd, const int which)
{
    int waiting = 0;
    if (sim != NULL && terminals && which != TCOFLUSH && ioctl(fd, FIONREAD, &waiting) == 0) {
        atomic_fetch_sub(&sim->flying_bytes, waiting);
    }
    return ioctl(fd, TCFLSH, which);
}
