// The bucket has more inertia than the file says: shows where its turning accelerates.

#include "estimator/effects/list.h"

static void correct(const double value[], struct dig_correction *const correction)
{
    correction->link[DIG_JOINT_BUCKET].inertia_kgm2 += value[0];
}

const struct dig_effect dig_effect_bucket_inertia = {
    .id          = DIG_EFFECT_BUCKET_INERTIA,
    .summary     = "a bucket with another moment of inertia",
    .parameters  = 1,
    .parameter   = { { "inertia_kgm2", 0.0, -1e4, 1e5, 100.0 } },
    .wrong_share = 0.08,
    .wrong_step  = 0.35,
    .correct     = correct,
};
