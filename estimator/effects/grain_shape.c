// Grains longer than wide: the aspect ratio of a clump of two spheres.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_grain_shape = {
    .id         = DIG_EFFECT_GRAIN_SHAPE,
    .summary    = "grains that are not round",
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "aspect", 1.0, 1.0, 4.0, 0.3 } },
};
