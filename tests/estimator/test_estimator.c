// Tests for estimator/estimator.c: from pressures to prediction, and what it refuses. How whole
// digs are observed is in test_estimator_digs.c.

#include "estimator/estimator.h"

#include "estimator/match/match.h"
#include "tests/count_allocations.h"
#include "tests/driven.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

// The main job: one simple dig identifies, the actual dig is predicted ahead of the bucket.
TEST(a_simple_dig_predicts_the_actual_one)
{
    struct driven *const b = driven_create(true);
    driven_dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->predictions, 0); // nothing is known yet

    struct dig_match match;
    assert_int_equal(dig_match_nearest(b->set, 1, &b->observation, 2.5, &match), DIG_OK);
    assert_int_equal(dig_fit_refine(b->set, 1, &b->observation, 500, &match), DIG_OK);
    assert_false(match.outside);
    struct dig_forecast *const forecast = calloc(1, sizeof *forecast);
    const unsigned long        before   = allocations;
    dig_forecast_make(b->set, driven_lambda, &match, forecast);
    dig_estimator_set_forecast(b->estimator, forecast);
    assert_int_equal(allocations, before);

    driven_dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 6 });
    assert_int_equal(b->observations, 2);
    assert_true(b->predictions > 1000);
    print_message("predicted ahead within %.3f\n", b->worst_prediction);
    assert_true(b->worst_prediction < 0.1);

    // Before a dig begins, each trajectory can be asked for whole.
    struct dig_prediction whole;
    dig_estimator_predict_trajectory(b->estimator, MADE_ACTUAL, &whole);
    assert_true(whole.valid);
    assert_close(whole.from_progress, 0.0, 0.0);
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double at       = (double)i / (DIG_PREDICTION_POINTS - 1);
        const double truth_Nm = driven_moment_Nm(MADE_ACTUAL, at);
        assert_close(whole.moment_Nm[i], truth_Nm, 0.05 * truth_Nm + 1.0);
        assert_true(whole.sigma_Nm[i] >= 0.09 * truth_Nm);
    }
    dig_estimator_predict_trajectory(b->estimator, MADE_TRAJECTORIES, &whole);
    assert_false(whole.valid);
    dig_estimator_predict_trajectory(b->estimator, -1, &whole);
    assert_false(whole.valid);

    // A match that is none takes the prediction back.
    match.valid = false;
    dig_forecast_make(b->set, driven_lambda, &match, forecast);
    driven_dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 7 });
    assert_int_equal(b->predictions, 0);
    driven_destroy(b);
    free(forecast);
}

TEST(a_load_carried_away_is_no_second_dig)
{
    struct driven *const b = driven_create(true);
    driven_dig(b, (struct drive){
                      .which = MADE_ACTUAL, .stretch = 1, .until = 1, .carry_Nm = 4e3, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->estimate.dig_count, 1);
    assert_int_equal(b->estimate.phase, DIG_PHASE_AIR);
    assert_int_equal(b->estimate.trajectory, -1);
    driven_destroy(b);
}

TEST(a_scrape_is_counted_but_not_matched)
{
    struct driven *const  b     = driven_create(false);
    const struct dig_pose level = { 0.1, 0.18, 1.2 }; // curled in, none of the trajectories
    uint64_t              seed  = 4;
    for (int i = 0; i < 3000; i++) {
        struct dig_pose pose = level;
        pose.x_m += 1e-5 * i;
        driven_tick(b, pose, 0.0, i > 500 && i < 2000 ? 8e3 : 0.0, 0.0, &seed);
        assert_int_equal(b->estimate.trajectory, -1);
    }
    assert_int_equal(b->estimate.dig_count, 1);
    assert_int_equal(b->observations, 0);
    driven_destroy(b);
}

TEST(no_tick_allocates)
{
    skip_unless_allocations_count();
    struct driven *const b = driven_create(true);
    b->allocations         = &allocations;
    driven_dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 4, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->steps_with_allocation, 0);
    driven_destroy(b);
}

