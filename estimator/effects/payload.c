// Soil that stayed in the bucket after the last dump and is carried through this dig. Acts like
// a weight of the bucket, but differs from dig to dig, and is zero in the first.

#include "estimator/effects/list.h"

enum { MASS, MOMENT_X, MOMENT_Y, PARAMETERS };

static void correct(const double value[], struct dig_correction *const correction)
{
    correction->payload.mass_kg += value[MASS];
    correction->payload.moment_kgm.x += value[MOMENT_X];
    correction->payload.moment_kgm.y += value[MOMENT_Y];
}

const struct dig_effect dig_effect_payload = {
    .id         = DIG_EFFECT_PAYLOAD,
    .summary    = "soil carried over from the dig before",
    .parameters = PARAMETERS,
    .parameter  = {
        [MASS]     = { "payload_kg", 0.0, -1e4, 1e4, 50.0 },
        [MOMENT_X] = { "payload_x_kgm", 0.0, -1e4, 1e4, 20.0 },
        [MOMENT_Y] = { "payload_y_kgm", 0.0, -1e4, 1e4, 20.0 },
    },
    .wrong_share = 0.08, .wrong_step = 0.35,
    .correct = correct,
};
