// The digs of a log, from the daemon's messages alone: what each resisted with, at machine scale,
// and how wrong its prediction was.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_DIG_H
#define DIG_TOOLS_DIGREPORT_SHIFT_DIG_H

#include "core/curve.h"
#include "core/error.h"
#include "files/lcm/lcm_message.h"
#include "files/lcm/predicted_curve.h"

#include <stdbool.h>
#include <stdint.h>

/// How a dig ended, as the daemon counts it (docs/formats/daemon.md).
enum digreport_ending {
    DIGREPORT_NOT_TOLD,
    DIGREPORT_WHOLE,
    DIGREPORT_ABORTED,
    DIGREPORT_UNKNOWN, // along no trajectory, too short, or with samples missing
    DIGREPORT_ENDINGS
};

/// From contact to exit. NaN: not known.
struct digreport_dig {
    int64_t               time_us; // wall clock of its begin
    int32_t               number;  // as the daemon counts
    enum digreport_ending ended;
    double                duration_s;
    char                  trajectory[DIG_NAME_SIZE]; // "": none of the table's
    double                peak_Nm; // of the moment, averaged as the table's curves are
    double energy_J; // work on the soil; NaN where a force was not measured throughout
    double predicted_peak_Nm, predicted_peak_sigma_Nm;
    double predicted_energy_J, predicted_energy_sigma_J;
    double error, noise_floor; // docs/glossary.md, of the first prediction made in the dig
};

/// A row of the dig in progress.
struct digreport_row {
    int64_t time_ns;
    double  moment_Nm, progress;
    bool    force_valid;
    double  force_x_N, force_z_N, pin_X_m, pin_Z_m, phi_rad;
};

/// Zeroed, but for half_s: no dig is in progress.
struct digreport_dig_track {
    double                     half_s; // of the moving average, machine time
    bool                       open;
    int32_t                    dig_count; // digs finished before it
    struct digreport_dig       dig;
    size_t                     rows;
    struct digreport_row      *row;
    bool                       predicted;
    struct dig_predicted_curve prediction;
};

/// Takes an estimate. *finished: whether it ended a dig, then in *dig; a contact that was none is
/// forgotten. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status digreport_track_estimate(struct digreport_dig_track *track,
                                                        int64_t                     time_us,
                                                        const digsight_estimate_t  *estimate,
                                                        bool *finished, struct digreport_dig *dig);

/// Keeps the first prediction that was made in this dig, along its trajectory, from the gravel of
/// digs before it.
void digreport_track_prediction(struct digreport_dig_track  *track,
                                const digsight_prediction_t *prediction);

/// Forgets the dig in progress, as another log begins; frees its rows.
void digreport_track_finish(struct digreport_dig_track *track);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_DIG_H
