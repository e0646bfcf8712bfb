// The effects, one a file of its name. For effect.c alone.

#ifndef DIG_ESTIMATOR_EFFECTS_LIST_H
#define DIG_ESTIMATOR_EFFECTS_LIST_H

#include "estimator/effects/effect.h"

extern const struct dig_effect dig_effect_cylinder_friction, dig_effect_pressure_offset,
    dig_effect_bucket_weight, dig_effect_bucket_inertia, dig_effect_payload,
    dig_effect_linkage_geometry, dig_effect_sensor_delay, dig_effect_cohesion, dig_effect_adhesion,
    dig_effect_polydispersity, dig_effect_grain_shape, dig_effect_ground_slope, dig_effect_layering,
    dig_effect_obstacle, dig_effect_compaction, dig_effect_rate_dependence, dig_effect_wear,
    dig_effect_bucket_friction;

#endif // DIG_ESTIMATOR_EFFECTS_LIST_H
