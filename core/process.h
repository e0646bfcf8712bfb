// Other programs, started by their arguments: no shell reads a line of ours.

#ifndef DIG_CORE_PROCESS_H
#define DIG_CORE_PROCESS_H

#include "core/error.h"

#include <stdio.h>

#define DIG_PROCESS_ARGUMENTS_MAX 63

struct dig_process {
    const char *const *argv;    // argv[0] is found on PATH; NULL behind the last
    const char        *without; // what begins so is not in its environment; NULL: all is
    FILE              *in;      // NULL: nothing to read
    FILE              *out;     // standard output
};

/// Runs a program and waits for its end. DIG_EINVAL: there is none of that name; DIG_EIO: it did
/// not end with 0, *error is the last line it wrote to standard error.
DIG_MUST_CHECK enum dig_status dig_process_run(const struct dig_process *process,
                                               struct dig_error         *error);

/// The last line of a file that is not blank, as far as it fits; "" where there is none.
void dig_process_last_line(FILE *file, size_t size, char line[]);

#endif // DIG_CORE_PROCESS_H
