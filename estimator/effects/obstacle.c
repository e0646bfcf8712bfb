// A rock half buried in the bucket's path: its diameter, rig scale. One that lies elsewhere or
// deeper has no template: ahead_m is its distance from the table's rock, and the addition is the
// model's measured residual. Rocks have all shapes: what one of triangles in another code adds to
// Fz differs by a third from what a sphere does (tests/offline_dem/test_ensemble.c).

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_obstacle = {
    .id         = DIG_EFFECT_OBSTACLE,
    .summary    = "a rock in the way",
    .templated  = true,
    .likeness   = 0.3,
    .parameters = 2,
    .parameter  = { { "diameter_m", 0.0, 0.0, 10.0, 0.03 }, { "ahead_m", 0.0, -10.0, 10.0, 0.05 } },
};
