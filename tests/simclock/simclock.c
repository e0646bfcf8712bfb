// Moves the simulated clock (simclock.h) of the file that DIG_SIMCLOCK names:
//   simclock begin               makes the file, at the clock's beginning
//   simclock joined PID          waits until that program's clock is the simulated one, or it ended
//   simclock pass SECONDS        lets so much time pass
//   simclock await PID SECONDS   lets time pass until the program has ended; exits 1 if late
//   simclock now                 prints the clock, in seconds since its beginning
//   simclock set SECONDS         sets the calendar's clock forth by so much, or back
// Exits with 2 for bad usage and 3 when a program computes on and on and no time can pass.

#define _GNU_SOURCE
#include "tests/simclock/simclock.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define TASKS_MAX 256
#define NS_PER_S  1000000000LL
#define LOOK_ns   50000L   // of real time, between two looks at who still runs: at first,
#define SELDOM_ns 2000000L // and at last
#define FLIGHT_ns NS_PER_S // of real time: bytes a terminal has not given up by then are lost
#define STUCK_ns  (300LL * NS_PER_S) // of real time, without anybody sleeping

// A thread of a program under test. Its state, and how often it had run when it was last seen
// asleep, tell whether it slept all the while between two looks. Where there is no schedstat,
// `status` tells both.
struct task {
    int  pid, tid, slot, where_fd, stat_fd, runs_fd;
    long runs; // NEVER: not seen asleep yet; BY_CLOCK: it sleeps in its slot
};
enum { NEVER = -1, BY_CLOCK = -2 };

struct watch {
    struct sim *sim;
    const char *path;
    struct task task[TASKS_MAX];
    size_t      tasks;
    uint32_t    threads; // of sim->threads, when the tasks were listed
    bool        listed;
    bool        settled; // all slept when they were last looked at, and `runs` is of then
    bool        one_cpu;
    int         pipe_fd[SIM_SLOTS];
};

static int64_t real_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * NS_PER_S + t.tv_nsec;
}

static void close_task(const struct task *const t)
{
    const int fd[] = { t->where_fd, t->stat_fd, t->runs_fd };
    for (size_t i = 0; i < sizeof fd / sizeof fd[0]; i++) {
        if (fd[i] >= 0) {
            (void)close(fd[i]);
        }
    }
}

static void forget(struct watch *const w)
{
    for (size_t i = 0; i < w->tasks; i++) {
        close_task(&w->task[i]);
    }
    w->tasks   = 0;
    w->listed  = false;
    w->settled = false;
}

static int slot_of(const struct sim *const sim, const int tid)
{
    for (int i = 0; i < SIM_SLOTS; i++) {
        if (atomic_load(&sim->slot[i].state) > SIM_TAKEN && atomic_load(&sim->slot[i].tid) == tid) {
            return i;
        }
    }
    return -1;
}

static int open_of(const int pid, const int tid, const char *const name)
{
    char path[96];
    (void)snprintf(path, sizeof path, "/proc/%d/task/%d/%s", pid, tid, name);
    return open(path, O_RDONLY | O_CLOEXEC);
}

static bool has_ended(const int pid)
{
    char      text[512];
    const int fd = open_of(pid, pid, "stat");
    if (fd < 0) {
        return true;
    }
    const ssize_t n = read(fd, text, sizeof text - 1);
    (void)close(fd);
    text[n > 0 ? n : 0]     = '\0';
    const char *const paren = strrchr(text, ')');
    return paren == NULL || paren[2] == 'Z' || paren[2] == 'X';
}

