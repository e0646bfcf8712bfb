// Progress: a line that is redrawn on a terminal, and a line every few seconds in a log.

#ifndef DIG_TOOLS_DIGTABLE_PROGRESS_H
#define DIG_TOOLS_DIGTABLE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

struct dig_progress_line {
    bool   tty;
    double every_s, printed_s;
};

/// A quiet one is never due.
struct dig_progress_line dig_progress_line(bool quiet);

/// True when the next line is due; it then counts as printed. Begin the line with
/// dig_progress_start() and close it with dig_progress_end().
bool        dig_progress_is_due(struct dig_progress_line *line);
const char *dig_progress_start(const struct dig_progress_line *line);
void        dig_progress_end(const struct dig_progress_line *line, bool last);

/// "42 s", "1:02:03", or "?" when it is not finite. Returns text.
const char *dig_progress_span(double seconds, size_t size, char text[]);

#endif // DIG_TOOLS_DIGTABLE_PROGRESS_H