TEST(bad_samples_are_refused_and_change_nothing)
{
    struct driven *const    b           = driven_create(false);
    const double            joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load load        = { 1e3, 2e3, 1e4 };
    const struct dig_sample good =
        model_sample(&b->machine, joint_rad, 0.0, &load, 1e6, 1000000000);
    struct dig_estimate estimate;
    assert_int_equal(dig_estimator_step(b->estimator, &good, &estimate), DIG_OK);
    assert_close(estimate.wrench.My_Nm, 1e4, 0.05);

    struct dig_estimator *const copy = malloc(dig_estimator_size());
    struct dig_estimate         before;
    memcpy(copy, b->estimator, dig_estimator_size());
    before                   = estimate;
    struct dig_sample bad[4] = { good, good, good, good };
    for (int i = 0; i < 4; i++) {
        bad[i].time_ns += 5000000;
    }
    bad[0].time_ns                         = good.time_ns; // twice the same
    bad[1].time_ns                         = good.time_ns - 1;
    bad[2].valid[DIG_SIGNAL_BOOM_rad]      = false;
    bad[3].value[DIG_SIGNAL_BUCKET_ROD_Pa] = NAN;
    assert_int_equal(dig_estimator_step(b->estimator, &bad[0], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[1], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[2], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[3], &estimate), DIG_EINVAL);
    assert_true(estimate.time_ns == before.time_ns && estimate.phase == before.phase);
    assert_close(estimate.wrench.My_Nm, before.wrench.My_Nm, 0.0);
    assert_close(estimate.wrench.sigma_Fz_N, before.wrench.sigma_Fz_N, 0.0);
    assert_close(estimate.pin_Z_m, before.pin_Z_m, 0.0);
    assert_memory_equal(b->estimator, copy, dig_estimator_size());
    free(copy);
    driven_destroy(b);
}

// Samples no machine could give, wandering and jumping: nothing that is no number comes out, and a
// good dig afterwards is observed as if nothing had been.
TEST(whatever_comes_in_only_numbers_go_out)
{
    struct driven *const b      = driven_create(true);
    uint64_t             seed   = 31;
    struct dig_sample    sample = { .time_ns = 1 };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = true;
    }
    const int samples = test_is_quick() ? 20000 : 200000;
    for (int i = 0; i < samples; i++) {
        sample.time_ns += model_uniform(&seed) < 0.001 ? 60000000000 : 5000000;
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            const bool   angle = s < DIG_SIGNAL_BOOM_HEAD_Pa;
            const double step  = (angle ? 0.01 : 1e5) * model_normal(&seed);
            const bool   jump  = model_uniform(&seed) < 2e-4;
            const double most  = angle ? 3.0 : 4e7;
            sample.value[s] =
                jump ? most * (2.0 * model_uniform(&seed) - 1.0) : sample.value[s] + step;
            sample.value[s] = fmin(fmax(sample.value[s], angle ? -most : 0.0), most);
        }
        struct dig_estimate    e;
        struct dig_observation o;
        assert_int_equal(dig_estimator_step(b->estimator, &sample, &e), DIG_OK);
        assert_true(isfinite(e.wrench.My_Nm) && isfinite(e.wrench.sigma_My_Nm));
        assert_true(isfinite(e.wrench.Fx_N) && isfinite(e.wrench.sigma_Fx_N));
        assert_true(isfinite(e.pin_X_m) && isfinite(e.phi_rad));
        assert_true(e.trajectory < 0 || (e.progress >= 0.0 && e.progress <= 1.0));
        if (made_observed(b->estimator, b->set, &o)) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_true(isfinite(o.moment_Nm[k]) && o.sigma_Nm[k] >= 0.0);
            }
        }
    }

    b->time_s = 1e-9 * (double)sample.time_ns;
    driven_dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_true(driven_error(b, 1.0) < 0.04);
    driven_destroy(b);
}

TEST(init_refuses_what_cannot_work_and_writes_nothing)
{
    struct driven *const                b    = driven_create(false);
    const struct dig_estimator_settings good = dig_estimator_settings_default();
    const size_t                        size = dig_estimator_size();
    unsigned char *const                raw  = malloc(size);
    memset(raw, 0x5a, size);
    struct dig_estimator *const e = (struct dig_estimator *)(void *)raw;

    struct dig_machine machine = b->machine;
    machine.link[0].length_m   = NAN;
    assert_int_equal(dig_estimator_init(e, &machine, b->set, &good), DIG_EINVAL);
    machine                 = b->machine;
    machine.four_bar.link_m = 0.2;
    assert_int_equal(dig_estimator_init(e, &machine, b->set, &good), DIG_EUNREACHABLE);
    struct dig_curve_set set = *b->set;
    set.tooth_m              = 0.0;
    assert_int_equal(dig_estimator_init(e, &b->machine, &set, &good), DIG_EINVAL);
    set                      = *b->set;
    set.trajectory[1].phases = 0;
    assert_int_equal(dig_estimator_init(e, &b->machine, &set, &good), DIG_EINVAL);

    struct dig_estimator_settings bad[] = { good, good, good, good, good, good, good };
    bad[0].tick_s                       = 0.0;
    bad[1].contact_sigmas               = NAN;
    bad[2].contact_hold_s               = -1.0;
    bad[3].exit_hold_s                  = 1e9;
    bad[4].air_bias_s                   = -0.1;
    bad[5].path_limit_m                 = 0.0;
    bad[6].outside_floors               = 0.5;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(dig_estimator_init(e, &b->machine, b->set, &bad[i]), DIG_EINVAL);
    }
    for (size_t i = 0; i < size; i++) {
        assert_int_equal(raw[i], 0x5a);
    }
    free(raw);
    driven_destroy(b);
}