static void list_program(struct watch *const w, const int pid)
{
    char path[64];
    (void)snprintf(path, sizeof path, "/proc/%d/task", pid);
    DIR *const           folder = opendir(path);
    const struct dirent *entry  = NULL;
    while (folder != NULL && (entry = readdir(folder)) != NULL && w->tasks < TASKS_MAX) {
        const int tid = (int)strtol(entry->d_name, NULL, 10);
        if (tid <= 0) {
            continue;
        }
        struct task t = { .pid = pid, .tid = tid, .slot = slot_of(w->sim, tid), .runs = NEVER };
        t.where_fd    = open_of(pid, tid, "wchan");
        t.runs_fd     = open_of(pid, tid, "schedstat");
        t.stat_fd     = open_of(pid, tid, t.runs_fd >= 0 ? "stat" : "status");
        if (t.stat_fd >= 0) {
            w->task[w->tasks++] = t;
        } else {
            close_task(&t);
        }
    }
    if (folder != NULL) {
        (void)closedir(folder);
    }
}

// The threads of all programs; what has ended is taken off, slots and all.
static void list_tasks(struct watch *const w)
{
    forget(w);
    w->threads = atomic_load(&w->sim->threads);
    for (int i = 0; i < SIM_PROGRAMS; i++) {
        const int pid = atomic_load(&w->sim->program[i]);
        if (pid != 0) {
            list_program(w, pid);
        }
    }
    for (int i = 0; i < SIM_PROGRAMS; i++) {
        const int pid = atomic_load(&w->sim->program[i]);
        char      path[64];
        (void)snprintf(path, sizeof path, "/proc/%d/task", pid);
        if (pid != 0 && access(path, F_OK) != 0) {
            atomic_store(&w->sim->program[i], 0);
        }
    }
    for (int i = 0; i < SIM_SLOTS; i++) {
        struct sim_slot *const slot  = &w->sim->slot[i];
        uint32_t               state = atomic_load(&slot->state);
        const int32_t          pid   = atomic_load(&slot->pid);
        const int32_t          tid   = atomic_load(&slot->tid);
        char                   path[96];
        (void)snprintf(path, sizeof path, "/proc/%d/task/%d", pid, tid);
        if (state > SIM_TAKEN && access(path, F_OK) != 0 && atomic_load(&slot->pid) == pid &&
            atomic_load(&slot->tid) == tid) {
            (void)atomic_compare_exchange_strong(&slot->state, &state, SIM_FREE);
        }
    }
    w->listed = true;
}

// Its text; empty when there is none.
static bool look(const int fd, char text[], const size_t size)
{
    const ssize_t n     = fd >= 0 ? pread(fd, text, size - 1, 0) : 0;
    text[n > 0 ? n : 0] = '\0';
    return n > 0;
}

// Zombies sleep well.
static bool sleeps(const struct task *const t, bool *const gone)
{
    char text[4096];

    // What costs half of the state, where it is enough: who waits there sleeps.
    if (look(t->where_fd, text, sizeof text) &&
        (strncmp(text, "futex_", 6) == 0 || strncmp(text, "poll_", 5) == 0)) {
        return true;
    }
    if (!look(t->stat_fd, text, sizeof text)) {
        *gone = true;
        return false;
    }
    const char *const state = t->runs_fd < 0 ? strstr(text, "State:\t") : strrchr(text, ')');
    return state != NULL && strchr("SZX", state[t->runs_fd < 0 ? 7 : 2]) != NULL;
}

// How often it was given a processor, or gave one back. Less than none: it is gone.
static long runs_of(const struct task *const t)
{
    char text[4096];
    if (t->runs_fd < 0) {
        const char *const by =
            look(t->stat_fd, text, sizeof text) ? strstr(text, "\nvoluntary_ctxt_switches:") : NULL;
        const char *const not = by != NULL ? strstr(by, "nonvoluntary_ctxt_switches:") : NULL;
        return not != NULL
                   ? strtol(strchr(by, ':') + 1, NULL, 10) + strtol(strchr(not, ':') + 1, NULL, 10)
                   : NEVER;
    }
    const char *const last = look(t->runs_fd, text, sizeof text) ? strrchr(text, ' ') : NULL;
    return last != NULL ? strtol(last, NULL, 10) : NEVER;
}

