// Checks a machine's file against a recording in free air: a checklist with answers.
//
// Without soil the balance of every joint is zero. First the recording is read in the way that
// leaves least of it (machine_reading.h): signs, large zeros, which cylinder is which, head and
// rod, unit. Then the equations of free air (machine_air.h) are fitted with everything that a file
// or a sensor may have wrong (machine_fit.h) within its tolerance, and causes join
// with a wide prior, one at a time, while each multiplies the evidence by more than causes / false
// alarm.
//
// One recording cannot show everything. What it does not show is "not told", and causes that
// explain it as well as the one named are named with it.

#ifndef DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_H
#define DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_H

#include "closed_loop/check/machine_reading.h"
#include "core/error.h"
#include "core/machine.h"
#include "core/recording.h"

#include <stdbool.h>
#include <stddef.h>

/// Questions, in the order of the checklist. The first two are of the recording, STUCK of every
/// signal, DELAY of all pressures, the others of every joint or its cylinder.
enum dig_check_question {
    DIG_CHECK_TIMES,     // samples per second, and the largest gap, s (value, tolerance)
    DIG_CHECK_MISSING,   // share of samples without all readings
    DIG_CHECK_STUCK,     // longest time at one value while it should move, s
    DIG_CHECK_MOVES,     // how far the joint turns, rad
    DIG_CHECK_RANGE,     // how far beyond the file's limits or its cylinder's stops, rad
    DIG_CHECK_DEGREES,   // angles are radians
    DIG_CHECK_DIRECTION, // the angle counts up; value: by how many sigmas the other way is worse
    DIG_CHECK_ZERO,      // the angle sensor reads so much too much, rad
    DIG_CHECK_CYLINDER,  // the pressures are its own cylinder's; value: sigmas
    DIG_CHECK_SIDES,     // head is head and rod is rod; value: sigmas
    DIG_CHECK_UNIT,      // a unit, or a factor of ten: true over read
    DIG_CHECK_FACTOR,    // the pressures read so many times too much, less one
    DIG_CHECK_OFFSET,    // they read so much too much, Pa at the head side; at_rod: or there
    DIG_CHECK_WEIGHT,    // the link weighs so much more than the file says, kg
    DIG_CHECK_DELAY,     // pressures are so much older than angles, s
    DIG_CHECK_REST,      // what nothing of this explains: rms over its sigma; share
    DIG_CHECK_QUESTIONS
};

enum dig_check_verdict {
    DIG_CHECK_OK,
    DIG_CHECK_UNTOLD,   // the recording does not tell
    DIG_CHECK_DOUBTFUL, // not surely wrong; or it is in the place of what is called wrong
    DIG_CHECK_WRONG
};

/// One line. NaN: no such number.
struct dig_check_item {
    enum dig_check_question question;
    int                     of; // joint, signal (STUCK), or -1
    enum dig_check_verdict  verdict;
    double                  value, sigma, tolerance;
    double                  excess;  // sigmas by which the file's answer is worse
    double                  share;   // REST: the same over the rms load
    double                  at_rod;  // OFFSET: the value, if the rod side's sensor is wrong
    int                     answer;  // CYLINDER: in whose columns its pressures are
    int                     or_item; // another line that explains it as well; -1: none
};

#define DIG_CHECK_ITEMS_MAX 64

/// Pushes over time for a picture, N: measured and by the file's balance; [3 * point + joint].
struct dig_check_curves {
    size_t  points;
    double *drive_N, *load_N, *time_s;      // one allocation; as the columns and the file say
    double *mended_drive_N, *mended_load_N; // likewise; best reading, corrected
};

/// Free with dig_machine_air_check_finish().
struct dig_machine_air_check {
    double                     duration_s;
    double                     angles_rad[DIG_JOINTS][2]; // least and most, as read best
    struct dig_reading_finding reading;
    size_t                     items;
    struct dig_check_item      item[DIG_CHECK_ITEMS_MAX];
    enum dig_check_verdict     verdict;     // the worst of all lines; UNTOLD counts as OK
    bool                       unexplained; // much is left: no answer is sure enough to be wrong
    double                     rest_plain[DIG_JOINTS]; // rms over sigma as the columns say
    struct dig_check_curves    curves;
};

/// Checks. The recording is free air from its first sample to its last; what lies beyond its first
/// five minutes is left out. DIG_EINVAL: a machine with a force sensor, or fewer than 50 samples
/// with all angles and the bucket's pressures; DIG_ENOMEM. Some seconds.
DIG_MUST_CHECK enum dig_status
dig_machine_air_check_run(const struct dig_machine           *machine,
                          const struct dig_machine_recording *recording,
                          struct dig_machine_air_check *check, struct dig_error *error);

void dig_machine_air_check_finish(struct dig_machine_air_check *check);

#endif // DIG_CLOSED_LOOP_CHECK_MACHINE_CHECK_H
