// Tests for tables/derive.c: runs become curves over the path

#include "tables/derive.h"

#include "tables/load.h"
#include "tests/tables_fixture.h"

static const struct dig_curve *curve_of(const struct dig_curve_set *const set, const size_t entry,
                                        const size_t trajectory)
{
    return &set->curve[entry * set->trajectories + trajectory];
}

TEST(mean_and_spread_are_those_of_the_packings)
{
    struct dig_store *const store = fixture_create("mean.sqlite");
    fixture_put(store, .3, .3, 1, 0, 2.0);
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 2, 0, 6.0);
    dig_store_close(store);
    struct dig_curve_set *const   set = fixture_load("mean.sqlite");
    const struct dig_curve *const c   = curve_of(set, 0, 0);
    const double                  sd  = sqrt((4.0 + 1.0 + 9.0) / 2.0);
    assert_int_equal(set->packings[0], 3);
    assert_int_equal(set->packings[1], 0);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close((double)c->mean[DIG_CHANNEL_MY_Nm][k], 3.0, 1e-6);
        assert_close((double)c->mean[DIG_CHANNEL_FX_N][k], 6.0, 1e-6);
        assert_close((double)c->mean[DIG_CHANNEL_FZ_N][k], -9.0, 1e-6);
        assert_close((double)c->mean[DIG_CHANNEL_CARRIED_kg][k], 15.0, 1e-6);
        assert_close((double)c->sd[DIG_CHANNEL_MY_Nm][k], sd, 1e-6);
        assert_close((double)c->sd[DIG_CHANNEL_FZ_N][k], 3.0 * sd, 1e-5);
    }
    dig_curve_set_destroy(set);
}

// A straight line is its own moving average, so away from the ends the curve is the line at the
// time at which that part of the path is done, which is worked out by hand here.
TEST(a_curve_runs_along_the_path_not_along_time)
{
    struct dig_store *const     store = fixture_create("path.sqlite");
    const struct dig_run_origin pull  = fixture_origin(.3, .3, 2500.0, 0, 0);
    const struct dig_run_origin push  = fixture_origin(.3, .3, 2500.0, 0, 1);
    struct dig_recording        ramp  = fixture_ramp(400, 10.0, 4.0);
    assert_int_equal(dig_store_put(store, &pull, &ramp, NULL), DIG_OK);
    ramp = fixture_ramp(200, 10.0, 4.0);
    assert_int_equal(dig_store_put(store, &push, &ramp, NULL), DIG_OK);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("path.sqlite");

    const float *const along_pull = curve_of(set, 0, 0)->mean[DIG_CHANNEL_MY_Nm];
    assert_close((double)along_pull[51], 10.0 + 4.0 * 0.4, 1e-5);  // a fifth of 2 s
    assert_close((double)along_pull[204], 10.0 + 4.0 * 1.6, 1e-5); // four fifths
    const float *const along_push = curve_of(set, 0, 1)->mean[DIG_CHANNEL_MY_Nm];
    assert_close((double)along_push[51], 10.0 + 4.0 * 0.4, 1e-5); // slow half: 1 path in 2 s
    assert_close((double)along_push[153], 10.0 + 4.0 * (0.5 + 0.35 / 0.75 * 0.5), 1e-5);
    dig_curve_set_destroy(set);
}

// A step of the moment: the average over +-0.16 s turns it into a ramp 0.32 s long.
TEST(a_step_becomes_a_ramp_as_long_as_the_moving_average)
{
    struct dig_store *const     store  = fixture_create("step.sqlite");
    const struct dig_run_origin origin = fixture_origin(.3, .3, 2500.0, 0, 0);
    struct dig_recording        step   = fixture_recording(400, 1.0);
    for (size_t i = 0; i < 200; i++) {
        step.row[i].My_Nm = 0.0;
    }
    assert_int_equal(dig_store_put(store, &origin, &step, NULL), DIG_OK);
    dig_store_close(store);
    struct dig_curve_set *const set = fixture_load("step.sqlite");
    const float *const          y   = curve_of(set, 0, 0)->mean[DIG_CHANNEL_MY_Nm];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double t_s = 2.0 * (double)k / 255.0;
        assert_close((double)y[k], fmin(fmax((t_s - 1.0 + 0.16) / 0.32, 0.0), 1.0), 0.004);
    }
    dig_curve_set_destroy(set);
}

TESTS_WITH(scratch_setup, scratch_teardown)
