#include "closed_loop/model/gravel_directions.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double step = 0.01; // of half the grid's width

// What is left of a squared length below which a direction is a sum of others.
static const double none_left = 1e-12;

void dig_gravel_directions_whiten(const double lower[DIG_FEATURES][DIG_FEATURES],
                                  double       change[DIG_AXES][DIG_FEATURES])
{
    assert(lower != NULL && change != NULL);
    for (size_t a = 0; a < DIG_AXES; a++) {
        double *const one = change[a];
        dig_lower_solve(DIG_FEATURES, &lower[0][0], one);
        const double whole = dig_product(DIG_FEATURES, one, one);
        for (size_t b = 0; b < a; b++) {
            const double along = dig_product(DIG_FEATURES, one, change[b]);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                one[f] -= along * change[b][f];
            }
        }
        const double left  = dig_product(DIG_FEATURES, one, one);
        const double scale = left > none_left * whole ? 1.0 / sqrt(left) : 0.0;
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            one[f] *= scale;
        }
    }
}

// A step along each axis, towards the middle of the table.
static void changes_at(const struct dig_response_surface *const surface, const size_t trajectory,
                       const double place[DIG_AXES], double change[DIG_AXES][DIG_FEATURES])
{
    double here[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    double moved[DIG_FORCE_CHANNELS]; // amplitude
    dig_response_surface_features(surface, trajectory, place, here, amplitude);
    for (size_t a = 0; a < DIG_AXES; a++) {
        double there[DIG_AXES];
        memcpy(there, place, sizeof there);
        there[a] += place[a] > 0.0 ? -step : step;
        dig_response_surface_features(surface, trajectory, there, change[a], moved);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            change[a][f] = (change[a][f] - here[f]) / amplitude[f / DIG_FEATURE_BINS];
        }
    }
}

double dig_gravel_directions_variance(const struct dig_response_surface *const surface,
                                      const size_t trajectory, const double place[DIG_AXES],
                                      const double lower[DIG_FEATURES][DIG_FEATURES],
                                      const double residual[DIG_FEATURES])
{
    double u[DIG_AXES][DIG_FEATURES];
    double y[DIG_FEATURES];
    double squares    = 0.0;
    double directions = 0.0;
    memcpy(y, residual, sizeof y);
    dig_lower_solve(DIG_FEATURES, &lower[0][0], y);
    changes_at(surface, trajectory, place, u);
    dig_gravel_directions_whiten(lower, u);
    for (size_t a = 0; a < DIG_AXES; a++) {
        squares += pow(dig_product(DIG_FEATURES, u[a], y), 2.0);
        directions += dig_product(DIG_FEATURES, u[a], u[a]);
    }
    return directions > 0.0 ? squares / directions : 1.0;
}
