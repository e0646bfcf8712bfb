// The command that computes a table for the effects a trace found.

#ifndef DIG_TOOLS_DIGLOOP_NEXT_TABLE_H
#define DIG_TOOLS_DIGLOOP_NEXT_TABLE_H

#include "closed_loop/recordings/measured.h"
#include "tools/digloop/commands.h"

/// Fills trace->command where the verdict holds effects of the soil that beds can hold: shell lines
/// that write a grid and run digtable on it, for beds of the gravel found with these effects in
/// them, in the table of effects beside the table. Nothing without free air, or where a magnitude
/// is none that a bed can hold. effects: of digloop_load_effects(). *error as files have it.
DIG_MUST_CHECK enum dig_status digloop_next_table(const struct digloop_job *job,
                                                  const char *effects, size_t digs,
                                                  const struct dig_measured measured[],
                                                  struct dig_trace *trace, struct dig_error *error);

#endif // DIG_TOOLS_DIGLOOP_NEXT_TABLE_H
