#include "closed_loop/model/soil_terms.h"

#include "core/sort.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// How far beyond the base gravels' strengths a template goes on changing.
static const double most_strength = 1.3;

// Magnitudes and strengths are numbers of a file or of a formula: the same, or far apart.
static bool is_same(const double a, const double b)
{
    return fabs(a - b) <= 1e-6;
}

// Sorts level[] and drops those that are the same; how many stay.
static size_t keep_unlike(const size_t levels, double level[])
{
    size_t kept = 0;
    dig_sort(levels, level);
    for (size_t i = 0; i < levels; i++) {
        if (kept == 0 || !is_same(level[i], level[kept - 1])) {
            level[kept++] = level[i];
        }
    }
    return kept;
}

static bool is_of_two_gravels(const size_t beds, const double u[], const double strength[],
                              const double magnitude)
{
    size_t one = beds;
    for (size_t b = 0; b < beds; b++) {
        if (is_same(u[b], magnitude)) {
            if (one < beds && !is_same(strength[b], strength[one])) {
                return true;
            }
            one = b;
        }
    }
    return false;
}

// A bend at a magnitude that one gravel alone was dug at would bend all others as it does that one.
static void choose_knots(const size_t beds, const double u[], const double strength[],
                         const size_t magnitudes, const double magnitude[],
                         struct dig_soil_template *const template)
{
    double knot[DIG_SOIL_KNOTS] = { 0.0 };
    size_t knots                = 1;
    for (size_t i = 0; i < magnitudes; i++) {
        if (knots < DIG_SOIL_KNOTS && is_of_two_gravels(beds, u, strength, magnitude[i])) {
            knot[knots++] = magnitude[i];
        }
    }
    dig_sort(knots, knot);
    template->knots = knots > 2 ? knots : 0;
    memcpy(template->knot, knot, template->knots * sizeof *knot);
}

enum dig_status dig_soil_terms_choose(const size_t beds, const double u[], const double strength[],
                                      struct dig_soil_template *const template)
{
    assert(beds > 0 && u != NULL && strength != NULL && template != NULL);
    double *const level = calloc(beds, sizeof *level);
    if (level == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(level, strength, beds * sizeof *level);
    const size_t strengths = keep_unlike(beds, level);
    template->powers       = strengths < DIG_SOIL_POWERS ? strengths : DIG_SOIL_POWERS;
    template->centre       = 0.5 * (level[0] + level[strengths - 1]);
    template->half         = fmax(0.5 * (level[strengths - 1] - level[0]), 1e-3);

    memcpy(level, u, beds * sizeof *level);
    const size_t magnitudes = keep_unlike(beds, level);
    choose_knots(beds, u, strength, magnitudes, level, template);
    template->shapes = (magnitudes > 1 ? 2 : 1) + template->knots;
    template->terms  = template->shapes *template->powers;
    free(level);
    return DIG_OK;
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

void dig_soil_terms(const struct dig_soil_template *const template, const double u,
                    const double strength, double term[DIG_SOIL_TERMS])
{
    const double s =
        fmin(fmax((strength - template->centre) / template->half, -most_strength), most_strength);
    double shape[DIG_SOIL_SHAPES];
    shapes_of(template, u, shape);
    for (size_t j = 0; j < template->terms; j += template->powers) {
        double power = 1.0;
        for (size_t p = 0; p < template->powers; p++) {
            term[j + p] = shape[j / template->powers] * power;
            power *= s;
        }
    }
}
