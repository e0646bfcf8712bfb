#include "core/process.h"

#include "core/text.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ; // NOLINT(readability-redundant-declaration): POSIX leaves it undeclared

void dig_process_last_line(FILE *const file, const size_t size, char line[const])
{
    char read[400];
    line[0] = '\0';
    rewind(file);
    while (fgets(read, sizeof read, file) != NULL) {
        read[strcspn(read, "\n")] = '\0';
        if (read[strspn(read, " \t\r")] != '\0') {
            dig_text_clean(read);
            (void)snprintf(line, size, "%s", read);
        }
    }
}

// The environment less what begins with `without`; free() it, not what it points to.
static char **environment(const char *const without)
{
    size_t n = 0;
    while (environ[n] != NULL) {
        n++;
    }
    char **const kept = calloc(n + 1, sizeof *kept);
    for (size_t i = 0, k = 0; kept != NULL && i < n; i++) {
        if (without == NULL || strncmp(environ[i], without, strlen(without)) != 0) {
            kept[k++] = environ[i];
        }
    }
    return kept;
}

static int start(const struct dig_process *const p, FILE *const err, char **const env,
                 pid_t *const child)
{
    char                      *words[DIG_PROCESS_ARGUMENTS_MAX + 1];
    posix_spawn_file_actions_t files;
    size_t                     n = 0;
    while (p->argv[n] != NULL) {
        n++;
    }
    assert(n >= 1 && n <= DIG_PROCESS_ARGUMENTS_MAX);
    // POSIX takes arguments without const and does not write to them.
    memcpy(words, p->argv, (n + 1) * sizeof *words);

    (void)posix_spawn_file_actions_init(&files);
    if (p->in != NULL) {
        (void)posix_spawn_file_actions_adddup2(&files, fileno(p->in), STDIN_FILENO);
    } else {
        (void)posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    (void)posix_spawn_file_actions_adddup2(&files, fileno(p->out), STDOUT_FILENO);
    (void)posix_spawn_file_actions_adddup2(&files, fileno(err), STDERR_FILENO);
    const int failed = posix_spawnp(child, words[0], &files, NULL, words, env);
    (void)posix_spawn_file_actions_destroy(&files);
    return failed;
}

enum dig_status dig_process_run(const struct dig_process *const process,
                                struct dig_error *const         error)
{
    assert(process != NULL && process->argv[0] != NULL && process->out != NULL);
    const char *const name = process->argv[0];
    char              words[400];
    pid_t             child = -1;
    FILE *const       err   = tmpfile();
    char **const      env   = environment(process->without);
    enum dig_status   status;
    if (err == NULL || env == NULL) {
        status = dig_error_set(error, DIG_EIO, "%s: %s", name, strerror(errno));
        goto done;
    }
    const int failed = start(process, err, env, &child);
    if (failed != 0) {
        status =
            dig_error_set(error, DIG_EINVAL, "%s: %s, expected on PATH", name, strerror(failed));
        goto done;
    }
    int how = -1;
    while (waitpid(child, &how, 0) < 0 && errno == EINTR) {
    }
    status = DIG_OK;
    if (!WIFEXITED(how) || WEXITSTATUS(how) != 0) {
        dig_process_last_line(err, sizeof words, words);
        status = dig_error_set(error, DIG_EIO, "%s: %s", name, words[0] != '\0' ? words : "failed");
    }
done:
    free(env);
    if (err != NULL) {
        (void)fclose(err);
    }
    return status;
}
