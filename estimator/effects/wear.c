// A tooth that blunts: resistance grows (or falls) from dig to dig. No bed needed: every
// force grows by a share per dig done. digs is the number before counting starts: a
// campaign counts from its first dig, a daemon from the campaign's last.

#include "estimator/effects/list.h"

enum { SHARE, DIGS, PARAMETERS };

static double factor(const double value[], const double share, const double speed)
{
    (void)speed;
    return value[SHARE] * (value[DIGS] + share);
}

const struct dig_effect dig_effect_wear = {
    .id         = DIG_EFFECT_WEAR,
    .summary    = "a tooth that wears from dig to dig",
    .parameters = PARAMETERS,
    .parameter  = {
        [SHARE] = { "share_per_dig", 0.0, -0.5, 1.0, 0.03 },
        [DIGS]  = { "digs", 0.0, 0.0, 1e6, 1.0 },
    },
    .by = DIG_BY_ORDER,
    .digs_done = DIGS,
    .reach = 0.15,
    .factor = factor,
};
