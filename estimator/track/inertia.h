// The links' inertia in a recorded dig, and what its seals may rub with. The tick's balance is
// quasi-static: accelerations of the last quarter second would come an eighth late, where an
// operator stops a boom in less. Behind the tick both sides of a sample are known. Friction that no
// file tells is in no sample; 1 sigma of it is in theirs, against the rods' motion.

#ifndef DIG_ESTIMATOR_TRACK_INERTIA_H
#define DIG_ESTIMATOR_TRACK_INERTIA_H

#include "core/machine.h"
#include "estimator/track/window.h"
#include "estimator/wrench/correction.h"

/// Takes what the links' masses add to moment and forces by moving off every sample of the window,
/// by the rates of the parabola through the angles within 0.12 s of it (estimator/wrench/rates.h);
/// the rates' noise is added to the sigmas. Where fewer than five samples lie so near nothing is
/// taken off. The forces' sigmas, and their slow parts, grow by a hundredth of the links' weight,
/// which the file's masses leave unsure; those of all by dig_cylinder_seal_N() of every drive whose
/// friction is not stated ([DIG_JOINTS]; NULL: of none is). machine: with cylinders, as a model
/// corrects it; of one with a force sensor nothing is done. lambda: its size over the table's.
/// O(samples * samples in 0.24 s); sorts as dig_window_sort() does.
void dig_inertia_take_off(const struct dig_machine *machine, const struct dig_friction stated[],
                          double lambda, struct dig_window *window);

#endif // DIG_ESTIMATOR_TRACK_INERTIA_H
