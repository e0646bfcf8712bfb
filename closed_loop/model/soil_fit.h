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

/// Where a bed is: how much of the effect, and how hard its gravel resists for its weight.
struct dig_soil_at {
    double u, strength;
};

/// Which terms such beds bear: powers, shapes, knots, terms, centre and half of the template. The
/// first DIG_SOIL_KNOTS - 1 magnitudes that may have a hat have one.
void dig_soil_terms_choose(size_t beds, const struct dig_soil_at at[],
                           struct dig_soil_template *template);

/// What a template's terms are multiplied by there. All are 0 at u = 0.
void dig_soil_terms(const struct dig_soil_template *template, const struct dig_soil_at *at,
                    double term[DIG_SOIL_TERMS]);

#endif // DIG_CLOSED_LOOP_MODEL_SOIL_FIT_H
