// The terms that a template of the soil is a sum of: closed_loop/model/soil.h has the formula.
// Internal to soil.c.

#ifndef DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H
#define DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H

#include "closed_loop/model/soil.h"

/// Which terms beds at these u and strengths bear: powers, shapes, knots, terms, centre and half of
/// the template. The first DIG_SOIL_KNOTS - 1 magnitudes that may have a hat have one. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_soil_terms_choose(size_t beds, const double u[],
                                                     const double strength[],
                                                     struct dig_soil_template *template);

/// What a template's terms are multiplied by at u and strength. All are 0 at u = 0.
void dig_soil_terms(const struct dig_soil_template *template, double u, double strength,
                    double term[DIG_SOIL_TERMS]);

#endif // DIG_CLOSED_LOOP_MODEL_SOIL_TERMS_H
