// Tests for firmware_host/tick/loop.c: once it runs, the tick takes no memory and gives none back,
// takes no lock, says no word, and makes no system call but to sleep and to read the clock. What
// our code calls of the C library is counted by standing in its place (the Makefile has the linker
// wrap it); system calls of the thread are trapped by the kernel, so that what libraries do inside
// is seen, too.

// The trap's registers are Linux', not POSIX'.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "tests/firmware_host/loop_bench.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

struct calls {
    unsigned long takes, gives, locks, words;
};
static _Thread_local struct calls calls;

// The linker's names: __real_ is the library's function, __wrap_ is called in its place.
// NOLINTBEGIN(bugprone-reserved-identifier)
#define COUNTED(counter, result, name, parameters, arguments)                                      \
    result __real_##name parameters;                                                               \
    result __wrap_##name parameters;                                                               \
    result __wrap_##name parameters                                                                \
    {                                                                                              \
        calls.counter++;                                                                           \
        return __real_##name arguments;                                                            \
    }

COUNTED(takes, void *, malloc, (size_t size), (size))
COUNTED(takes, void *, calloc, (size_t count, size_t size), (count, size))
COUNTED(takes, void *, realloc, (void *old, size_t size), (old, size))
COUNTED(takes, void *, aligned_alloc, (size_t alignment, size_t size), (alignment, size))
COUNTED(takes, int, posix_memalign, (void **memory, size_t alignment, size_t size),
        (memory, alignment, size))
COUNTED(locks, int, pthread_mutex_lock, (pthread_mutex_t * mutex), (mutex))
COUNTED(locks, int, pthread_mutex_trylock, (pthread_mutex_t * mutex), (mutex))
COUNTED(locks, int, pthread_cond_wait, (pthread_cond_t * cond, pthread_mutex_t *mutex),
        (cond, mutex))
COUNTED(locks, int, pthread_rwlock_rdlock, (pthread_rwlock_t * lock), (lock))
COUNTED(locks, int, pthread_rwlock_wrlock, (pthread_rwlock_t * lock), (lock))
COUNTED(locks, int, sem_wait, (sem_t * semaphore), (semaphore))
COUNTED(locks, int, sem_post, (sem_t * semaphore), (semaphore))
COUNTED(words, int, vfprintf, (FILE * file, const char *format, va_list arguments),
        (file, format, arguments))
COUNTED(words, int, puts, (const char *text), (text))
COUNTED(words, int, fputs, (const char *text, FILE *file), (text, file))
COUNTED(words, int, fputc, (int character, FILE *file), (character, file))
COUNTED(words, size_t, fwrite, (const void *data, size_t size, size_t count, FILE *file),
        (data, size, count, file))
COUNTED(words, ssize_t, write, (int fd, const void *data, size_t size), (fd, data, size))

void __real_free(void *memory);
void __wrap_free(void *memory);
void __wrap_free(void *memory)
{
    calls.gives++;
    __real_free(memory);
}

__attribute__((format(printf, 1, 2))) int __wrap_printf(const char *format, ...);
int                                       __wrap_printf(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = __wrap_vfprintf(stdout, format, arguments);
    va_end(arguments);
    return length;
}

__attribute__((format(printf, 2, 3))) int __wrap_fprintf(FILE *file, const char *format, ...);
int                                       __wrap_fprintf(FILE *file, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = __wrap_vfprintf(file, format, arguments);
    va_end(arguments);
    return length;
}
// NOLINTEND(bugprone-reserved-identifier)

// System calls that were trapped, and the last one's number.
static atomic_ulong trapped;
static atomic_int   trapped_number;

static void count_trap(const int signal, siginfo_t *const info, void *const context)
{
    (void)signal;
    (void)context;
    atomic_fetch_add(&trapped, 1);
    atomic_store(&trapped_number, info->si_syscall);
}

#define ALLOW(name)                                                                                \
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_##name, 0, 1),                                         \
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)

// From now on this thread may sleep, read the clock, and end; anything else is trapped and left
// undone. False: this kernel, or what runs us, does not do so.
static bool forbid_system_calls(void)
{
    // A sanitizer makes its own; valgrind and an emulator stand between.
    const char *const preload = getenv("LD_PRELOAD");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#endif
    struct sock_filter rules[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        ALLOW(clock_nanosleep),
        ALLOW(clock_gettime),
        ALLOW(rt_sigreturn),
        ALLOW(rt_sigprocmask),
        ALLOW(madvise),
        ALLOW(exit),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
    };
    const struct sock_fprog program = { sizeof rules / sizeof rules[0], rules };
    struct sigaction        action  = { .sa_flags = SA_SIGINFO };
    action.sa_sigaction             = count_trap;
    return (preload == NULL || strstr(preload, "vgpreload") == NULL) &&
           sigaction(SIGSYS, &action, NULL) == 0 && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0;
}

