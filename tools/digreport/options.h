// The command line of digreport.

#ifndef DIG_TOOLS_DIGREPORT_OPTIONS_H
#define DIG_TOOLS_DIGREPORT_OPTIONS_H

#include "closed_loop/report/report.h"
#include "core/error.h"

#include <stdbool.h>

/// Of both commands. title: NULL where none was given. Without the command `shift` there are 1 to
/// DIG_REPORT_RUNS_MAX logs, each NAME=LOG.lcm.
struct digreport_options {
    bool              shift; // the command
    const char       *table, *machine, *model, *title, *html, *csv, *json;
    bool              truth_known, quiet;
    struct dig_gravel truth;
    size_t            recordings;
    const char       *recording[8];
    size_t            logs;
    char            **log;
};

/// Reads the command line; prints help or version and exits where asked to. *error says what is
/// wrong with it.
DIG_MUST_CHECK enum dig_status
digreport_parse(int argc, char *argv[], struct digreport_options *options, struct dig_error *error);

/// What is wrong with the command line, whose first word is word, to stderr; what to exit with.
int digreport_refuse(const char *word, const struct dig_error *error);

#endif // DIG_TOOLS_DIGREPORT_OPTIONS_H
