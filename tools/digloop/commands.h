// digloop's commands, and what its command line asks for.

#ifndef DIG_TOOLS_DIGLOOP_COMMANDS_H
#define DIG_TOOLS_DIGLOOP_COMMANDS_H

#include "closed_loop/verdict/trace.h"
#include "core/approach.h"
#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>

#define DIGLOOP_PATH_SIZE 1024

struct digloop_options {
    const char         *table;      // check: the machine's file
    int                 recordings; // or campaign folders: what stands after the table
    char              **recording;
    const char         *machine, *model, *trajectory;    // identify, predict
    const char         *identified, *out, *measured;     // predict
    const char         *effects, *json_out, *html, *add; // trace
    bool                moment_alone;                    // identify
    struct dig_approach approach;                        // predict: the plain one if not given
    bool                json, quiet;
};

/// What a command goes by: its options, the table, and the machine of --machine.
struct digloop_job {
    const struct digloop_options *options;
    struct dig_curve_set         *set;
    const struct digloop_machine *machine; // tools/digloop/recording.h; NULL: no --machine
};

DIG_MUST_CHECK enum dig_status digloop_identify(const struct digloop_job *job,
                                                struct dig_error         *error);
DIG_MUST_CHECK enum dig_status digloop_predict(const struct digloop_job *job,
                                               struct dig_error         *error);
DIG_MUST_CHECK enum dig_status digloop_trace(const struct digloop_job *job,
                                             struct dig_error         *error);
DIG_MUST_CHECK enum dig_status digloop_design(const struct digloop_job *job,
                                              struct dig_error         *error);

/// Needs no table: options->table is the machine's file. *wrong: the check finds something wrong.
DIG_MUST_CHECK enum dig_status digloop_check(const struct digloop_options *options, bool *wrong,
                                             struct dig_error *error);

/// Fills trace->command where the verdict holds effects of the soil that beds can hold: shell lines
/// that write a grid and run digtable on it, for beds of the gravel found with these effects in
/// them, in the table of effects beside the table. Nothing without free air, or where a magnitude
/// is none that a bed can hold. effects: that table's
/// path. *error as files have it.
DIG_MUST_CHECK enum dig_status digloop_next_table(const struct digloop_job *job,
                                                  const char *effects, size_t digs,
                                                  const struct dig_measured measured[],
                                                  struct dig_trace *trace, struct dig_error *error);

#endif // DIG_TOOLS_DIGLOOP_COMMANDS_H
