// The command line of digreport.

#ifndef DIG_TOOLS_DIGREPORT_OPTIONS_H
#define DIG_TOOLS_DIGREPORT_OPTIONS_H

#include "closed_loop/report/report.h"
#include "core/command_line.h"
#include "core/error.h"

#include <stdbool.h>

enum digreport_option {
    DIGREPORT_TABLE = 256,
    DIGREPORT_MACHINE,
    DIGREPORT_MODEL,
    DIGREPORT_TRUTH,
    DIGREPORT_RECORDING,
    DIGREPORT_TITLE,
    DIGREPORT_HTML,
    DIGREPORT_CSV,
    DIGREPORT_JSON,
    DIGREPORT_QUIET = 'q',
};

/// Its commands, and the options of them all.
const struct dig_program *digreport_program(void);

struct digreport_options {
    const char       *table, *machine, *model, *title, *html, *json;
    bool              truth_known, quiet;
    struct dig_gravel truth;
    size_t            recordings;
    const char       *recording[8];
    size_t            logs;
    char             *log[DIG_REPORT_RUNS_MAX];
};

/// Reads the command line; prints help or version and exits where asked to. *error says what is
/// wrong with it.
DIG_MUST_CHECK enum dig_status
digreport_parse(int argc, char *argv[], struct digreport_options *options, struct dig_error *error);

/// A file that cannot be read is bad input: DIG_EIO becomes DIG_EINVAL.
enum dig_status digreport_input(enum dig_status status);

#endif // DIG_TOOLS_DIGREPORT_OPTIONS_H