// A sleeper is woken by nobody but us.
static bool sleeps_by_clock(const struct watch *const w, const struct task *const t)
{
    return t->slot >= 0 && atomic_load(&w->sim->slot[t->slot].state) == SIM_SLEEPING;
}

// True when it sleeps and has not run since it was last seen asleep: its state first, or it might
// run behind the count.
static bool sleeps_still(const struct watch *const w, const struct task *const t, bool *const gone)
{
    return t->runs == BY_CLOCK ? sleeps_by_clock(w, t) : sleeps(t, gone) && runs_of(t) == t->runs;
}

// False when it may run. One that was seen asleep and has not run since does not.
static bool seen_asleep(const struct watch *const w, struct task *const t, bool *const gone)
{
    if (t->slot < 0) {
        t->slot = slot_of(w->sim, t->tid);
    }
    const long runs = sleeps_by_clock(w, t) ? BY_CLOCK : runs_of(t);
    if (runs == NEVER || (runs != t->runs && runs != BY_CLOCK && !sleeps(t, gone))) {
        *gone |= runs == NEVER;
        return false;
    }
    t->runs = runs;
    return true;
}

// True when every thread slept, or waited to run, all the while between two looks at all of them,
// and slept at the second: then at one moment all slept, and what sleeps together is woken by the
// clock alone.
static bool all_sleep(struct watch *const w)
{
    bool gone = false;
    for (size_t i = 0; i < w->tasks; i++) {
        struct task *const t = &w->task[i];
        if (!seen_asleep(w, t, &gone)) {
            // Looked at first the next time: it is the likeliest to run still.
            const struct task busy = *t;
            *t                     = w->task[0];
            w->task[0]             = busy;
            w->listed &= !gone;
            return false;
        }
    }
    for (size_t i = 0; i < w->tasks; i++) {
        if (!sleeps_still(w, &w->task[i], &gone)) {
            w->listed &= !gone;
            return false;
        }
    }
    return w->threads == atomic_load(&w->sim->threads);
}

// True when nobody has run since all slept but the one that was woken, which sleeps again: whom it
// had woken in turn would not sleep, or have run.
static bool none_was_woken(struct watch *const w)
{
    bool still = w->settled && w->listed && w->threads == atomic_load(&w->sim->threads);
    bool gone  = false;
    for (size_t i = 0; still && i < w->tasks; i++) {
        still = sleeps_still(w, &w->task[i], &gone);
    }
    return still;
}

// Until that many waits have begun, or a moment of real time has passed.
static void wait_for_turns(struct watch *const w, const uint32_t wanted, const long moment_ns)
{
    const struct timespec wait = { .tv_nsec = moment_ns };
    atomic_store(&w->sim->wanted, wanted);
    const uint32_t turns = atomic_load(&w->sim->turns);
    if ((int32_t)(wanted - turns) > 0) {
        (void)syscall(SYS_futex, &w->sim->turns, FUTEX_WAIT, turns, &wait, NULL, 0);
    }
}

// Until every thread of every program sleeps and no byte is on its way.
static void settle(struct watch *const w, const uint32_t turns, const uint32_t woken)
{
    // That we run at all says that no program does; but a terminal's bytes are carried by others.
    if (w->one_cpu && atomic_load(&w->sim->flying_bytes) == 0) {
        return;
    }
    const int64_t began_ns = real_ns();
    // Those that were woken come back to sleep, most of the time.
    wait_for_turns(w, turns + woken, SELDOM_ns);
    if (woken == 1 && atomic_load(&w->sim->turns) == turns + 1 && none_was_woken(w) &&
        atomic_load(&w->sim->flying_bytes) == 0) {
        return;
    }
    w->settled = false;
    for (long moment_ns = LOOK_ns;; moment_ns = moment_ns < SELDOM_ns ? 2 * moment_ns : SELDOM_ns) {
        if (!w->listed || w->threads != atomic_load(&w->sim->threads)) {
            list_tasks(w);
        }
        const uint32_t looked = atomic_load(&w->sim->turns);
        if (all_sleep(w)) {
            w->settled           = true;
            const int64_t flying = atomic_load(&w->sim->flying_bytes);
            if (flying == 0) {
                return;
            }
            if (real_ns() - began_ns > FLIGHT_ns) {
                atomic_fetch_sub(&w->sim->flying_bytes, flying);
                return;
            }
        }
        if (real_ns() - began_ns > STUCK_ns) {
            (void)fprintf(stderr, "simclock: a program computes on and on\n");
            exit(3);
        }
        wait_for_turns(w, looked + 1, moment_ns);
    }
}

