#include "estimator/match/entry_scatter.h"

#include "core/chance.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>

const double dig_entry_scatter_between[DIG_FORCE_CHANNELS][DIG_FORCE_CHANNELS] = {
    { 1.0, DIG_ENTRY_SCATTER_MY_FX, DIG_ENTRY_SCATTER_MY_FZ },
    { DIG_ENTRY_SCATTER_MY_FX, 1.0, DIG_ENTRY_SCATTER_FX_FZ },
    { DIG_ENTRY_SCATTER_MY_FZ, DIG_ENTRY_SCATTER_FX_FZ, 1.0 },
};

// Weights of the knots around each point; their squares sum to 1.
void dig_entry_scatter_make(const struct dig_trajectory *const trajectory, const double tooth_m,
                            struct dig_entry_scatter *const scatter)
{
    assert(trajectory != NULL && scatter != NULL);
    const double whole_m =
        dig_trajectory_path_m(trajectory, tooth_m, dig_trajectory_duration_s(trajectory));
    const double own_m = DIG_ENTRY_SCATTER_WIDTH * tooth_m / sqrt(2.0 * DIG_PI);
    // In points. Errors of a path so long that they change within a point are independent.
    const double spacing = fmax(own_m / whole_m * (DIG_CURVE_POINTS - 1), 1.0);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at =
            (double)k / spacing; // knot 0 lies DIG_ENTRY_SCATTER_REACH before the path
        double norm2      = 0.0;
        scatter->first[k] = (size_t)at;
        for (size_t i = 0; i < DIG_ENTRY_SCATTER_WIDE; i++) {
            const double off    = (double)(scatter->first[k] + i) - DIG_ENTRY_SCATTER_REACH - at;
            scatter->felt[k][i] = exp(-off * off);
            norm2 += scatter->felt[k][i] * scatter->felt[k][i];
        }
        for (size_t i = 0; i < DIG_ENTRY_SCATTER_WIDE; i++) {
            scatter->felt[k][i] /= sqrt(norm2);
        }
    }
    scatter->knots = scatter->first[DIG_CURVE_POINTS - 1] + DIG_ENTRY_SCATTER_WIDE;
    assert(scatter->knots <= DIG_ENTRY_SCATTER_KNOTS);
}

void dig_entry_scatter_draw(const struct dig_entry_scatter *const scatter, uint64_t *const seed,
                            double error[const DIG_CURVE_POINTS])
{
    assert(scatter != NULL && seed != NULL && error != NULL);
    double       knot[DIG_ENTRY_SCATTER_KNOTS];
    const double whole = sqrt(DIG_ENTRY_SCATTER_SHARED) * dig_chance_normal(seed);
    for (size_t j = 0; j < scatter->knots; j++) {
        knot[j] = sqrt(1.0 - DIG_ENTRY_SCATTER_SHARED) * dig_chance_normal(seed);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        double sum = whole;
        for (size_t i = 0; i < DIG_ENTRY_SCATTER_WIDE; i++) {
            sum += scatter->felt[k][i] * knot[scatter->first[k] + i];
        }
        error[k] = sum;
    }
}

static double of_channels(const double v[const DIG_FORCE_CHANNELS])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] +
           2.0 * (DIG_ENTRY_SCATTER_MY_FX * v[0] * v[1] + DIG_ENTRY_SCATTER_MY_FZ * v[0] * v[2] +
                  DIG_ENTRY_SCATTER_FX_FZ * v[1] * v[2]);
}

double dig_entry_scatter_variance(const struct dig_entry_scatter *const scatter,
                                  const struct dig_channels *const      weight)
{
    assert(scatter != NULL && weight != NULL);
    double knot[DIG_ENTRY_SCATTER_KNOTS][DIG_FORCE_CHANNELS] = { { 0.0 } };
    double whole[DIG_FORCE_CHANNELS]                         = { 0.0 };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            whole[c] += weight->of[c][k];
            for (size_t i = 0; i < DIG_ENTRY_SCATTER_WIDE; i++) {
                knot[scatter->first[k] + i][c] += scatter->felt[k][i] * weight->of[c][k];
            }
        }
    }
    double own = 0.0;
    for (size_t j = 0; j < scatter->knots; j++) {
        own += of_channels(knot[j]);
    }
    return (1.0 - DIG_ENTRY_SCATTER_SHARED) * own + DIG_ENTRY_SCATTER_SHARED * of_channels(whole);
}
