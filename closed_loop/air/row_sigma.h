// What the rows of free air are off by beside the white noise of pressures.
//
// Variance of a block's mean acceleration from noise and steps of the angles. Parabolas of
// neighbouring points share angles, so their noise is correlated: positively near each other,
// negatively farther apart.
//
// While a joint turns slowly, a sensor with steps reads a sawtooth, of the frequency at which the
// joint passes steps. Noise sigma of the sensor smooths it: its k-th harmonic at steps s is
// s / (pi k) exp(-2 (pi k sigma / s)^2). The acceleration of a parabola fitted within +-h
// multiplies a harmonic whose phase turns by x within h by 15 j2(x) / h^2, j2 being the spherical
// Bessel function. The mean over a block multiplies it by sin(y) / y, y being the phase in half a
// block.
//
// Readings that stand. A sensor that is quiet beside its step reads one and the same number while a
// machine stands: all readings of a pose are rounded alike, and their mean is known no better than
// one of them. Noise of half a step spreads the rounding evenly, and the mean of many is sure.

#ifndef DIG_CLOSED_LOOP_AIR_ROW_SIGMA_H
#define DIG_CLOSED_LOOP_AIR_ROW_SIGMA_H

#include "closed_loop/air/machine_air.h"

/// The variance of every joint's mean acceleration over points DIG_AIR_STEP_s apart, by noise and
/// steps of its sensor, wherever the steps lie. Beside a gap points are known less, as their rates
/// say.
void dig_turn_variance(const struct dig_machine *machine, const struct dig_air_point point[],
                       size_t points, double variance[DIG_JOINTS]);

/// Raises the sigma of the segment's rows in which a chamber stands, so that together they tell as
/// much of its pressure as there are roundings: one, and one more for every step that its reading
/// goes meanwhile. Rows whose readings change from sample to sample stay as they are.
void dig_stand_widen(struct dig_air *air, const struct dig_air_segment *segment,
                     const struct dig_machine_dig *dig);

#endif // DIG_CLOSED_LOOP_AIR_ROW_SIGMA_H
