#include "estimator/track/frame.h"

#include <assert.h>
#include <math.h>

struct dig_path_point dig_frame_turned(const struct dig_path_point *const point,
                                       const double pitch_rad, const double tooth_m)
{
    assert(point != NULL);
    const double c = cos(pitch_rad);
    const double s = sin(pitch_rad);
    return (struct dig_path_point){ c * point->x_m + s * point->z_m,
                                    c * point->z_m - s * point->x_m,
                                    point->turn_m - tooth_m * pitch_rad };
}

struct dig_route dig_frame_route(const struct dig_route *const route, const double pitch_rad,
                                 const double tooth_m)
{
    assert(route != NULL);
    struct dig_route turned = *route;
    for (size_t i = 0; i < route->corners; i++) {
        turned.corner[i] = dig_frame_turned(&route->corner[i], -pitch_rad, tooth_m);
    }
    return turned;
}

// Of an error that is one number in both.
static void turn_error(const double c, const double s, float error[DIG_FORCE_CHANNELS])
{
    const double x = error[DIG_CHANNEL_FX_N];
    const double z = error[DIG_CHANNEL_FZ_N];

    error[DIG_CHANNEL_FX_N] = (float)(c * x + s * z);
    error[DIG_CHANNEL_FZ_N] = (float)(c * z - s * x);
}

static void turn_sigma(const double c, const double s, float sigma[DIG_FORCE_CHANNELS])
{
    const double x = sigma[DIG_CHANNEL_FX_N];
    const double z = sigma[DIG_CHANNEL_FZ_N];

    sigma[DIG_CHANNEL_FX_N] = (float)hypot(c * x, s * z);
    sigma[DIG_CHANNEL_FZ_N] = (float)hypot(c * z, s * x);
}

void dig_frame_turn_forces(const double pitch_rad, struct dig_window_sample *const sample)
{
    assert(sample != NULL);
    const double c = cos(pitch_rad);
    const double s = sin(pitch_rad);
    const double x = sample->value[DIG_CHANNEL_FX_N];
    const double z = sample->value[DIG_CHANNEL_FZ_N];

    sample->value[DIG_CHANNEL_FX_N] = c * x + s * z;
    sample->value[DIG_CHANNEL_FZ_N] = c * z - s * x;
    turn_sigma(c, s, sample->sigma);
    turn_sigma(c, s, sample->slow);
    for (size_t j = 0; j < DIG_RUBS; j++) {
        turn_error(c, s, sample->rubs[j]);
    }
}
