// The effects that a model of digging may lack, by the names results give them. What each does to
// a prediction stands in estimator/effects/; what it does to a bed, in offline_dem/dig/variant.h.

#ifndef DIG_CORE_EFFECT_H
#define DIG_CORE_EFFECT_H

#include <stdbool.h>

enum dig_effect_id {
    // Of the machine: they show in free air.
    DIG_EFFECT_CYLINDER_FRICTION,
    DIG_EFFECT_PRESSURE_OFFSET,
    DIG_EFFECT_BUCKET_WEIGHT,
    DIG_EFFECT_BUCKET_INERTIA,
    DIG_EFFECT_PAYLOAD,
    DIG_EFFECT_LINKAGE_GEOMETRY,
    DIG_EFFECT_SENSOR_DELAY,
    // Of the soil: they do not.
    DIG_EFFECT_COHESION,
    DIG_EFFECT_ADHESION,
    DIG_EFFECT_POLYDISPERSITY,
    DIG_EFFECT_GRAIN_SHAPE,
    DIG_EFFECT_GROUND_SLOPE,
    DIG_EFFECT_LAYERING,
    DIG_EFFECT_OBSTACLE,
    DIG_EFFECT_COMPACTION,
    DIG_EFFECT_RATE_DEPENDENCE,
    DIG_EFFECT_WEAR,
    DIG_EFFECT_BUCKET_FRICTION,
    // None of the above.
    DIG_EFFECT_UNLISTED,
    DIG_EFFECTS
};

/// "cylinder_friction", …, "unlisted": the names are fixed, people script against them.
const char *dig_effect_name(enum dig_effect_id effect);

/// The effect of that name, or -1.
int dig_effect_find(const char *name);

/// True for the effects of the machine.
bool dig_effect_is_of_machine(enum dig_effect_id effect);

#endif // DIG_CORE_EFFECT_H
