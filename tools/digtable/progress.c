#include "tools/digtable/progress.h"

#include "offline_dem/sweep/sweep.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

struct dig_progress_line dig_progress_line(const bool quiet)
{
    const bool tty = !quiet && isatty(STDERR_FILENO) == 1;
    return (struct dig_progress_line){ .tty       = tty,
                                       .every_s   = quiet ? (double)INFINITY
                                                    : tty ? 0.2
                                                          : 5.0,
                                       .printed_s = -1e9 };
}

bool dig_progress_is_due(struct dig_progress_line *const line)
{
    const double at_s = dig_sweep_now_s();
    if (at_s - line->printed_s < line->every_s) {
        return false;
    }
    line->printed_s = at_s;
    return true;
}

const char *dig_progress_start(const struct dig_progress_line *const line)
{
    return line->tty ? "\r" : "";
}

void dig_progress_end(const struct dig_progress_line *const line, const bool last)
{
    (void)fputs(line->tty && !last ? "\033[K" : line->tty ? "\033[K\n" : "\n", stderr);
    (void)fflush(stderr);
}

const char *dig_progress_span(const double seconds, const size_t size, char text[const])
{
    if (!isfinite(seconds)) {
        (void)snprintf(text, size, "?");
    } else if (seconds < 100.0) {
        (void)snprintf(text, size, "%.0f s", seconds);
    } else {
        const long whole = (long)seconds;
        (void)snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    }
    return text;
}
