// digloop check: what a machine's file makes of a recording in free air.

#include "closed_loop/check/machine_check.h"
#include "closed_loop/report/machine_check_report.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/text/whole.h"
#include "tools/digloop/commands.h"

#include <assert.h>
#include <stdio.h>

static enum dig_status write_results(const struct digloop_options *const   options,
                                     const struct dig_check_subject *const subject,
                                     struct dig_error *const               error)
{
    struct dig_out  out;
    enum dig_status status = DIG_OK;
    if (dig_out_begin(&out, options->json_out, &status, error)) {
        dig_machine_check_json(subject, out.file);
        status = dig_out_commit(&out, error);
    }
    if (dig_out_begin(&out, options->html, &status, error)) {
        status = dig_out_end(&out, dig_machine_check_html(subject, out.file, error), error);
    }
    const bool on_stdout = dig_out_is_stdout(options->json_out) || dig_out_is_stdout(options->html);
    if (status == DIG_OK && !options->quiet) {
        dig_machine_check_text(subject, on_stdout ? stderr : stdout);
    }
    return status;
}

enum dig_status digloop_check(const struct digloop_options *const options, bool *const wrong,
                              struct dig_error *const error)
{
    assert(options != NULL && wrong != NULL);
    struct dig_machine           machine;
    struct dig_machine_recording recording = { .rows = 0 };
    struct dig_machine_air_check check     = { .items = 0 };
    enum dig_status              status    = dig_machine_read(options->table, &machine, error);
    if (status == DIG_OK) {
        status = dig_machine_recording_read(options->recording[0], &recording, error);
    }
    if (status == DIG_OK) {
        status =
            dig_error_name(error, dig_machine_air_check_run(&machine, &recording, &check, error),
                           "%s", options->recording[0]);
    }
    if (status == DIG_OK) {
        const struct dig_check_subject subject = { &machine, options->table, options->recording[0],
                                                   &check };
        status                                 = write_results(options, &subject, error);
        *wrong                                 = check.verdict == DIG_CHECK_WRONG;
    }
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&recording);
    return status;
}
