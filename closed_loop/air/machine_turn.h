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

#ifndef DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H
#define DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H

#include "closed_loop/air/machine_air.h"

/// The variance of every joint's mean acceleration over points DIG_AIR_STEP_s apart, by noise and
/// steps of its sensor, wherever the steps lie. Beside a gap points are known less, as their rates
/// say.
void dig_turn_variance(const struct dig_machine *machine, const struct dig_air_point point[],
                       size_t points, double variance[DIG_JOINTS]);

#endif // DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H
