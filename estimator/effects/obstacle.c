// A rock lies half buried in the bucket's way: its diameter, rig scale.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_obstacle = {
    .id         = DIG_EFFECT_OBSTACLE,
    .summary    = "a rock in the way",
    .parts      = DIG_IN_SOIL | DIG_IN_LIFT,
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "diameter_m", 0.0, 0.0, 10.0, 0.03 } },
};
