// Below this height above the floor, rig scale, lies a layer of another gravel: a harder one, or
// where the number is negative a looser one below minus it. Tables are dug with one hard and one
// loose gravel; what another adds is taken for a multiple of what they add.

#include "estimator/effects/list.h"

#include <math.h>
#include <stdio.h>

enum { TOP, CONTRAST, PARAMETERS };

// What a person wants to know is how hard the layer resists.
static void say(const double value[], const struct dig_effect_ground *const ground,
                const size_t size, char text[])
{
    const double table = ground->layer[value[TOP] < 0.0 ? 1 : 0];
    (void)snprintf(
        text, size,
        "layer: its top %.3g m above the floor (rig scale), resists %.2g times as hard as the "
        "gravel on it",
        fabs(value[TOP]), fmax(1.0 + value[CONTRAST] * (table - 1.0), 0.0));
}

const struct dig_effect dig_effect_layering = {
    .id           = DIG_EFFECT_LAYERING,
    .summary      = "a layer of another gravel below, harder (+) or looser (-)",
    .templated    = true,
    .unlike_sides = true,
    .contrasted   = true,
    .parameters   = PARAMETERS,
    .parameter    = {
        [TOP]      = { "layer_m", 0.0, -10.0, 10.0, 0.03 },
        [CONTRAST] = { "contrast", 1.0, 0.25, 2.0, 0.5 },
    },
    .say          = say,
};
