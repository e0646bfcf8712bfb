// The terms that a template of the soil is a sum of: closed_loop/model/soil.h has the formula.
// Internal to soil.c.

#ifndef DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H
#define DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H

#include "closed_loop/model/soil.h"

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

#endif // DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H