struct run {
    struct bench *bench;
    atomic_bool   stop, ready;
    bool          forbids;
    unsigned long trapped_before; // by a call made on purpose
    struct calls  made;           // in the loop
};

static void *run_main(void *const context)
{
    struct run *const run = context;
    run->forbids          = forbid_system_calls();
    if (run->forbids) {
        (void)syscall(SYS_getppid);
        run->trapped_before = atomic_exchange(&trapped, 0);
    }
    atomic_store(&run->ready, true);
    const struct calls before = calls;
    dig_loop_run(&run->bench->loop, &run->stop);
    run->made = (struct calls){ calls.takes - before.takes, calls.gives - before.gives,
                                calls.locks - before.locks, calls.words - before.words };
    return NULL;
}

TEST(each_call_is_counted)
{
    const struct calls before    = calls;
    void *volatile memory        = malloc(1);
    pthread_mutex_t mutex        = PTHREAD_MUTEX_INITIALIZER;
    const char *volatile nothing = "";
    memory                       = realloc(memory, 100);
    free(memory);
    memory = aligned_alloc(64, 64);
    free(memory);
    assert_int_equal(pthread_mutex_lock(&mutex), 0);
    assert_int_equal(pthread_mutex_unlock(&mutex), 0);
    (void)fprintf(stderr, "%s", nothing);
    assert_int_equal(write(STDERR_FILENO, "", 0), 0);
    assert_int_equal(calls.takes - before.takes, 3);
    assert_int_equal(calls.gives - before.gives, 2);
    assert_int_equal(calls.locks - before.locks, 1);
    assert_int_equal(calls.words - before.words, 2);
}

// The daemon's loop as it stands, for a second: digs that begin and end, gravels and tables that
// are offered, memory that comes and goes, a publisher that does not always keep up.
TEST(the_running_loop_takes_no_memory_no_lock_and_says_nothing)
{
    static struct run run;
    run                     = (struct run){ .bench = bench_create() };
    struct bench *const b   = run.bench;
    b->loop.settings.tick_s = 0.001;
    int       digs          = 0;
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, run_main, &run), 0);
    const struct timespec pause = { .tv_nsec = MS };
    while (!atomic_load(&run.ready)) {
        (void)nanosleep(&pause, NULL);
    }
    for (int64_t i = 0; i < 3000; i++) {
        struct dig_reading r = bench_still((1000 + i * 5) * MS);
        r.value[DIG_SIGNAL_BUCKET_HEAD_Pa] += i % 600 > 400 ? 15e6 : 0.0;
        while (!dig_ring_push(&b->wires.handoffs.readings, &r)) {
            (void)nanosleep(&pause, NULL);
        }
        if (i % 100 == 0) {
            bench_set_basis(b, &b->wires.handoffs.basis, 3, atomic_load(&b->loop.generation),
                            INT64_MAX);
        }
        if (i % 700 == 0) {
            bench_set_basis(b, &b->wires.handoffs.table, 5, atomic_load(&b->loop.generation) + 1,
                            INT64_MAX);
        }
        struct dig_recorded_dig *raw = NULL;
        if (dig_ring_pop(&b->wires.handoffs.digs, &raw)) {
            digs++;
            assert_true(dig_ring_push(&b->wires.handoffs.spares, &raw));
        }
        struct dig_record record;
        while (i % 10 == 0 && dig_ring_pop(&b->wires.handoffs.records, &record)) {
        }
        if (i % 3 == 0) {
            (void)nanosleep(&pause, NULL);
        }
    }
    atomic_store(&run.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(run.made.takes, 0);
    assert_int_equal(run.made.gives, 0);
    assert_int_equal(run.made.locks, 0);
    assert_int_equal(run.made.words, 0);
    if (run.forbids) {
        assert_int_equal(run.trapped_before, 1);
        if (atomic_load(&trapped) > 0) {
            fail_msg("system call %d in the loop", atomic_load(&trapped_number));
        }
    }
    for (struct dig_recorded_dig *raw; dig_ring_pop(&b->wires.handoffs.digs, &raw);) {
        digs++;
    }
    assert_true(digs > 1);
    assert_int_equal(digs, b->loop.tick_status.digs - b->loop.tick_status.lost_digs);
    assert_true(b->loop.tick_status.ticks > 50);
    assert_true(b->loop.tick_status.generation > 2);
    bench_destroy(b);
    if (!run.forbids) {
        print_message("SKIP: system calls cannot be trapped here, only the C library is counted\n");
        skip();
    }
}
