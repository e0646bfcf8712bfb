// Grains of three sizes: the ratio of the largest diameter to the smallest.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_polydispersity = {
    .id         = DIG_EFFECT_POLYDISPERSITY,
    .summary    = "grains of several sizes",
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "size_ratio", 1.0, 1.0, 10.0, 0.5 } },
};
