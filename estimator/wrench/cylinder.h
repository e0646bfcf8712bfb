// Push of a drive's rod by its two pressures.
//
//   head side  |=====[piston]-----rod-----o eye      push > 0 lengthens the cylinder
//
//   push = count * (head_Pa * head area - rod_Pa * annulus area)
//
// Seal friction acts between these pressures and the eye; it is corrected elsewhere (correction.h).

#ifndef DIG_ESTIMATOR_WRENCH_CYLINDER_H
#define DIG_ESTIMATOR_WRENCH_CYLINDER_H

#include "core/machine.h"
#include "core/status.h"

#include <stdbool.h>

/// Nearer than this to either end of its stroke a cylinder may rest on its stop, which then carries
/// load that the pressures do not show.
#define DIG_CYLINDER_STOP_MARGIN_m 0.005

struct dig_push {
    double push_N;  // of the whole drive
    double sigma_N; // 1 sigma of one reading
    double slow_N;  // the part of sigma that does not average down over many readings
    bool   valid;   // false: a chamber at its relief pressure or below any vacuum
};

/// Push of the drive. step_Pa: quantisation of the readings (0: none). A chamber within half a step
/// and three sensor sigmas of relief_Pa makes it invalid, the valve may be open; so does one as far
/// below -1 bar, which no oil can hold. DIG_EINVAL for a pressure that is not finite. Constant
/// time.
///
/// sigma: every chamber errs by step / sqrt(12) (uniform) and its sensor's sigma; chambers err
/// independently. slow: see dig_reading_slow().
DIG_MUST_CHECK enum dig_status dig_cylinder_push(const struct dig_cylinder *cylinder,
                                                 double head_Pa, double rod_Pa, double step_Pa,
                                                 struct dig_push *push);

/// True when the cylinder stands clear of both ends of its stroke.
bool dig_cylinder_is_clear(const struct dig_cylinder *cylinder, double length_m);

/// 1 sigma of the dry friction of a drive's seals, of which its file says nothing, N: a hundredth
/// of its largest push.
double dig_cylinder_seal_N(const struct dig_cylinder *cylinder);

/// 1 sigma of one reading with quantisation step and sensor noise sigma, both in one unit.
double dig_reading_sigma(double step, double sigma);

/// 1 sigma of what remains of the quantisation error when many readings of a steady signal are
/// averaged: sensor noise dithers the quantiser, and the error left is
/// step / pi * exp(-2 pi^2 sigma^2 / step^2) in amplitude (first harmonic of the saw tooth, Widrow
/// 1956), its rms 1 / sqrt(2) of that; never more than step / sqrt(12).
double dig_reading_slow(double step, double sigma);

#endif // DIG_ESTIMATOR_WRENCH_CYLINDER_H
