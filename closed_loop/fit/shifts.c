#include "closed_loop/fit/common_error.h"

#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How far off, in halves of the grid's width, the surface of a table with so many values of an axis
// may have a gravel's dig, and the table of effects, which holds few gravels, what an effect adds
// to it.
static const double of_place        = 0.05;
static const double of_values       = 4.0;
static const double of_effect_place = 0.3;

// How far off the table of effects may have a magnitude, as a share of it.
static const double of_magnitude = 0.1;

// What all trajectories share of that: of the gravel's place, where an effect is as large as the
// plain dig, and of a magnitude.
static const double common_place     = 0.15;
static const double common_magnitude = 0.1;

static bool is_templated(const enum dig_effect_id effect)
{
    const struct dig_effect *const known = dig_effect_of(effect);
    return known != NULL && known->templated;
}

bool dig_shifts_templated(const struct dig_hypothesis *const hypothesis)
{
    bool any = false;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        any = any || is_templated(hypothesis->effect[e]);
    }
    return any;
}

static void put(const double there[DIG_FEATURES], const double here[DIG_FEATURES],
                struct dig_shifts *const shifts)
{
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        shifts->of[shifts->shifts][f] = there[f] - here[f];
    }
    shifts->shifts++;
}

// Of a table with fewer values: what lies between two is guessed worse by the square of how far
// apart they are. Density is a scale, of which two values tell as much.
static double place_of(const struct dig_curve_set *const set, const size_t axis)
{
    const double values = (double)set->axis_count[axis];
    const bool   fewer  = axis != DIG_AXIS_DENSITY_kgpm3 && values > 1.0 && values < of_values;
    return fewer ? of_place * pow((of_values - 1.0) / (values - 1.0), 2.0) : of_place;
}

// Another gravel, towards the middle of the table; so many numbers are copied.
static struct dig_plain beside(const struct dig_soil *const soil, const size_t trajectory,
                               const size_t numbers, const double number[], const size_t axis,
                               const double by, double moved[DIG_HYPOTHESIS_NUMBERS])
{
    memcpy(moved, number, numbers * sizeof moved[0]);
    moved[axis] += number[axis] > 0.0 ? -by : by;
    return dig_plain_of(soil, trajectory, moved);
}

// What the beds of a group differ by as other gravels do, and the surface, a mean of beds, with
// them; the first shifts are those gravels.
static void put_as_gravels(const struct dig_batch *const batch, const size_t group,
                           const double place[], struct dig_shifts *const shifts)
{
    const struct dig_group *const of = &batch->group[group];

    const double mean =
        sqrt(1.0 / (double)of->digs + of->repeats +
             dig_response_surface_noise(batch->soil->surface, of->trajectory, place));
    for (size_t a = 0; a < DIG_AXES; a++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            shifts->as_gravels[a][f] = shifts->of[a][f] / of->amplitude[f / DIG_FEATURE_BINS];
        }
    }
    dig_scatter_as_gravels(batch->scatter, of->trajectory, shifts->as_gravels);
    for (size_t a = 0; a < DIG_AXES; a++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            shifts->as_gravels[a][f] *= mean * of->amplitude[f / DIG_FEATURE_BINS];
        }
    }
}

void dig_shifts_fill(const struct dig_batch *const batch, const size_t group,
                     const struct dig_hypothesis *const hypothesis, const double number[],
                     const struct dig_plain *const plain, const double added[DIG_FEATURES],
                     struct dig_shifts *const shifts)
{
    assert(batch != NULL && hypothesis != NULL && shifts != NULL);
    const size_t trajectory = batch->group[group].trajectory;
    const size_t numbers    = DIG_AT_U(hypothesis->effects); // that the hypothesis has
    const bool   templated  = dig_shifts_templated(hypothesis);
    double       moved[DIG_HYPOTHESIS_NUMBERS];
    double       there[DIG_FEATURES];
    shifts->shifts = 0;
    for (size_t a = 0; a < DIG_AXES; a++) {
        const struct dig_plain near = beside(batch->soil, trajectory, numbers, number, a,
                                             place_of(batch->soil->surface->set, a), moved);
        put(near.feature, plain->feature, shifts);
    }
    put_as_gravels(batch, group, number, shifts);
    for (size_t a = 0; templated && a < DIG_AXES; a++) {
        const struct dig_plain far =
            beside(batch->soil, trajectory, numbers, number, a, of_effect_place, moved);
        (void)dig_forward_added(batch, group, &far, hypothesis, moved, there);
        put(there, added, shifts);
    }
    for (size_t e = 0; e < hypothesis->effects; e++) {
        if (is_templated(hypothesis->effect[e])) {
            memcpy(moved, number, numbers * sizeof moved[0]);
            moved[DIG_AT_U(e)] *= 1.0 + of_magnitude;
            (void)dig_forward_added(batch, group, plain, hypothesis, moved, there);
            put(there, added, shifts);
        }
    }
}

// What the effects add to the digs over the plain ones, rms of all trajectories.
static double size_of_effects(const struct dig_batch *const      batch,
                              const struct dig_hypothesis *const hypothesis, const double number[])
{
    double more = 0.0;
    double all  = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_plain plain =
            dig_plain_of(batch->soil, batch->group[g].trajectory, number);
        double added[DIG_FEATURES];
        (void)dig_forward_added(batch, g, &plain, hypothesis, number, added);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const double amplitude = plain.amplitude[f / DIG_FEATURE_BINS];
            more += pow(added[f] / amplitude, 2.0);
            all += pow(plain.feature[f] / amplitude, 2.0);
        }
    }
    return sqrt(more / all);
}

void dig_shifts_common(const struct dig_batch *const      batch,
                       const struct dig_hypothesis *const hypothesis, const double number[],
                       double sigma[DIG_HYPOTHESIS_NUMBERS])
{
    assert(batch != NULL && hypothesis != NULL && sigma != NULL);
    memset(sigma, 0, DIG_HYPOTHESIS_NUMBERS * sizeof sigma[0]);
    if (!dig_shifts_templated(hypothesis)) {
        return;
    }
    const double size = size_of_effects(batch, hypothesis, number);
    for (size_t a = 0; a < DIG_AXES; a++) {
        sigma[a] = common_place * size;
    }
    for (size_t e = 0; e < hypothesis->effects; e++) {
        if (is_templated(hypothesis->effect[e])) {
            sigma[DIG_AT_U(e)] = common_magnitude * fabs(number[DIG_AT_U(e)]);
        }
    }
}
