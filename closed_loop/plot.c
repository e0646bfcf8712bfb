#include "closed_loop/plot.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ; // NOLINT(readability-redundant-declaration): POSIX leaves it undeclared

// Labels are ours, but a file name may hold a quote.
static void put_quoted(FILE *const to, const char *const text)
{
    (void)fputc('"', to);
    for (const char *c = text; *c != '\0'; c++) {
        (void)fputc(*c == '"' || *c == '\\' ? '\'' : *c, to);
    }
    (void)fputc('"', to);
}

static void put_data(FILE *const to, const size_t index, const struct dig_plot_series *const s)
{
    (void)fprintf(to, "$s%zu << EOD\n", index);
    for (size_t i = 0; i < s->n; i++) {
        const double high = s->style == DIG_PLOT_BAND ? s->high[i] : 0.0;
        if (isfinite(s->x[i]) && isfinite(s->y[i]) && isfinite(high)) {
            (void)fprintf(to, "%.6g %.6g %.6g\n", s->x[i], s->y[i], high);
        } else {
            (void)fprintf(to, "\n");
        }
    }
    (void)fprintf(to, "EOD\n");
}

static void put_series(FILE *const to, const size_t index, const struct dig_plot_series *const s)
{
    static const char *const how[] = {
        [DIG_PLOT_LINE]   = "using 1:2 with lines lw 2",
        [DIG_PLOT_DASHED] = "using 1:2 with lines lw 2 dt (8,5)",
        [DIG_PLOT_POINTS] = "using 1:2 with points pt 7 ps 0.6",
        [DIG_PLOT_BAND]   = "using 1:2:3 with filledcurves fs transparent solid 0.25 noborder",
    };
    (void)fprintf(to, "%s $s%zu %s lc rgb ", index == 0 ? "plot" : ",", index, how[s->style]);
    put_quoted(to, s->colour);
    if (s->title != NULL) {
        (void)fprintf(to, " title ");
        put_quoted(to, s->title);
    } else {
        (void)fprintf(to, " notitle");
    }
}

static void put_script(FILE *const to, const struct dig_plot *const plot)
{
    (void)fprintf(to,
                  "set terminal svg size %u,%u dynamic noenhanced font 'sans-serif,14' background "
                  "'#ffffff'\n",
                  plot->width == 0 ? 900 : plot->width, plot->height == 0 ? 420 : plot->height);
    (void)fprintf(to, "set key outside bottom center horizontal samplen 2\nset bmargin 6\nset grid "
                      "lc rgb '#dddddd'\n"
                      "set border 3 lc rgb '#666666'\nset tics nomirror\nset title ");
    put_quoted(to, plot->title);
    (void)fprintf(to, "\nset xlabel ");
    put_quoted(to, plot->x_label);
    (void)fprintf(to, "\nset ylabel ");
    put_quoted(to, plot->y_label);
    (void)fprintf(to, "\n");
    for (size_t i = 0; i < plot->series; i++) {
        put_data(to, i, &plot->s[i]);
    }
    for (size_t i = 0; i < plot->series; i++) {
        put_series(to, i, &plot->s[i]);
    }
    (void)fprintf(to, "\n");
}

// Runs gnuplot on the script at the descriptor's file, its standard output going to svg.
static enum dig_status run_gnuplot(const char *const script, FILE *const svg,
                                   struct dig_error *const error)
{
    char                       program[] = "gnuplot";
    char                       path[64];
    char *const                argv[] = { program, path, NULL };
    posix_spawn_file_actions_t actions;
    pid_t                      child  = -1;
    int                        status = -1;

    (void)snprintf(path, sizeof path, "%s", script);
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawn_file_actions_adddup2(&actions, fileno(svg), STDOUT_FILENO);
    (void)posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
    const int failed = posix_spawnp(&child, program, &actions, NULL, argv, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        return dig_error_set(error, DIG_EIO, "gnuplot: %s, expected in PATH (package gnuplot-nox)",
                             strerror(failed));
    }
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return dig_error_set(error, DIG_EIO, "gnuplot failed with status %d", status);
    }
    return DIG_OK;
}

// What gnuplot wrote, from the <svg tag on.
static enum dig_status copy_svg(FILE *const from, FILE *const to, struct dig_error *const error)
{
    char line[4096];
    bool inside = false;
    rewind(from);
    while (fgets(line, sizeof line, from) != NULL) {
        inside = inside || strstr(line, "<svg") != NULL;
        if (inside && fputs(line, to) == EOF) {
            return dig_error_set(error, DIG_EIO, "writing a plot: %s", strerror(errno));
        }
    }
    return inside ? DIG_OK : dig_error_set(error, DIG_EIO, "gnuplot wrote no picture");
}

enum dig_status dig_plot_svg(const struct dig_plot *const plot, FILE *const to,
                             struct dig_error *const error)
{
    assert(plot != NULL && to != NULL && plot->series <= DIG_PLOT_SERIES_MAX);

    char            path[]  = "/tmp/digsight-plot-XXXXXX";
    enum dig_status status  = DIG_EIO;
    const int       fd      = mkstemp(path);
    FILE *const     script  = fd >= 0 ? fdopen(fd, "w") : NULL;
    FILE *const     picture = script != NULL ? tmpfile() : NULL;
    if (picture == NULL) {
        (void)dig_error_set(error, DIG_EIO, "temporary file: %s", strerror(errno));
        goto done;
    }
    put_script(script, plot);
    if (fflush(script) != 0) {
        (void)dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
        goto done;
    }
    status = run_gnuplot(path, picture, error);
    if (status == DIG_OK) {
        status = copy_svg(picture, to, error);
    }
done:
    if (picture != NULL) {
        (void)fclose(picture);
    }
    if (script != NULL) {
        (void)fclose(script);
    } else if (fd >= 0) {
        (void)close(fd);
    }
    if (fd >= 0) {
        (void)unlink(path);
    }
    return status;
}
