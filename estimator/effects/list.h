// The effects, one a file of its name.

#ifndef DIG_ESTIMATOR_EFFECTS_LIST_H
#define DIG_ESTIMATOR_EFFECTS_LIST_H

#include "estimator/effects/effect.h"

// clang-format off
#define DIG_EFFECT_OF(id, name) extern const struct dig_effect dig_effect_##name;
DIG_EFFECTS_OF_MACHINE(DIG_EFFECT_OF)
DIG_EFFECTS_OF_SOIL(DIG_EFFECT_OF)
#undef DIG_EFFECT_OF
// clang-format on

#endif // DIG_ESTIMATOR_EFFECTS_LIST_H
