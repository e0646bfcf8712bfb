// Grains stick to each other and to the bucket alike: the cohesion energy density of an SJKR
// contact, as a bed was dug with.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_cohesion = {
    .id             = DIG_EFFECT_COHESION,
    .summary        = "grains that stick to each other and to the bucket",
    .templated      = true,
    .over_stiffness = true,
    .parameters     = 1,
    .parameter      = { { "cohesion_Jpm3", 0.0, 0.0, 1e9, 1e4 } },
};
