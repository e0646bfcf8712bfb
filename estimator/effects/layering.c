// Below this height above the floor lies a layer of another gravel, rig scale.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_layering = {
    .id         = DIG_EFFECT_LAYERING,
    .summary    = "a layer of another gravel below",
    .parts      = DIG_IN_SOIL | DIG_IN_LIFT,
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "layer_m", 0.0, 0.0, 10.0, 0.03 } },
};
