// The terminal, through ncurses, which no other file knows. One at a time.

#ifndef DIG_TOOLS_DIGWATCH_TERMINAL_H
#define DIG_TOOLS_DIGWATCH_TERMINAL_H

#include "core/error.h"
#include "tools/digwatch/grid.h"

/// Takes the terminal over; it is given back by digwatch_terminal_close(), and when the program
/// ends by exit(), abort() or a fault. Standard error is silent meanwhile. DIG_EINVAL: standard
/// input or output is no terminal, or one that ncurses does not know. *utf8: it can show all.
DIG_MUST_CHECK enum dig_status digwatch_terminal_open(bool *utf8, struct dig_error *error);

/// Its size now.
void digwatch_terminal_size(int *rows, int *columns);

/// The next key that was pressed, 0 for none, without waiting. Takes note of a new size.
int digwatch_terminal_key(void);

/// Only what changed is sent.
void digwatch_terminal_show(const struct digwatch_grid *grid);

/// Harmless when it is not open.
void digwatch_terminal_close(void);

#endif // DIG_TOOLS_DIGWATCH_TERMINAL_H
