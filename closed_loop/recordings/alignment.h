// Aligns the rows of a force recording with its trajectory by pose, at any pace, with noisy path
// sensors, and where the recording lacks a part of the dig.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_ALIGNMENT_H
#define DIG_CLOSED_LOOP_RECORDINGS_ALIGNMENT_H

#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"

#include <stdbool.h>
#include <stddef.h>

/// What a recording is aligned with: a trajectory, against which the bucket may be turned by so
/// much all along.
struct dig_alignment_target {
    const struct dig_trajectory *trajectory;
    double                       tooth_m;
    double                       least_rad, most_rad; // 0 and 0: not at all
};

/// The part of a trajectory's path, 0 … 1, that a recording covers, and its distance from the path.
/// Below 0 and above 1: it goes on beyond the trajectory's ends.
struct dig_alignment_part {
    double from, to;
    double off;        // rms, in bucket lengths
    double turned_rad; // of the bucket against the trajectory, positive curls
};

/// Whether it lacks more than three tenths of the trajectory at either end: too little of a dig.
bool dig_alignment_lacks_too_much(const struct dig_alignment_part *part);

/// Writes the path travelled up to each row as a fraction of the recording's whole; returns that
/// whole, m: the pin's way and the tooth's about it. Motions within a hundredth of the tooth's
/// length of where the path was last known to be are taken for noise of the path's sensors.
/// O(rows).
double dig_alignment_progress(const struct dig_recording *recording, double tooth_m,
                              double progress[]);

/// The row at or before this progress, and how far towards the next; from: of a call with no more
/// progress, or 0.
struct dig_alignment_place {
    size_t row;
    double fraction;
};
struct dig_alignment_place dig_alignment_place(size_t rows, const double progress[], double at,
                                               size_t from);

/// The pose at such a place, straight between the rows; what the path's sensors read.
struct dig_pose dig_alignment_pose(const struct dig_recording       *recording,
                                   const struct dig_alignment_place *place);

/// The rms distance between recorded and prescribed poses at equal progress of what both have,
/// without the mean offset of the pin (the ground may lie anywhere) and the mean turn within the
/// target's range: fills off and turned_rad of a part from its from and to.
void dig_alignment_compare(const struct dig_recording *recording, const double progress[],
                           const struct dig_alignment_target *target,
                           struct dig_alignment_part         *part);

/// Finds which part of the trajectory's path was recorded, or what of the recording lies beyond it:
/// all of it and no more, unless that comes twice as near. It may be a part that lacks too much.
struct dig_alignment_part dig_alignment_align(const struct dig_recording        *recording,
                                              const double                       progress[],
                                              const struct dig_alignment_target *target);

/// Steps, then noise, of a path whose poses themselves are read (estimator/track/steady.h), in
/// place. number: four times as many as rows, and one. O(rows log rows).
void dig_steady_path(struct dig_recording *recording, double tooth_m, double number[]);

/// Finds the trajectory of a table that a force recording followed, and its approach. Writes
/// trajectory, off_path_m, made and approach of *observed, and which part of the trajectory
/// the recording tells of. progress: up to each row, of the recording's whole. as_dug: as
/// dig_observe_as_dug(). DIG_ENOMATCH: as dig_observe_dig().
DIG_MUST_CHECK enum dig_status
dig_path_match(const struct dig_curve_set *set, const struct dig_recording *recording,
               const double progress[], bool as_dug, struct dig_measured *observed,
               struct dig_alignment_part *part, struct dig_error *error);

#endif // DIG_CLOSED_LOOP_RECORDINGS_ALIGNMENT_H
