// A bucket smoother than the table's, as steel is than gravel: the share of friction and rolling
// friction between grains and bucket that is missing. A share is 0 for the table's own bucket in
// every gravel, and 1 for one without friction.

#include "estimator/effects/list.h"

const struct dig_effect dig_effect_bucket_friction = {
    .id         = DIG_EFFECT_BUCKET_FRICTION,
    .summary    = "a bucket smoother than the table's",
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "bucket_smoothness", 0.0, 0.0, 1.0, 0.5 } },
};
