// Friction and rolling friction at the bucket, through every engine: one grain on a level plate of
// a bucket that is pulled away below it, against rigid-body mechanics.
//
//        o r         It slides, and the plate feels mu m g, while the contact point slips: from
//   ===========->    v at t = 0 at the rate mu g + 5/2 (mu - mu_r) g. Then it rolls, and the plate
//             v      feels mu_r m g / (1 + 2/5).

#include "offline_dem/reference/engine_ode.h"
#include "tests/dem_fixture.h"
#include "tests/offline_dem/host_device.h"

#include <math.h>

#define PULL_mps 0.2

static const struct dig_gravel gravel = { { 0.5, 0.2, DENSITY } };

// A bucket that is a plate with a fin below it; what lies on the plate lies outside of it.
static struct dig_scene plate_scene(const double smoothness)
{
    struct dig_scene scene = dem_small_scene();
    scene.bucket           = (struct dig_bucket){
                  .points = 3, .x_m = { 0.03, -0.03, -0.03 }, .z_m = { 0.0, 0.0, -0.02 }, .width_m = 0.04
    };
    scene.box                     = (struct dig_box){ 0.0, 0.2, -0.03, 0.03, 0.0, 0.03 };
    scene.laws.bucket_smoothness  = smoothness;
    scene.trajectory[0].start_x_m = 0.05;
    scene.trajectory[0].start_z_m = 0.05;
    scene.trajectory[0].phase[0]  = (struct dig_phase){ "pull", 0.2, PULL_mps, 0.0, 0.0 };
    return scene;
}

enum engine { KERNEL, ODE, DEVICE, ENGINES };

static struct dig_recording pull(const enum engine engine, const struct dig_scene *const scene)
{
    double               x_m[]    = { 0.05 };
    double               y_m[]    = { 0.0 };
    double               z_m[]    = { 0.05 + GRAIN_m + 1e-6 };
    double               radius[] = { GRAIN_m };
    const struct dig_bed bed      = {
             .grains = 1, .x_m = x_m, .y_m = y_m, .z_m = z_m, .radius_m = radius
    };
    const struct dig_trajectory *const t       = &scene->trajectory[0];
    const struct dig_engine            ode     = dig_engine_ode();
    const struct dig_stepper           stepper = { .take_over =
                                             engine == DEVICE ? dem_host_take_over : NULL };
    struct dig_recording               r       = { 0 };
    struct dig_error                   error   = { "" };
    assert_ok((engine == ODE
                   ? ode.dig(&ode.stepper, scene, &gravel, &bed, t, NULL, NULL, &r, &error)
                   : dig_dig_run(&stepper, scene, &gravel, &bed, t, NULL, NULL, &r, &error)),
              error);
    return r;
}

// What the plate feels along over what it carries, in the mean of the rows from and to a time.
static double ratio(const struct dig_recording *const r, const double from_s, const double to_s)
{
    double along_N = 0.0;
    double down_N  = 0.0;
    for (size_t k = 0; k < r->rows; k++) {
        if (r->row[k].t_s > from_s && r->row[k].t_s < to_s) {
            along_N -= r->row[k].Fx_N;
            down_N -= r->row[k].Fz_N;
        }
    }
    assert_true(down_N > 0.5 * GRAIN_kg * GRAVITY);
    return along_N / down_N;
}

TEST(a_grain_slides_and_rolls_by_what_is_left_at_a_smoother_bucket)
{
    const double smoothness[] = { 0.0, 0.4, 0.75 };
    for (int engine = 0; engine < ENGINES; engine++) {
        for (size_t i = 0; i < 3; i++) {
            const struct dig_scene scene   = plate_scene(smoothness[i]);
            const double           mu      = 0.5 * (1.0 - smoothness[i]);
            const double           rolling = 0.2 * (1.0 - smoothness[i]);
            const double           rolls_s = PULL_mps / (GRAVITY * (mu + 2.5 * (mu - rolling)));
            struct dig_recording   r       = pull((enum engine)engine, &scene);
            assert_close(ratio(&r, 0.2 * rolls_s, 0.8 * rolls_s), mu, 0.02 * mu);
            assert_close(ratio(&r, rolls_s + 0.01, rolls_s + 0.05), rolling / 1.4, 0.02 * rolling);
            dig_recording_finish(&r);
        }
    }
}
