// Stops one thread of a program, and no other, until SIGTERM: hold_thread PID INDEX, INDEX 0 being
// the first thread. Says "held" when it stands. 75 where this system does not let it be traced.

// ptrace() is Linux', not POSIX'.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#define THREADS_MAX 64

enum { EXIT_USAGE = 2, EXIT_NOT_ALLOWED = 75 };

static int by_number(const void *const a, const void *const b)
{
    return *(const int *)a - *(const int *)b;
}

// The INDEX-th thread in the order in which they were started, or 0.
static int thread_of(const char *const pid, const long index)
{
    char path[64];
    int  thread[THREADS_MAX];
    long threads = 0;
    (void)snprintf(path, sizeof path, "/proc/%.20s/task", pid);
    DIR *const folder = opendir(path);
    if (folder == NULL) {
        return 0;
    }
    for (const struct dirent *entry; threads < THREADS_MAX && (entry = readdir(folder)) != NULL;) {
        if (entry->d_name[0] != '.') {
            thread[threads++] = (int)strtol(entry->d_name, NULL, 10);
        }
    }
    (void)closedir(folder);
    qsort(thread, (size_t)threads, sizeof thread[0], by_number);
    return index < threads ? thread[index] : 0;
}

int main(const int argc, char *argv[])
{
    if (argc != 3) {
        (void)fprintf(stderr, "usage: hold_thread PID INDEX\n");
        return EXIT_USAGE;
    }
    const int thread = thread_of(argv[1], strtol(argv[2], NULL, 10));
    int       signal = 0;
    sigset_t  end;
    (void)sigemptyset(&end);
    (void)sigaddset(&end, SIGTERM);
    (void)sigprocmask(SIG_BLOCK, &end, NULL);
    if (thread == 0 || ptrace(PTRACE_SEIZE, thread, NULL, NULL) != 0 ||
        ptrace(PTRACE_INTERRUPT, thread, NULL, NULL) != 0) {
        perror("hold_thread");
        return EXIT_NOT_ALLOWED;
    }
    (void)waitpid(thread, NULL, __WALL);
    (void)puts("held");
    (void)fflush(stdout);
    (void)sigwait(&end, &signal);
    return ptrace(PTRACE_DETACH, thread, NULL, NULL) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
