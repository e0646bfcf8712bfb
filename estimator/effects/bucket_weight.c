// The bucket is heavier or lighter than the file says, or its centre of mass lies elsewhere: in
// every dig.

#include "estimator/effects/list.h"

enum { MASS, MOMENT_X, MOMENT_Y, PARAMETERS };

static void correct(const double value[], struct dig_correction *const correction)
{
    correction->link[DIG_JOINT_BUCKET].mass_kg += value[MASS];
    correction->link[DIG_JOINT_BUCKET].moment_kgm.x += value[MOMENT_X];
    correction->link[DIG_JOINT_BUCKET].moment_kgm.y += value[MOMENT_Y];
}

const struct dig_effect dig_effect_bucket_weight = {
    .id         = DIG_EFFECT_BUCKET_WEIGHT,
    .summary    = "a bucket of another mass or another centre of mass",
    .parameters = PARAMETERS,
    .parameter  = {
        [MASS]     = { "mass_kg", 0.0, -1e4, 1e4, 50.0 },
        [MOMENT_X] = { "moment_x_kgm", 0.0, -1e4, 1e4, 20.0 },
        [MOMENT_Y] = { "moment_y_kgm", 0.0, -1e4, 1e4, 20.0 },
    },
    .wrong_share = 0.02, .wrong_step = 0.02,
    .correct = correct,
};
