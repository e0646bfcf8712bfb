// Tests for firmware_host/matching/gravel_track.c: the hint. What else it knows is tested where
// fit.c uses it (test_fit_ground.c, test_fit_state.c).

#include "tests/firmware_host/fit_bench.h"

// Energy per kilogram: the bucket that is filled with less work wins, unless it carries too little.
TEST(the_hint_is_the_dig_that_carries_for_the_least_energy)
{
    struct bench *const  b          = bench_create();
    struct dig_forecast *f          = calloc(1, sizeof *f);
    double               J_per_kg   = -1.0;
    const double         energy_J[] = { 900.0, 500.0 }, carried_kg[] = { 2.0, 1.5 };
    for (int t = 0; t < TRAJECTORIES; t++) {
        f->expected[t].valid    = true;
        f->expected[t].energy_J = energy_J[t];
        f->expected[t].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] =
            (float)carried_kg[t];
    }
    assert_int_equal(dig_gravel_track_hint(&b->cube.set, f, 10.0, &J_per_kg), 1);
    assert_close(J_per_kg, 500.0 / 1500.0, 1e-9);
    f->expected[1].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] = 0.9F;
    assert_int_equal(dig_gravel_track_hint(&b->cube.set, f, 10.0, &J_per_kg), 0);
    for (int t = 0; t < TRAJECTORIES; t++) {
        f->expected[t].curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1] = NAN;
    }
    assert_int_equal(dig_gravel_track_hint(&b->cube.set, f, 10.0, &J_per_kg), -1);
    free(f);
    free(b);
}
