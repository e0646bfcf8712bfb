// The pressures of a sample are older than its angles (or, below 0, younger), or the forces of a
// recording than its pose, as those of a filtered load cell are.

#include "estimator/effects/list.h"

static void correct(const double value[], struct dig_correction *const correction)
{
    correction->delay_s += value[0];
}

const struct dig_effect dig_effect_sensor_delay = {
    .id          = DIG_EFFECT_SENSOR_DELAY,
    .summary     = "forces or pressures that are older than the pose beside them",
    .parameters  = 1,
    .parameter   = { { "delay_s", 0.0, -0.5, 0.5, 0.1 } },
    .wrong_share = 0.08,
    .wrong_step  = 0.35,
    .correct     = correct,
    .reach       = 0.5,
};
