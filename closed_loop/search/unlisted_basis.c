#include "closed_loop/search/unlisted_basis.h"

#include "closed_loop/recordings/regressors.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double least_pitch_rad = 1.0 * DIG_RAD_PER_DEG;
static const double least_pace      = 0.1; // relative

const char *dig_basis_name(const enum dig_basis basis)
{
    static const char *const name[DIG_BASES] = {
        "amplitude", "depth",       "depth squared", "fill", "path",  "speed",
        "turning",   "lifting out", "acceleration",  "pass", "pitch",
    };
    assert((size_t)basis < DIG_BASES);
    return name[basis];
}

// What of a batch's digs differs.
struct ranges {
    unsigned least_pass, most_pass;
    bool     pitch_known;
    double   least_pitch_rad, most_pitch_rad, least_pace, most_pace;
};

static struct ranges ranges_of(const struct dig_whitened_digs *const batch)
{
    const struct dig_measured *const first = &batch->measured[batch->dig[0].measured];

    struct ranges r = { first->pass,      first->pass, true,       first->pitch_rad,
                        first->pitch_rad, first->pace, first->pace };
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        r.least_pass                         = dig->pass < r.least_pass ? dig->pass : r.least_pass;
        r.most_pass                          = dig->pass > r.most_pass ? dig->pass : r.most_pass;
        r.pitch_known                        = r.pitch_known && dig->pitch_known;
        r.least_pitch_rad                    = fmin(r.least_pitch_rad, dig->pitch_rad);
        r.most_pitch_rad                     = fmax(r.most_pitch_rad, dig->pitch_rad);
        r.least_pace                         = fmin(r.least_pace, dig->pace);
        r.most_pace                          = fmax(r.most_pace, dig->pace);
    }
    return r;
}

size_t dig_basis_told(const struct dig_whitened_digs *const batch, enum dig_basis told[DIG_BASES])
{
    assert(batch != NULL && batch->digs > 0 && told != NULL);
    const struct ranges r = ranges_of(batch);
    size_t              n = 0;
    for (int b = 0; b < DIG_BASES; b++) {
        const bool is_told =
            b == DIG_BASIS_PASS ? r.most_pass > r.least_pass
            : b == DIG_BASIS_PITCH
                ? r.pitch_known && r.most_pitch_rad - r.least_pitch_rad >= least_pitch_rad
                : true;
        if (is_told) {
            told[n++] = (enum dig_basis)b;
        }
    }
    return n;
}

bool dig_basis_paces_differ(const struct dig_whitened_digs *const batch)
{
    assert(batch != NULL && batch->digs > 0);
    const struct ranges r = ranges_of(batch);
    return r.most_pace > (1.0 + least_pace) * r.least_pace;
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
