// The effects that a model of digging may lack: the list. What one is and does stands in its file,
// estimator/effects/NAME.c; what it does to a bed, in offline_dem/dig/variant.h.

#ifndef DIG_CORE_EFFECT_H
#define DIG_CORE_EFFECT_H

#include "core/curve.h"

#include <stdbool.h>

// Id and name, a line each; the names are fixed, people script against them. Those of the machine
// show in free air, those of the soil do not.
// clang-format off
#define DIG_EFFECTS_OF_MACHINE(effect)           \
    effect(CYLINDER_FRICTION, cylinder_friction) \
    effect(PRESSURE_OFFSET, pressure_offset)     \
    effect(BUCKET_WEIGHT, bucket_weight)         \
    effect(BUCKET_INERTIA, bucket_inertia)       \
    effect(PAYLOAD, payload)                     \
    effect(LINKAGE_GEOMETRY, linkage_geometry)   \
    effect(ANGLE_OFFSET, angle_offset)           \
    effect(SENSOR_DELAY, sensor_delay)
#define DIG_EFFECTS_OF_SOIL(effect)              \
    effect(COHESION, cohesion)                   \
    effect(ADHESION, adhesion)                   \
    effect(POLYDISPERSITY, polydispersity)       \
    effect(GRAIN_SHAPE, grain_shape)             \
    effect(GROUND_SLOPE, ground_slope)           \
    effect(LAYERING, layering)                   \
    effect(OBSTACLE, obstacle)                   \
    effect(COMPACTION, compaction)               \
    effect(RATE_DEPENDENCE, rate_dependence)     \
    effect(WEAR, wear)                           \
    effect(BUCKET_FRICTION, bucket_friction)

#define DIG_EFFECT_ID(id, name) DIG_EFFECT_##id,
enum dig_effect_id {
    DIG_EFFECTS_OF_MACHINE(DIG_EFFECT_ID)
    DIG_EFFECTS_OF_SOIL(DIG_EFFECT_ID)
    DIG_EFFECT_UNLISTED, // none of the above
    DIG_EFFECTS
};
#undef DIG_EFFECT_ID

#define DIG_EFFECT_COUNTED(id, name) DIG_EFFECT_COUNTED_##id,
enum { DIG_EFFECTS_OF_MACHINE(DIG_EFFECT_COUNTED) DIG_MACHINE_EFFECTS };
#undef DIG_EFFECT_COUNTED
// clang-format on

/// "cylinder_friction", …, "unlisted".
const char *dig_effect_name(enum dig_effect_id effect);

/// The effect of that name, or -1.
int dig_effect_find(const char *name);

/// Its place among the first n of a list; n where it is not among them.
size_t dig_effect_place(size_t n, const enum dig_effect_id list[], enum dig_effect_id effect);

/// True for the effects of the machine.
bool dig_effect_is_of_machine(enum dig_effect_id effect);

/// The gravel that the layers of tables of effects are of: a hard one, or a loose one.
struct dig_gravel dig_effect_layer_gravel(bool loose);

#endif // DIG_CORE_EFFECT_H
