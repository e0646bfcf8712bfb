// A plain scene with one effect of the soil put into it at a magnitude: what a table of effects is
// computed of.

#ifndef DIG_OFFLINE_DEM_VARIANT_H
#define DIG_OFFLINE_DEM_VARIANT_H

#include "core/curve.h"
#include "core/effect.h"
#include "core/error.h"
#include "core/scene.h"

/// "J/m3", "deg", …: the unit of the effect's magnitude; NULL for an effect no DEM of ours holds.
const char *dig_variant_unit(enum dig_effect_id effect);

/// Writes the plain scene with the effect at this magnitude. gravel is the plain bed's, which a
/// layer is made relative to. DIG_EINVAL: an effect without a bed, or a magnitude out of range
/// (*error names both); then *varied is untouched. varied may not be scene.
DIG_MUST_CHECK enum dig_status dig_variant_make(const struct dig_scene  *scene,
                                                const struct dig_gravel *gravel,
                                                enum dig_effect_id effect, double magnitude,
                                                struct dig_scene *varied, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_VARIANT_H
