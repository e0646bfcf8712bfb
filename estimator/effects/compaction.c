// Ground that was dug before and lies denser: the more passes, the stiffer. The template's
// magnitude is the number of earlier digs a bed was made with; here it is the weight of one pass,
// 1 for the DEM's ground. Without a bed every force grows by a share for each earlier pass.

#include "estimator/effects/list.h"

enum { PASSES, SHARE, PARAMETERS };

static double factor(const double value[], const double share, const double speed)
{
    (void)speed;
    return value[SHARE] * share;
}

const struct dig_effect dig_effect_compaction = {
    .id         = DIG_EFFECT_COMPACTION,
    .summary    = "ground that resists more with every pass",
    .templated  = true,
    .whole = true,
    .by = DIG_BY_PASS,
    .parameters = PARAMETERS,
    .parameter  = {
        [PASSES] = { "passes", 0.0, 0.0, 20.0, 1.0 },
        [SHARE]  = { "share_per_pass", 0.0, -0.9, 5.0, 0.2 },
    },
    .factor = factor,
};
