#include "closed_loop/model/soil_fit.h"

#include "core/sort.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How far beyond the base gravels' strengths a template goes on changing.
static const double most_strength = 1.3;

// Magnitudes and strengths are numbers of a file or of a formula: the same, or further apart.
static const double same = 1e-6;

// The least magnitude, or strength, above one; INFINITY where there is none.
static double next(const size_t beds, const struct dig_soil_at at[], const bool is_u,
                   const double above)
{
    double least = INFINITY;
    for (size_t b = 0; b < beds; b++) {
        const double level = is_u ? at[b].u : at[b].strength;
        least              = level > above + same ? fmin(least, level) : least;
    }
    return least;
}

static bool is_of_two_gravels(const size_t beds, const struct dig_soil_at at[], const double u)
{
    double least = INFINITY;
    double most  = -INFINITY;
    for (size_t b = 0; b < beds; b++) {
        if (fabs(at[b].u - u) <= same) {
            least = fmin(least, at[b].strength);
            most  = fmax(most, at[b].strength);
        }
    }
    return most - least > same;
}

void dig_soil_terms_choose(const size_t beds, const struct dig_soil_at at[],
                           struct dig_soil_template *const template)
{
    assert(beds > 0 && at != NULL && template != NULL);
    const double least     = next(beds, at, false, -INFINITY);
    double       most      = least;
    double       s         = least;
    size_t       strengths = 0;
    while (isfinite(s)) {
        most = s;
        s    = next(beds, at, false, s);
        strengths++;
    }
    template->powers = strengths < DIG_SOIL_POWERS ? strengths : DIG_SOIL_POWERS;
    template->centre = 0.5 * (least + most);
    template->half   = fmax(0.5 * (most - least), 1e-3);

    // A bend at a magnitude that one gravel alone was dug at would bend all others as it does that.
    double knot[DIG_SOIL_KNOTS] = { 0.0 };
    size_t knots                = 1;
    size_t magnitudes           = 0;
    double u                    = next(beds, at, true, -INFINITY);
    while (isfinite(u)) {
        magnitudes++;
        if (knots < DIG_SOIL_KNOTS && is_of_two_gravels(beds, at, u)) {
            knot[knots++] = u;
        }
        u = next(beds, at, true, u);
    }
    dig_sort(knots, knot);
    template->knots = knots > 2 ? knots : 0;
    memcpy(template->knot, knot, template->knots * sizeof *knot);
    template->shapes = (magnitudes > 1 ? 2 : 1) + template->knots;
    template->terms  = template->shapes *template->powers;
}

// The line, the parabola and the hats at u; the hat of "absent" is left out.
static void shapes_of(const struct dig_soil_template *const template, const double u,
                      double shape[DIG_SOIL_SHAPES])
{
    const double *const knot = template->knot;
    memset(shape, 0, DIG_SOIL_SHAPES * sizeof *shape);
    shape[0] = u;
    shape[1] = u * u;
    if (template->knots == 0) {
        return;
    }
    size_t i = 0;
    while (i + 2 < template->knots && knot[i + 1] <= u) {
        i++;
    }
    const double f = (u - knot[i]) / (knot[i + 1] - knot[i]);
    shape[2 + i]   = fabs(knot[i]) > 0.0 ? 1.0 - f : 0.0;
    shape[3 + i]   = fabs(knot[i + 1]) > 0.0 ? f : 0.0;
}

void dig_soil_terms(const struct dig_soil_template *const template,
                    const struct dig_soil_at *const at, double term[DIG_SOIL_TERMS])
{
    const double s = fmin(fmax((at->strength - template->centre) / template->half, -most_strength),
                          most_strength);
    double       shape[DIG_SOIL_SHAPES];
    shapes_of(template, at->u, shape);
    for (size_t j = 0; j < template->terms; j += template->powers) {
        double power = 1.0;
        for (size_t p = 0; p < template->powers; p++) {
            term[j + p] = shape[j / template->powers] * power;
            power *= s;
        }
    }
}
