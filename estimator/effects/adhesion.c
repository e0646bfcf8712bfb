// Grains stick to the bucket: the adhesion energy density of an SJKR contact, as a bed was dug
// with. Reduced form: what sticks is pulled out with the bucket, so the moment of the last phase is
// larger by a share of the whole curve's rms, growing over the phase as the load comes free of the
// ground.

#include "estimator/effects/list.h"

#include <math.h>

enum { ENERGY, LIFT_SHARE, PARAMETERS };

// The last part of the path, in which a dig lifts its bucket out.
static const double lift_from = 0.8;

static void reduce(const double value[], const struct dig_curve *const plain,
                   double delta[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    const double rms_Nm = sqrt(dig_curve_mean_square(plain->mean[DIG_CHANNEL_MY_Nm]));
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = ((double)k / (DIG_CURVE_POINTS - 1) - lift_from) / (1.0 - lift_from);
        delta[DIG_CHANNEL_MY_Nm][k] += value[LIFT_SHARE] * rms_Nm * fmax(at, 0.0);
    }
}

const struct dig_effect dig_effect_adhesion = {
    .id         = DIG_EFFECT_ADHESION,
    .summary    = "grains that stick to the bucket",
    .templated  = true,
    .over_stiffness = true,
    .parameters = PARAMETERS,
    .parameter  = {
        [ENERGY]     = { "adhesion_Jpm3", 0.0, 0.0, 1e9, 1e4 },
        [LIFT_SHARE] = { "lift_share", 0.0, 0.0, 5.0, 0.3 },
    },
    .reduce = reduce,
};
