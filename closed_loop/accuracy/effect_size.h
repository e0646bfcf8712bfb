// How much of an effect reaches what the campaign is about: the moment of the digs.

#ifndef DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H
#define DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H

#include "closed_loop/fit/hypothesis.h"
#include "closed_loop/fit/whitened_digs.h"

/// Size of what a machine adds to the moment of the batch's digs, machine[] by measured dig: rms
/// over rig time of what is left of it after the best refit of the gravel, within the table, over
/// the rms of the campaign's floor (scatter of one dig / sqrt(digs), and what the digs of a
/// trajectory share: fitted->noise). fitted: the gravel, machine effects off. Below 1 another
/// gravel serves as well as naming the effect. 0 where nothing is added. Milliseconds.
double dig_effect_size_of_machine(const struct dig_whitened_digs *batch,
                                  const struct dig_fitted        *fitted,
                                  const double machine[][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// The same of effect number e that chosen was fitted with; noise[]: what the digs of a trajectory
/// share without it (of the plain fit).
double dig_effect_size_of_soil(const struct dig_whitened_digs *batch,
                               const struct dig_fitted *chosen, size_t e, const double noise[]);

/// The same of what no gravel explains of the digs' mean moments as they were measured, machine
/// effects off: what the floor itself would leave is taken off, so that digs of a plain gravel have
/// none on average. fitted: plain.
double dig_effect_size_left(const struct dig_whitened_digs *batch, const struct dig_fitted *fitted);

/// The chance that an effect of this size is no smaller than the floor, which is known to a
/// quarter.
double dig_effect_size_chance(double size);

#endif // DIG_CLOSED_LOOP_ACCURACY_EFFECT_SIZE_H