static void wake_poller(struct watch *const w, const int i)
{
    if (w->pipe_fd[i] < 0) {
        char path[512];
        (void)snprintf(path, sizeof path, "%.480s.%d", w->path, i);
        w->pipe_fd[i] = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    }
    (void)!write(w->pipe_fd[i], "", 1);
}

// The wait that ends first, by `end_ns`; of those that end together that of the oldest thread, so
// that they end in the same order however busy the machine is. -1: none.
static int next_wait(const struct sim *const sim, const int64_t end_ns)
{
    int     next     = -1;
    int64_t next_ns  = end_ns;
    int32_t next_tid = 0;
    for (int i = 0; i < SIM_SLOTS; i++) {
        const struct sim_slot *const slot = &sim->slot[i];
        const int64_t                due  = atomic_load(&slot->due_ns);
        const int32_t                tid  = atomic_load(&slot->tid);
        if (atomic_load(&slot->state) >= SIM_SLEEPING &&
            (due < next_ns || (due == next_ns && (next < 0 || tid < next_tid)))) {
            next     = i;
            next_ns  = due;
            next_tid = tid;
        }
    }
    return next;
}

// To the next wait that ends, or to the end of what is to pass. One at a time: two threads that ran
// together would meet in another order each time, and a bus be read before or after it was written.
static void step(struct watch *const w, const int64_t end_ns)
{
    struct sim *const sim   = w->sim;
    const int         next  = next_wait(sim, end_ns);
    const int64_t     to_ns = next >= 0 ? atomic_load(&sim->slot[next].due_ns) : end_ns;
    if (to_ns > atomic_load(&sim->now_ns)) {
        atomic_store(&sim->now_ns, to_ns);
    }
    if (next < 0) {
        return;
    }
    const uint32_t         turns = atomic_load(&sim->turns);
    struct sim_slot *const slot  = &sim->slot[next];
    uint32_t               state = atomic_load(&slot->state);
    if (state >= SIM_SLEEPING &&
        atomic_compare_exchange_strong(&slot->state, &state, SIM_RUNNING)) {
        if (state == SIM_POLLING) {
            wake_poller(w, next);
        } else if (syscall(SYS_futex, &slot->state, FUTEX_WAKE, 1, NULL, NULL, 0) == 0) {
            // Not asleep yet, or no more.
            w->listed &=
                syscall(SYS_tgkill, atomic_load(&slot->pid), atomic_load(&slot->tid), 0) == 0;
            if (w->one_cpu && !w->listed) {
                list_tasks(w);
            }
        }
    }
    settle(w, turns, 1);
}

static int fail(const char *const what, const char *const path)
{
    (void)fprintf(stderr, "simclock: %s %s: %s\n", what, path, strerror(errno));
    return 2;
}

