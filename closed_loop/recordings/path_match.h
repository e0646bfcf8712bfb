// Finds the trajectory of a table that a force recording followed, and its approach.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_PATH_MATCH_H
#define DIG_CLOSED_LOOP_RECORDINGS_PATH_MATCH_H

#include "closed_loop/recordings/alignment.h"
#include "closed_loop/recordings/measured.h"
#include "core/error.h"

/// Writes trajectory, off_path_m, made and approach of *observed, and which part of the trajectory
/// the recording tells of. progress: up to each row, of the recording's whole. as_dug: as
/// dig_observe_as_dug(). DIG_ENOMATCH: as dig_observe_dig().
DIG_MUST_CHECK enum dig_status
dig_path_match(const struct dig_curve_set *set, const struct dig_recording *recording,
               const double progress[], bool as_dug, struct dig_measured *observed,
               struct dig_alignment_part *part, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_PATH_MATCH_H
