#include "estimator/approach/laid.h"

#include "estimator/approach/approach_route.h"
#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// A place on one path as one on another: equal lengths behind the corner.
struct shift {
    double step, offset; // place = step * k + offset
};

static struct shift shift_between(const struct dig_curve_set *const set, const size_t trajectory,
                                  const double depth, const double other_depth)
{
    const struct dig_route from    = dig_approach_route_deep(set, trajectory, depth);
    const struct dig_route to      = dig_approach_route_deep(set, trajectory, other_depth);
    const double           from_m  = from.at_m[from.corners - 1];
    const double           to_m    = to.at_m[to.corners - 1];
    const double           start_m = to.at_m[1] - from.at_m[1];
    return (struct shift){ from_m / to_m, start_m / to_m * (DIG_CURVE_POINTS - 1) };
}

void dig_laid_places(const struct dig_curve_set *const set, const size_t trajectory,
                     const double depth, const double other_depth,
                     double place[const DIG_CURVE_POINTS])
{
    assert(set != NULL && trajectory < set->trajectories && place != NULL);
    const struct shift shift = shift_between(set, trajectory, depth, other_depth);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        place[k] = shift.step * (double)k + shift.offset;
    }
}

static void lay(const double place[const DIG_CURVE_POINTS], float y[const DIG_CURVE_POINTS])
{
    float laid[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        laid[k] = place[k] < 0.0 ? 0.0F : (float)dig_curve_at(y, place[k]);
    }
    memcpy(y, laid, sizeof laid);
}

void dig_laid_curve(const double place[const DIG_CURVE_POINTS], struct dig_curve *const curve)
{
    assert(place != NULL && curve != NULL);
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        lay(place, curve->mean[c]);
        lay(place, curve->sd[c]);
    }
}

// The end of one path is the end of the other, whatever was rounded.
static double whole_at_end(const double progress)
{
    return fabs(progress - 1.0) < 1e-9 ? 1.0 : fmin(progress, 1.0);
}

// What was measured between the first and the last point measured; 0 beyond.
static void lay_measured(const double                        place[const DIG_CURVE_POINTS],
                         const struct dig_observation *const old,
                         const struct dig_observation *const new, double y[const DIG_CURVE_POINTS])
{
    const double first = ceil(old->first * (DIG_CURVE_POINTS - 1));
    const double last  = floor(old->last * (DIG_CURVE_POINTS - 1));
    double       laid[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        laid[k]               = 0.0;
        if (progress >= new->first && progress <= new->last) {
            const double at = fmin(fmax(place[k], first), last);
            const size_t i  = (size_t)fmin(at, DIG_CURVE_POINTS - 2);
            laid[k]         = y[i] + (at - (double)i) * (y[i + 1] - y[i]);
        }
    }
    memcpy(y, laid, sizeof laid);
}

static void lay_rubs(const double                        place[const DIG_CURVE_POINTS],
                     const struct dig_observation *const old,
                     const struct dig_observation *const new, float y[const DIG_CURVE_POINTS])
{
    double laid[DIG_CURVE_POINTS];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        laid[k] = (double)y[k];
    }
    lay_measured(place, old, new, laid);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        y[k] = (float)laid[k];
    }
}

void dig_laid_observation(const struct dig_curve_set *const set, const double depth,
                          struct dig_observation *const dig)
{
    assert(set != NULL && dig != NULL && dig->trajectory >= 0);
    const size_t                 t    = (size_t)dig->trajectory;
    const struct shift           back = shift_between(set, t, dig->approach.depth, depth);
    const struct dig_observation old  = *dig;
    const double                 ends = DIG_CURVE_POINTS - 1;
    double                       place[DIG_CURVE_POINTS];
    dig_laid_places(set, t, depth, old.approach.depth, place);
    dig->approach.depth = depth;
    dig->first          = fmax(back.step * old.first + back.offset / ends, 0.0);
    dig->last           = whole_at_end(back.step * old.last + back.offset / ends);
    lay_measured(place, &old, dig, dig->moment_Nm);
    lay_measured(place, &old, dig, dig->sigma_Nm);
    for (size_t j = 0; j < DIG_RUBS; j++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            lay_rubs(place, &old, dig, dig->rubs[j][c]);
        }
    }
    for (size_t c = 0; dig->forces && c + 1 < DIG_FORCE_CHANNELS; c++) {
        lay_measured(place, &old, dig, dig->force_N[c]);
        lay_measured(place, &old, dig, dig->force_sigma_N[c]);
    }
}
