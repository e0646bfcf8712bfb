// What ground may do that a DEM of ours was not asked for, put into a force recording of a plain
// dig by formulas of the bench's own.

#ifndef DIG_TESTS_BLIND_SOIL_H
#define DIG_TESTS_BLIND_SOIL_H

#include "core/recording.h"
#include "tests/blind/draw.h"

#include <stddef.h>

enum blind_soil_effect {
    // Of the catalogue, by its names.
    BLIND_RATE_DEPENDENCE, // a power of the tooth's speed
    BLIND_WEAR,            // more with every dig
    BLIND_SOIL_LISTED,
    // Outside of it.
    BLIND_WATER_TABLE = BLIND_SOIL_LISTED, // deep ground is buoyant
    BLIND_ROOT_MAT,                        // a skin that tears
    BLIND_RIPPLES,                         // hard and soft bands across the path
    BLIND_WEATHER,                         // every other dig is on wet ground
    BLIND_PILE_UP,                         // resistance grows with the way dragged
    BLIND_SOIL_EFFECTS
};

const char *blind_soil_effect_name(enum blind_soil_effect effect);

struct blind_ground {
    enum blind_soil_effect effect;
    double                 p[4]; // size, then what the effect's code says
};

/// strength 0, 1, 2: faint, plain, strong.
struct blind_ground blind_ground_draw(struct blind_draw *draw, enum blind_soil_effect effect,
                                      int strength);

/// Changes forces and moment of the order-th dig of a campaign, in the rig's scene.
void blind_ground_apply(const struct blind_ground *ground, size_t order,
                        struct dig_recording *recording);

/// The same dig at pace times the speed, as if the ground did not care.
void blind_hurry(double pace, struct dig_recording *recording);

#endif // DIG_TESTS_BLIND_SOIL_H
