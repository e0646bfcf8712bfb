// One run of the daemon in the report: published match and prediction, and the digs measured again.

#ifndef DIG_TOOLS_DIGREPORT_RUN_H
#define DIG_TOOLS_DIGREPORT_RUN_H

#include "closed_loop/report/report.h"
#include "core/machine.h"
#include "estimator/wrench/correction.h"

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

/// Fills the run from NAME=LOG.lcm: the dig that identified the gravel, the one that was predicted,
/// and the force recordings that were fed to the rig. DIG_ENOMATCH for a log without such digs;
/// reading fails as dig_lcm_log_each() and dig_recording_read() do.
DIG_MUST_CHECK enum dig_status digreport_run(const struct digreport_options     *options,
                                             const struct dig_machine           *machine,
                                             const struct dig_corrected_machine *corrected,
                                             const struct dig_curve_set *set, char *named_log,
                                             struct dig_report_run *run, struct dig_error *error);

#endif // DIG_TOOLS_DIGREPORT_RUN_H