static int begin(const char *const path)
{
    const int fd = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    if (fd < 0 || ftruncate(fd, sizeof(struct sim)) != 0) {
        return fail("cannot make", path);
    }
    struct timespec utc;
    (void)clock_gettime(CLOCK_REALTIME, &utc);
    const int64_t at_ns  = SIM_BEGINS_ns;
    const int64_t utc_ns = (int64_t)utc.tv_sec * NS_PER_S + utc.tv_nsec - at_ns;
    const bool    wrote =
        pwrite(fd, &at_ns, sizeof at_ns, offsetof(struct sim, now_ns)) == (ssize_t)sizeof at_ns &&
        pwrite(fd, &utc_ns, sizeof utc_ns, offsetof(struct sim, utc_ns)) == (ssize_t)sizeof utc_ns;
    (void)close(fd);
    return wrote ? 0 : fail("cannot write", path);
}

static bool has_joined(const struct sim *const sim, const int pid)
{
    for (int i = 0; i < SIM_PROGRAMS; i++) {
        if (atomic_load(&sim->program[i]) == pid) {
            return true;
        }
    }
    return false;
}

static int usage(void)
{
    (void)fprintf(stderr,
                  "usage: DIG_SIMCLOCK=FILE simclock begin|now|joined PID|pass SECONDS|set SECONDS|"
                  "await PID SECONDS\n");
    return 2;
}

int main(const int argc, char *argv[])
{
    static struct watch w;
    const char *const   what = argc > 1 ? argv[1] : "";
    w.path                   = getenv("DIG_SIMCLOCK");
    w.one_cpu                = getenv("DIG_SIMCLOCK_ONE_CPU") != NULL;
    if (w.path == NULL) {
        return usage();
    }
    if (strcmp(what, "begin") == 0) {
        return begin(w.path);
    }
    const int fd = open(w.path, O_RDWR | O_CLOEXEC);
    w.sim =
        fd >= 0 ? mmap(NULL, sizeof *w.sim, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) : MAP_FAILED;
    if (w.sim == MAP_FAILED) {
        return fail("cannot use", w.path);
    }
    for (int i = 0; i < SIM_SLOTS; i++) {
        w.pipe_fd[i] = -1;
    }
    const int     pid    = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 0;
    const int64_t now_ns = atomic_load(&w.sim->now_ns);
    if (strcmp(what, "now") == 0) {
        (void)printf("%.6f\n", 1e-9 * (double)(now_ns - SIM_BEGINS_ns));
        return 0;
    }
    if (strcmp(what, "set") == 0 && argc == 3) {
        w.sim->utc_ns += (int64_t)(1e9 * strtod(argv[2], NULL));
        return 0;
    }
    if (strcmp(what, "joined") == 0 && argc == 3) {
        const int64_t latest_ns = real_ns() + STUCK_ns;
        while (!has_joined(w.sim, pid) && !has_ended(pid)) {
            const struct timespec wait = { .tv_nsec = 1000000 };
            (void)nanosleep(&wait, NULL);
            if (real_ns() > latest_ns) {
                (void)fprintf(stderr, "simclock: program %d runs without preload.so\n", pid);
                return 3;
            }
        }
        return 0;
    }
    const bool awaits = strcmp(what, "await") == 0 && argc == 4;
    if (!awaits && !(strcmp(what, "pass") == 0 && argc == 3)) {
        return usage();
    }
    const int64_t end_ns = now_ns + (int64_t)(1e9 * strtod(argv[argc - 1], NULL));
    settle(&w, 0, 0);
    int64_t steps = 0;
    while ((atomic_load(&w.sim->now_ns) < end_ns || next_wait(w.sim, end_ns) >= 0) &&
           !(awaits && has_ended(pid))) {
        const int64_t later_ns = atomic_load(&w.sim->now_ns) + NS_PER_S / 100;
        step(&w, awaits && later_ns < end_ns ? later_ns : end_ns);
        steps++;
    }
    if (getenv("DIG_SIMCLOCK_STEPS") != NULL) {
        (void)fprintf(stderr, "simclock: %lld steps\n", (long long)steps);
    }
    return awaits && !has_ended(pid) ? 1 : 0;
}
