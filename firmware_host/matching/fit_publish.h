// Output of the matching thread: log lines, the tick's prediction basis, results, the state file.

#ifndef DIG_FIRMWARE_HOST_MATCHING_FIT_PUBLISH_H
#define DIG_FIRMWARE_HOST_MATCHING_FIT_PUBLISH_H

#include "firmware_host/matching/fit.h"

/// Logs a line, cut at 199 characters.
__attribute__((format(printf, 2, 3))) void dig_fit_log(struct dig_fit *fit, const char *format,
                                                       ...);

/// Makes the forecast of a track and publishes it to the tick; with a table the tick does not use
/// yet, through the table's port.
void dig_fit_publish_basis(struct dig_fit *fit, const struct dig_gravel_track *track);

/// Publishes the basis with the forecast of one trajectory adapted to the dig in progress; dig
/// NULL: the table holds none for it. Nothing without a valid track, or while the tick uses another
/// table.
void dig_fit_publish_basis_as_dug(struct dig_fit *fit, const struct dig_gravel_track *track,
                                  size_t trajectory, const struct dig_observation *dig);

/// Publishes fit->track to tick and publisher.
void dig_fit_publish_track(struct dig_fit *fit);

/// Saves fit->track and its digs in the state file; logs a failure.
void dig_fit_save_state(struct dig_fit *fit);

#endif // DIG_FIRMWARE_HOST_MATCHING_FIT_PUBLISH_H
