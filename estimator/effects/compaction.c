// Ground that was dug before and lies denser: the more passes, the stiffer. The template's
// magnitude is the number of earlier digs a bed was made with; here it is the weight of one pass,
// 1 for the DEM's ground. Reduced form: every channel grows by a share for each earlier
// pass.

#include "estimator/effects/list.h"

enum { PASSES, SHARE, PARAMETERS };

static double earlier(const struct dig_effect_dig *const dig)
{
    return dig->pass > 1 ? (double)(dig->pass - 1) : 0.0;
}

static double magnitude(const double value[], const struct dig_effect_dig *const dig)
{
    return value[PASSES] * earlier(dig);
}

static void reduce(const double value[], const struct dig_effect_dig *const dig,
                   const struct dig_curve *const plain,
                   double                        delta[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            delta[c][k] += value[SHARE] * earlier(dig) * (double)plain->mean[c][k];
        }
    }
}

const struct dig_effect dig_effect_compaction = {
    .id         = DIG_EFFECT_COMPACTION,
    .summary    = "ground that resists more with every pass",
    .parts      = DIG_IN_SOIL | DIG_IN_LIFT,
    .templated  = true,
    .parameters = PARAMETERS,
    .parameter  = {
        [PASSES] = { "passes", 0.0, 0.0, 20.0, 1.0 },
        [SHARE]  = { "share_per_pass", 0.0, -0.9, 5.0, 0.2 },
    },
    .reduce    = reduce,
    .magnitude = magnitude,
};
