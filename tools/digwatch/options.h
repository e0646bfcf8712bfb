// The command line of digwatch.

#ifndef DIG_TOOLS_DIGWATCH_OPTIONS_H
#define DIG_TOOLS_DIGWATCH_OPTIONS_H

#include "core/error.h"

#include <stdbool.h>

struct digwatch_options {
    const char *url, *log, *prometheus; // log, prometheus: NULL for none
    double      speed;
    bool        ascii;
};

/// Reads the command line; prints help or version and exits where asked to. *error says what is
/// wrong with it.
DIG_MUST_CHECK enum dig_status
digwatch_parse(int argc, char *argv[], struct digwatch_options *options, struct dig_error *error);

#endif // DIG_TOOLS_DIGWATCH_OPTIONS_H
