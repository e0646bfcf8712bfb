#include "closed_loop/search/unlisted_basis.h"

#include "closed_loop/recordings/regressors.h"

#include <assert.h>
#include <math.h>
#include <string.h>

const char *dig_basis_name(const enum dig_basis basis)
{
    static const char *const name[DIG_BASES] = {
        "amplitude", "depth",       "depth squared", "fill", "path",  "speed",
        "turning",   "lifting out", "acceleration",  "pass", "pitch",
    };
    assert((size_t)basis < DIG_BASES);
    return name[basis];
}

void dig_basis_along(const struct dig_curve_set *const set, const struct dig_measured *const dig,
                     double value[DIG_BASES][DIG_FEATURE_BINS])
{
    assert(set != NULL && dig != NULL && value != NULL);
    const struct dig_trajectory *const t          = &set->trajectory[dig->trajectory];
    const double                       tooth_m    = set->tooth_m;
    const double                       duration_s = dig_trajectory_duration_s(t);
    const double                       whole_m    = dig_trajectory_path_m(t, tooth_m, duration_s);
    double                             state[DIG_REGRESSORS][DIG_CURVE_POINTS];
    dig_regressors_along(set, dig, state);
    memset(value, 0, DIG_BASES * sizeof value[0]);
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        size_t from;
        size_t to;
        dig_feature_bin(b, &from, &to);
        for (size_t k = from; k < to; k++) {
            const double progress = state[DIG_REGRESSOR_PATH][k];
            const double time_s   = dig_trajectory_time_s(t, tooth_m, progress);
            const double depth    = state[DIG_STATE_DEPTH_m][k] / tooth_m;

            const struct dig_phase *const phase = &t->phase[dig_trajectory_phase(t, time_s)];
            const double                  rate_mps =
                hypot(phase->vx_mps, phase->vz_mps) + tooth_m * fabs(phase->omega_radps);
            const double here[DIG_BASES] = {
                [DIG_BASIS_AMPLITUDE]     = 1.0,
                [DIG_BASIS_DEPTH]         = depth,
                [DIG_BASIS_DEPTH_SQUARED] = depth * depth,
                [DIG_BASIS_FILL]          = state[DIG_STATE_FILL_m2][k] / (tooth_m * tooth_m),
                [DIG_BASIS_PATH]          = progress,
                [DIG_BASIS_SPEED]         = rate_mps * duration_s / whole_m * dig->pace,
                [DIG_BASIS_TURNING]       = tooth_m * phase->omega_radps / rate_mps,
                [DIG_BASIS_LIFTING]       = phase->vz_mps > 0.5 * rate_mps ? 1.0 : 0.0,
                [DIG_BASIS_ACCELERATION] =
                    state[DIG_STATE_ACCELERATION_mps2][k] * duration_s * duration_s / whole_m,
                [DIG_BASIS_PASS]  = state[DIG_REGRESSOR_PASS][k] - 1.0,
                [DIG_BASIS_PITCH] = dig->pitch_known ? dig->pitch_rad : 0.0,
            };
            for (size_t f = 0; f < DIG_BASES; f++) {
                value[f][b] += here[f] / (double)(to - from);
            }
        }
    }
}
