// A bucket smoother than the table's, as steel is than gravel: the share of friction and rolling
// friction between grains and bucket that is missing. A share is 0 for the table's own bucket in
// every gravel, and 1 for one without friction.

#include "estimator/effects/list.h"

#include <stdio.h>

// What a person knows of a bucket is its friction, not what it lacks.
static void say(const double value[], const struct dig_effect_ground *const ground,
                const size_t size, char text[])
{
    const double left = 1.0 - value[0];
    (void)snprintf(text, size,
                   "bucket: friction %.3g, rolling %.3g, where the table's has %.3g, %.3g",
                   left * ground->bucket_friction, left * ground->bucket_rolling,
                   ground->bucket_friction, ground->bucket_rolling);
}

const struct dig_effect dig_effect_bucket_friction = {
    .id         = DIG_EFFECT_BUCKET_FRICTION,
    .summary    = "a bucket smoother than the table's",
    .templated  = true,
    .parameters = 1,
    .parameter  = { { "bucket_smoothness", 0.0, 0.0, 1.0, 0.5 } },
    .say        = say,
};
