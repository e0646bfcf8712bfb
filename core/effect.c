#include "core/effect.h"

#include <assert.h>
#include <string.h>

static const char *const names[DIG_EFFECTS] = {
    [DIG_EFFECT_CYLINDER_FRICTION] = "cylinder_friction",
    [DIG_EFFECT_PRESSURE_OFFSET]   = "pressure_offset",
    [DIG_EFFECT_BUCKET_WEIGHT]     = "bucket_weight",
    [DIG_EFFECT_BUCKET_INERTIA]    = "bucket_inertia",
    [DIG_EFFECT_PAYLOAD]           = "payload",
    [DIG_EFFECT_LINKAGE_GEOMETRY]  = "linkage_geometry",
    [DIG_EFFECT_SENSOR_DELAY]      = "sensor_delay",
    [DIG_EFFECT_COHESION]          = "cohesion",
    [DIG_EFFECT_ADHESION]          = "adhesion",
    [DIG_EFFECT_POLYDISPERSITY]    = "polydispersity",
    [DIG_EFFECT_GRAIN_SHAPE]       = "grain_shape",
    [DIG_EFFECT_GROUND_SLOPE]      = "ground_slope",
    [DIG_EFFECT_LAYERING]          = "layering",
    [DIG_EFFECT_OBSTACLE]          = "obstacle",
    [DIG_EFFECT_COMPACTION]        = "compaction",
    [DIG_EFFECT_RATE_DEPENDENCE]   = "rate_dependence",
    [DIG_EFFECT_WEAR]              = "wear",
    [DIG_EFFECT_BUCKET_FRICTION]   = "bucket_friction",
    [DIG_EFFECT_UNLISTED]          = "unlisted",
};

const char *dig_effect_name(const enum dig_effect_id effect)
{
    assert(effect >= 0 && effect < DIG_EFFECTS);
    return names[effect];
}

int dig_effect_find(const char *const name)
{
    assert(name != NULL);
    for (int e = 0; e < DIG_EFFECTS; e++) {
        if (strcmp(names[e], name) == 0) {
            return e;
        }
    }
    return -1;
}

bool dig_effect_is_of_machine(const enum dig_effect_id effect)
{
    return effect <= DIG_EFFECT_SENSOR_DELAY;
}
