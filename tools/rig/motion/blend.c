#include "tools/rig/motion/blend.h"

#include <math.h>
#include <stdlib.h>

// Centred moving average over 2 half + 1 values, the first and last value held beyond the ends.
static void average(const size_t n, const size_t half, const double in[], double out[])
{
    const double width = (double)(2 * half + 1);
    double       total = 0.0;
    for (size_t k = 0; k < 2 * half + 1; k++) {
        total += in[k < half ? 0 : (k - half < n ? k - half : n - 1)];
    }
    for (size_t i = 0; i < n; i++) {
        out[i] = total / width;
        // Replace what leaves on the left by what enters on the right.
        const size_t leaves = i < half ? 0 : i - half;
        const size_t enters = i + half + 1 < n ? i + half + 1 : n - 1;
        total += in[enters] - in[leaves];
    }
}

// One coordinate: smoothed three times over, which makes its acceleration continuous.
static void smooth(const size_t n, const size_t half, double value[], double spare[])
{
    // About a middle value, or the running sum would carry the offset's round-off along.
    const double middle = value[n / 2];
    for (size_t i = 0; i < n; i++) {
        value[i] -= middle;
    }
    average(n, half, value, spare);
    average(n, half, spare, value);
    average(n, half, value, spare);
    for (size_t i = 0; i < n; i++) {
        value[i] = spare[i] + middle;
    }
}

bool dig_rig_blend(struct dig_rig_path *const path)
{
    const size_t  n     = path->frames;
    const size_t  half  = (size_t)lround(DIG_RIG_BLEND_s / 6.0 / DIG_RIG_STEP_s);
    double *const block = malloc(4 * n * sizeof block[0]);
    if (block == NULL) {
        return false;
    }
    double *const X     = block;
    double *const Z     = block + n;
    double *const phi   = block + 2 * n;
    double *const spare = block + 3 * n;
    for (size_t i = 0; i < n; i++) {
        X[i]   = path->frame[i].pose.X_m;
        Z[i]   = path->frame[i].pose.Z_m;
        phi[i] = path->frame[i].pose.phi_rad;
    }
    smooth(n, half, X, spare);
    smooth(n, half, Z, spare);
    smooth(n, half, phi, spare);

    for (size_t i = 0; i < n; i++) {
        struct dig_rig_pose *const pose = &path->frame[i].pose;
        path->blend_off_m   = fmax(path->blend_off_m, hypot(X[i] - pose->X_m, Z[i] - pose->Z_m));
        path->blend_off_rad = fmax(path->blend_off_rad, fabs(phi[i] - pose->phi_rad));
        *pose               = (struct dig_rig_pose){ .X_m = X[i], .Z_m = Z[i], .phi_rad = phi[i] };
    }
    free(block);
    return true;
}
