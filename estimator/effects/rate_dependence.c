// Ground that resists more when it is dug faster. Reduced form, no bed needed: every channel grows
// as pace^exponent, pace 1 being the table's own; so it shows only over digs of different pace.

#include "estimator/effects/list.h"

#include <math.h>

static void reduce(const double value[], const struct dig_effect_dig *const dig,
                   const struct dig_curve *const plain,
                   double                        delta[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    const double share = pow(dig->pace, value[0]) - 1.0;
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            delta[c][k] += share * (double)plain->mean[c][k];
        }
    }
}

const struct dig_effect dig_effect_rate_dependence = {
    .id         = DIG_EFFECT_RATE_DEPENDENCE,
    .summary    = "ground that resists more when dug faster",
    .parts      = DIG_IN_SOIL | DIG_IN_LIFT,
    .parameters = 1,
    .parameter  = { { "exponent", 0.0, -2.0, 2.0, 0.3 } },
    .reduce     = reduce,
};
