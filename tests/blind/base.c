#include "tests/blind/base.h"

#include "files/recording_csv.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#define WORDS_MAX 16 // of a command

static void become(const char *const argv[], const char *const output, const unsigned limit_s)
{
    // execv() takes pointers to what it does not change.
    char  *words[WORDS_MAX];
    size_t n = 0;
    while (argv[n] != NULL && n + 1 < WORDS_MAX) {
        n++;
    }
    memcpy(words, argv, (n + 1) * sizeof *argv);
    const struct rlimit limit = { limit_s, limit_s + 1 };
    (void)setrlimit(RLIMIT_CPU, &limit);
    const int fd = open(output, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (fd >= 0) {
        (void)dup2(fd, STDOUT_FILENO);
        (void)dup2(fd, STDERR_FILENO);
        (void)close(fd);
    }
    (void)execv(words[0], words);
    _exit(127);
}

// BSD's wait4() tells what one child used; POSIX has only the sum, so the difference of two sums is
// taken: the caller has one child at a time.
static struct rusage used(void)
{
    struct rusage u = { .ru_maxrss = 0 };
    (void)getrusage(RUSAGE_CHILDREN, &u);
    return u;
}

static double seconds(const struct rusage *const u)
{
    return (double)u->ru_utime.tv_sec + (double)u->ru_stime.tv_sec +
           1e-6 * ((double)u->ru_utime.tv_usec + (double)u->ru_stime.tv_usec);
}

int blind_spawn(const char *const argv[], const char *const output, const unsigned limit_s,
                double *const cpu_s, double *const peak_B)
{
    const struct rusage before = used();
    const pid_t         child  = fork();
    if (child == 0) {
        become(argv, output, limit_s);
    }
    int status = -1;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const struct rusage after = used();
    if (cpu_s != NULL) {
        *cpu_s = seconds(&after) - seconds(&before);
    }
    if (peak_B != NULL) {
        *peak_B = 1024.0 * (double)after.ru_maxrss; // of the largest child so far
    }
    return child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The true moment by row, from digrig's truth file; rows: how many there must be.
static double *read_truth(const char *const path, const size_t rows)
{
    FILE *const   file = fopen(path, "r");
    double *const My   = calloc(rows, sizeof *My);
    char          line[512];
    size_t        n = 0;
    while (file != NULL && My != NULL && n < rows && fgets(line, sizeof line, file) != NULL) {
        const char *const last = strrchr(line, ',');
        if (last != NULL && (line[0] == '-' || (line[0] >= '0' && line[0] <= '9'))) {
            My[n++] = strtod(last + 1, NULL);
        }
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    if (n != rows) {
        free(My);
        return NULL;
    }
    return My;
}

static double at(const size_t n, const double y[], const double place)
{
    if (!(place > 0.0) || place >= (double)(n - 1)) {
        return 0.0;
    }
    const size_t low = (size_t)place;
    return y[low] + (y[low + 1] - y[low]) * (place - (double)low);
}

// How far the truth is from the dig when the dig begins there.
static double mismatch(const struct blind_base *const base, const double My[],
                       const struct dig_recording *const dig, const double lambda,
                       const double begin_s)
{
    double sum = 0.0;
    for (size_t i = 0; i < dig->rows; i += 4) {
        const double t_s = begin_s + sqrt(lambda) * dig->row[i].t_s;
        const double off =
            at(base->recording.rows, My, t_s / base->step_s) / pow(lambda, 4.0) - dig->row[i].My_Nm;
        sum += off * off;
    }
    return sum;
}

static void place_dig(struct blind_base *const base, const double My[],
                      const struct dig_recording *const dig, const double lambda)
{
    double whole_s = base->step_s * (double)base->recording.rows;
    double best_s  = 0.0;
    double step_s  = 0.05;
    double low_s   = 0.0;
    for (int round = 0; round < 3; round++) {
        double least = (double)INFINITY;
        for (double t_s = low_s; t_s < whole_s; t_s += step_s) {
            const double off = mismatch(base, My, dig, lambda, t_s);
            if (off < least) {
                least  = off;
                best_s = t_s;
            }
        }
        low_s   = best_s - step_s;
        whole_s = best_s + step_s;
        step_s /= 10.0;
    }
    base->begin_s    = best_s;
    base->contact_s  = 0.0;
    base->released_s = 0.0;
    for (size_t i = 0; i < base->recording.rows; i++) {
        if (fabs(My[i]) > 0.0) {
            base->contact_s  = base->contact_s > 0.0 ? base->contact_s : (double)i * base->step_s;
            base->released_s = (double)i * base->step_s;
        }
    }
}

// Makes the two files unless they are there; one process at a time a name.
static enum dig_status run_digrig(const char *const words[], const char *const out,
                                  const char *const truth, const char *const log,
                                  struct dig_error *const error)
{
    char lock[1040];
    (void)snprintf(lock, sizeof lock, "%s.lock", out);
    const int       fd     = open(lock, O_RDWR | O_CREAT, 0644);
    struct flock    whole  = { .l_type = F_WRLCK, .l_whence = SEEK_SET };
    enum dig_status status = DIG_OK;
    while (fd >= 0 && fcntl(fd, F_SETLKW, &whole) < 0 && errno == EINTR) {
    }
    if (access(out, R_OK) != 0 || access(truth, R_OK) != 0) {
        const int ended = blind_spawn(words, log, 60, NULL, NULL);
        if (ended != 0) {
            status = dig_error_set(error, ended == 2 ? DIG_EUNREACHABLE : DIG_EIO,
                                   "%s: digrig ended with %d, see %s", out, ended, log);
        }
    }
    if (fd >= 0) {
        (void)close(fd);
    }
    return status;
}

enum dig_status blind_base_make(const char *const digrig, const char *const machine,
                                const char *const path, const char *const folder,
                                const char *const name, const double lambda,
                                const struct dig_recording *const dig,
                                struct blind_base *const base, struct dig_error *const error)
{
    char out[1024];
    char truth[1024];
    char log[1024];
    (void)snprintf(out, sizeof out, "%s/%s.csv", folder, name);
    (void)snprintf(truth, sizeof truth, "%s/%s_truth.csv", folder, name);
    (void)snprintf(log, sizeof log, "%s/%s.log", folder, name);
    const char *const words[] = { digrig, "record", path,      "--machine", machine, "--exact",
                                  "-o",   out,      "--truth", truth,       NULL };
    enum dig_status   status  = run_digrig(words, out, truth, log, error);
    if (status != DIG_OK) {
        return status;
    }
    struct blind_base b = { .step_s = 0.0 };
    status              = dig_machine_recording_read(out, &b.recording, error);
    if (status != DIG_OK) {
        return status;
    }
    double *const My = read_truth(truth, b.recording.rows);
    if (My == NULL) {
        blind_base_finish(&b);
        return dig_error_set(error, DIG_EIO, "%s: not as long as %s", truth, out);
    }
    b.step_s = 1e-9 * (double)(b.recording.row[1].time_ns - b.recording.row[0].time_ns);
    place_dig(&b, My, dig, lambda);
    free(My);
    *base = b;
    return DIG_OK;
}

void blind_base_finish(struct blind_base *const base)
{
    dig_machine_recording_finish(&base->recording);
}
