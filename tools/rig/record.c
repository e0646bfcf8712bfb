#include "tools/rig/commands.h"

#include "core/recording.h"
#include "files/recording_csv.h"
#include "files/text/whole.h"
#include "tools/rig/sensors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// The true pose and load beside the readings, for tests and plots.
static enum dig_status write_truth(const char *const path, const struct dig_rig_track *const track,
                                   struct dig_error *const error)
{
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    (void)fputs("t_s,X_m,Z_m,phi_rad,Fx_N,Fz_N,My_Nm\n", out.file);
    for (size_t i = 0; i < track->rows; i++) {
        const struct dig_rig_row *const row = &track->row[i];
        (void)fprintf(out.file, "%.6f,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n",
                      (double)i * track->step_s, row->pose.X_m, row->pose.Z_m, row->pose.phi_rad,
                      0.0 - row->soil.FX_N, row->soil.FZ_N, row->soil.M_Nm);
    }
    dig_c_locale_leave(&locale);
    return dig_out_commit(&out, error);
}

enum dig_status dig_rig_record(const struct dig_machine *const     machine,
                               const struct dig_rig_options *const options,
                               const struct dig_rig_track *const   track,
                               struct dig_error *const             error)
{
    struct dig_machine_recording recording = {
        .rows = track->rows,
        .row  = malloc(track->rows * sizeof recording.row[0]),
    };
    if (recording.row == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%zu samples", track->rows);
    }
    struct dig_rig_noise noise = dig_rig_noise_init(options->seed);
    for (size_t i = 0; i < track->rows; i++) {
        const int64_t time_ns = llround((double)i * track->step_s * 1e9);
        recording.row[i] =
            dig_rig_sense(machine, &track->row[i], time_ns, options->noise ? &noise : NULL);
        if (options->quantise) {
            dig_rig_quantise(machine, &recording.row[i]);
        }
    }

    enum dig_status status = DIG_OK;
    if (options->truth != NULL) {
        status = write_truth(options->truth, track, error);
    }
    if (status == DIG_OK) {
        status = dig_machine_recording_write(options->out, &recording, error);
    }
    dig_machine_recording_finish(&recording);
    return status;
}
