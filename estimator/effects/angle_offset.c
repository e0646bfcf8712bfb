// The zero of an angle sensor is not where the file has it: the joint stands elsewhere, and with it
// every weight and lever beyond.

#include "estimator/effects/list.h"

static void correct(const double value[], struct dig_correction *const correction)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        correction->angle_rad[j] += value[j];
    }
}

const struct dig_effect dig_effect_angle_offset = {
    .id         = DIG_EFFECT_ANGLE_OFFSET,
    .summary    = "an angle sensor that reads too much or too little",
    .parameters = DIG_JOINTS,
    .parameter  = {
        [DIG_JOINT_BOOM]   = { "boom_rad", 0.0, -0.35, 0.35, 0.0175 },
        [DIG_JOINT_ARM]    = { "arm_rad", 0.0, -0.35, 0.35, 0.0175 },
        [DIG_JOINT_BUCKET] = { "bucket_rad", 0.0, -0.35, 0.35, 0.0175 },
    },
    .wrong_share = 0.02, .wrong_step = 0.02,
    .correct = correct,
};
