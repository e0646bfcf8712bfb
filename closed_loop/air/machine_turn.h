// How well the angles tell a block's mean acceleration. Parabolas of neighbouring points share
// angles: what noise makes of two is alike near each other and of other sign farther apart.
//
// While a joint turns slowly, a sensor with steps reads a sawtooth, of the frequency at which the
// joint passes steps; noise of the sensor takes off what it spreads. The k-th harmonic of a
// sawtooth of steps s that noise sigma spreads is s / (pi k) exp(-2 (pi k sigma / s)^2). The
// acceleration of the parabola fitted within +-h makes of one that turns x within h as much as
// 15 j2(x) / h^2, the mean over a block sin(y) / y, y being what it turns within half of that. j2:
// the spherical Bessel function.

#ifndef DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H
#define DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H

#include "closed_loop/air/machine_air.h"

/// The variance of every joint's mean acceleration over points DIG_AIR_STEP_s apart, by noise and
/// steps of its sensor, wherever the steps lie. Beside a gap points are known less, as their rates
/// say.
void dig_turn_variance(const struct dig_machine *machine, const struct dig_air_point point[],
                       size_t points, double variance[DIG_JOINTS]);

#endif // DIG_CLOSED_LOOP_AIR_MACHINE_TURN_H
