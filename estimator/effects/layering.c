// Below this height above the floor, rig scale, lies a layer of another gravel: a harder one, or
// where the number is negative a looser one below minus it.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_layering = {
    .id           = DIG_EFFECT_LAYERING,
    .summary      = "a layer of another gravel below, harder (+) or looser (-)",
    .templated    = true,
    .unlike_sides = true,
    .parameters   = 1,
    .parameter    = { { "layer_m", 0.0, -10.0, 10.0, 0.03 } },
};
