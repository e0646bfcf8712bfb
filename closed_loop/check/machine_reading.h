// Finds mistakes in how a recording of free air is read: an angle that counts the other way or from
// elsewhere, pressures of another cylinder, head for rod, another unit. Each is a discrete
// hypothesis; one likelihood compares their residuals of the balance of every joint.
//
// Coarse on purpose (drive_misfit.h): the fit of machine_check.h finds finer errors.

#ifndef DIG_CLOSED_LOOP_CHECK_MACHINE_READING_H
#define DIG_CLOSED_LOOP_CHECK_MACHINE_READING_H

#include "closed_loop/air/machine_air.h"
#include "closed_loop/machine_digs/machine_dig.h"
#include "core/machine.h"
#include "core/recording.h"

#include <stdbool.h>

/// Zeros are tried so far apart; what is between is the fit's.
#define DIG_READING_ZERO_STEP_deg 10

/// The joint's angle is (turned ? - : +) what its column says - zero_rad. The chambers of joint j
/// are in the columns of drive[j], head and rod exchanged where swapped[j]; the pressure is
/// factor[j] times what the column says.
struct dig_reading {
    bool           degrees; // the columns of angles
    bool           turned[DIG_JOINTS];
    double         zero_rad[DIG_JOINTS];
    enum dig_joint drive[DIG_JOINTS];
    bool           swapped[DIG_JOINTS];
    double         factor[DIG_JOINTS];
};

/// True where angles are so large that they can only be degrees.
bool dig_reading_in_degrees(const struct dig_machine_dig *dig);

/// Rewrites every sample so that its columns say what they should.
void dig_reading_apply(const struct dig_reading *reading, struct dig_machine_recording *recording);

/// What is asked of every joint: does its angle count the other way, in which columns are its
/// pressures, are head and rod exchanged, by what are they multiplied.
enum dig_reading_question {
    DIG_READING_TURNED,
    DIG_READING_DRIVE,
    DIG_READING_SWAPPED,
    DIG_READING_FACTOR,
    DIG_READING_QUESTIONS
};

/// The best reading, and by how many sigmas (root of twice the logarithm of the ratio of
/// likelihoods) the best with another answer to one question is worse: the columns' own answer
/// where it is not that; NaN where there is no other, or the joint hardly moves and was not asked.
struct dig_reading_finding {
    struct dig_reading best;
    bool               plain[DIG_READING_QUESTIONS][DIG_JOINTS]; // it answers as the columns do
    double             sigmas[DIG_READING_QUESTIONS][DIG_JOINTS];
};

/// Finds it in the air of one recording, as its columns say; degrees: its angles are. moves: joints
/// that move enough to be asked about. A second of one core. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_reading_find(const struct dig_machine *machine,
                                                const struct dig_air *air, bool degrees,
                                                const bool                  moves[DIG_JOINTS],
                                                struct dig_reading_finding *finding);

#endif // DIG_CLOSED_LOOP_CHECK_MACHINE_READING_H
