// Size of an effect in the moment of the digs, over the campaign's noise floor, after the best
// refit of the gravel. Below 1 another gravel serves as well as naming the effect.

#ifndef DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H
#define DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H

#include "closed_loop/fit/batch.h"
#include "closed_loop/fit/hypothesis.h"

/// Of what a machine adds to the moment of the batch's digs, machine[] by measured dig: rms over
/// rig time of what the best refit of the gravel, within the table, leaves of it, over the rms of
/// the floor (scatter of one dig / sqrt(digs), and what the digs of a trajectory share:
/// fitted->noise). fitted: the gravel, machine effects off. 0 where nothing is added. Milliseconds.
double dig_effect_size_of_machine(const struct dig_batch *batch, const struct dig_fitted *fitted,
                                  const double machine[][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// Of effect number e that chosen was fitted with; noise[]: what the digs of a trajectory share
/// without it (of the plain fit).
double dig_effect_size_of_soil(const struct dig_batch *batch, const struct dig_fitted *chosen,
                               size_t e, const double noise[]);

/// Of what no gravel explains of the digs' mean moments as measured, machine effects off. What the
/// floor itself would leave is subtracted, so that plain gravel has 0 on average. fitted: plain.
double dig_effect_size_left(const struct dig_batch *batch, const struct dig_fitted *fitted);

/// Chance, 0 … 1, that an effect of this size is no smaller than the floor, which is known to a
/// quarter of itself.
double dig_effect_size_chance(double size);

#endif // DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H
