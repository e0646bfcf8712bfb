#include "tools/rig/record.h"

#include "core/recording.h"
#include "files/recording_csv.h"
#include "tools/rig/sensors.h"
#include "tools/rig/truth.h"

#include <math.h>
#include <stdlib.h>

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
        status = dig_rig_truth_write(options->truth, track, error);
    }
    if (status == DIG_OK) {
        status = dig_machine_recording_write(options->out, &recording, error);
    }
    dig_machine_recording_finish(&recording);
    return status;
}
