// Fits templates to beds that hold an effect (formula: closed_loop/model/soil.h). Internal to
// soil.c.

#ifndef DIG_CLOSED_LOOP_MODEL_SOIL_FIT_H
#define DIG_CLOSED_LOOP_MODEL_SOIL_FIT_H

#include "closed_loop/model/scatter.h"
#include "closed_loop/model/soil.h"

/// Fits the templates and ranges of all effects that the set has beds of; soil->surface and absent
/// are given. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_soil_fit(struct dig_soil *soil, const struct dig_entry_set *set,
                                            const struct dig_scatter *scatter);

/// log(amplitude of My / density): how hard a gravel resists for its weight.
double dig_soil_strength(const struct dig_response_surface *surface, const double place[DIG_AXES],
                         const double amplitude[DIG_FORCE_CHANNELS]);

/// The template for effects of this u.
const struct dig_soil_template *dig_soil_template_at(const struct dig_soil *soil,
                                                     enum dig_effect_id effect, size_t trajectory,
                                                     double u);

#endif // DIG_CLOSED_LOOP_MODEL_SOIL_FIT_H
