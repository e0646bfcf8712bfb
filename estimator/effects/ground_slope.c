// The ground rises (or falls, below 0) along the dig, about where the bucket first touches it.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_ground_slope = {
    .id         = DIG_EFFECT_GROUND_SLOPE,
    .summary    = "ground that rises or falls along the dig",
    .templated  = true,
    .mirrored   = true,
    .parameters = 1,
    .parameter  = { { "slope_deg", 0.0, -45.0, 45.0, 10.0 } },
};
