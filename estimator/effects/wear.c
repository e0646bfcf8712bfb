// A tooth that blunts: resistance grows (or falls) from dig to dig. Reduced form, no bed needed:
// every channel grows by a share per dig done. digs is the number before counting starts: a
// campaign counts from its first dig, a daemon from the campaign's last.

#include "estimator/effects/list.h"

enum { SHARE, DIGS, PARAMETERS };

static void reduce(const double value[], const struct dig_effect_dig *const dig,
                   const struct dig_curve *const plain,
                   double                        delta[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    const double share = value[SHARE] * (value[DIGS] + (double)dig->order);
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            delta[c][k] += share * (double)plain->mean[c][k];
        }
    }
}

const struct dig_effect dig_effect_wear = {
    .id         = DIG_EFFECT_WEAR,
    .summary    = "a tooth that wears from dig to dig",
    .parts      = DIG_IN_SOIL | DIG_IN_LIFT,
    .parameters = PARAMETERS,
    .parameter  = {
        [SHARE] = { "share_per_dig", 0.0, -0.5, 1.0, 0.03 },
        [DIGS]  = { "digs", 0.0, 0.0, 1e6, 1.0 },
    },
    .reduce = reduce,
};
