// Finds the motion in free air that best tells two corrections of a machine apart. The machine of
// the file swings one joint, its chambers at the pressures which that takes. The residuals of the
// balance with either correction are compared, row by row as free air is traced
// (closed_loop/air/machine_air.h).

#ifndef DIG_CLOSED_LOOP_VERDICT_AIR_MOTION_H
#define DIG_CLOSED_LOOP_VERDICT_AIR_MOTION_H

#include "core/machine.h"
#include "core/status.h"
#include "estimator/wrench/correction.h"

#include <stdbool.h>

/// How long each motion lasts, s.
#define DIG_MOTION_s 20.0

/// One joint swings about the middle of its range by three tenths of it, the others held in the
/// middle of theirs: once in DIG_MOTION_s, or fast, five times.
struct dig_motion {
    enum dig_joint joint;
    bool           fast;
};

/// By how much a and b differ in that motion, in the sensors' sigmas: root of the sum of squares
/// over rows. 0 where no row tells. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_motion_sigmas(const struct dig_machine    *machine,
                                                 const struct dig_motion     *motion,
                                                 const struct dig_correction *a,
                                                 const struct dig_correction *b, double *sigmas);

/// The motion in which they differ most; slow ones and the bucket's first where others tell as
/// much. A tenth of a second. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_motion_best(const struct dig_machine    *machine,
                                               const struct dig_correction *a,
                                               const struct dig_correction *b,
                                               struct dig_motion *best, double *sigmas);

#endif // DIG_CLOSED_LOOP_VERDICT_AIR_MOTION_H
