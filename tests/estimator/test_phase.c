// Tests for estimator/track/phase.c

#include "estimator/track/phase.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

static const double dt_s     = 0.005;
static const double sigma_Nm = 100.0;

struct run {
    struct dig_phase_state        state;
    struct dig_estimator_settings settings;
    uint64_t                      seed;
    int                           touched, lost, gone;
};

static struct run start(void)
{
    return (struct run){ .settings = dig_estimator_settings_default(), .seed = 8 };
}

// Holds a moment for a while, with the noise that sigma says.
static void hold(struct run *const run, const double moment_Nm, const double seconds)
{
    for (double t_s = 0.0; t_s < seconds; t_s += dt_s) {
        const double noisy_Nm = moment_Nm + sigma_Nm * model_normal(&run->seed);
        switch (dig_phase_step(&run->state, &run->settings, dt_s, noisy_Nm, sigma_Nm, 0.0)) {
        case DIG_EVENT_CONTACT: run->touched++; break;
        case DIG_EVENT_LOST: run->lost++; break;
        case DIG_EVENT_FINISHED: run->gone++; break;
        case DIG_EVENT_NONE:
        default: break;
        }
    }
}

TEST(a_dig_runs_through_all_phases_once)
{
    struct run run = start();
    hold(&run, 0.0, 5.0);
    assert_int_equal(run.state.phase, DIG_PHASE_AIR);
    hold(&run, 1000.0, 0.2);
    assert_int_equal(run.state.phase, DIG_PHASE_CONTACT);
    hold(&run, 2000.0, 5.0);
    assert_int_equal(run.state.phase, DIG_PHASE_DIG);
    hold(&run, 0.0, 0.9);
    assert_int_equal(run.state.phase, DIG_PHASE_EXIT);
    hold(&run, 0.0, 1.0);
    assert_int_equal(run.state.phase, DIG_PHASE_AIR);
    assert_int_equal(run.touched, 1);
    assert_int_equal(run.gone, 1);
    assert_int_equal(run.lost, 0);
}

TEST(an_hour_of_noise_is_no_contact)
{
    struct run run = start();
    hold(&run, 0.0, 3600.0);
    hold(&run, 50.0, 600.0); // half a sigma of bias, a third of the threshold
    assert_int_equal(run.touched, 0);
}

TEST(single_samples_decide_nothing)
{
    struct run run = start();
    hold(&run, 0.0, 1.0);
    for (int i = 0; i < 100; i++) {
        hold(&run, 3000.0, dt_s);
        hold(&run, 0.0, 1.0);
    }
    assert_int_equal(run.touched, 0);
}

TEST(a_hesitation_shorter_than_the_exit_hold_is_one_dig)
{
    struct run run = start();
    hold(&run, 2000.0, 3.0);
    hold(&run, 0.0, 0.7);
    assert_int_equal(run.state.phase, DIG_PHASE_EXIT);
    hold(&run, 2000.0, 3.0);
    assert_int_equal(run.state.phase, DIG_PHASE_DIG);
    hold(&run, 0.0, 3.0);
    assert_int_equal(run.touched, 1);
    assert_int_equal(run.gone, 1);
}

TEST(near_the_threshold_it_does_not_flicker)
{
    struct run run = start();
    hold(&run, 2000.0, 2.0);
    hold(&run, 1.5 * sigma_Nm, 60.0); // on the threshold, twice the other one
    assert_int_equal(run.state.phase, DIG_PHASE_DIG);
    assert_int_equal(run.touched, 1);
    assert_int_equal(run.gone + run.lost, 0);
}

TEST(a_touch_that_does_not_last_is_lost)
{
    struct run run              = start();
    run.settings.contact_hold_s = 0.3;
    hold(&run, 250.0, 0.65);
    assert_int_equal(run.state.phase, DIG_PHASE_CONTACT);
    hold(&run, 0.0, 1.0);
    assert_int_equal(run.state.phase, DIG_PHASE_AIR);
    assert_int_equal(run.lost, 1);
    assert_int_equal(run.gone, 0);
}

TEST(a_dig_ended_from_outside_waits_for_free_air)
{
    struct run run = start();
    hold(&run, 2000.0, 3.0);
    dig_phase_end(&run.state);
    hold(&run, 2000.0, 20.0); // the bucket carries what it dug
    assert_int_equal(run.state.phase, DIG_PHASE_EXIT);
    hold(&run, 0.0, 3.0);
    assert_int_equal(run.state.phase, DIG_PHASE_AIR);
    assert_int_equal(run.gone, 0);
    hold(&run, 2000.0, 1.0);
    assert_int_equal(run.touched, 2);
}

// A quantiser without noise may stand off by more than a sigma for as long as the bucket hangs
// still.
TEST(what_no_filter_takes_away_raises_the_threshold)
{
    struct run run = start();
    for (int i = 0; i < 4000; i++) {
        const enum dig_phase_event event = dig_phase_step(&run.state, &run.settings, dt_s,
                                                          2.0 * sigma_Nm, sigma_Nm, 0.8 * sigma_Nm);
        assert_int_equal(event, DIG_EVENT_NONE);
    }
    hold(&run, 2.0 * sigma_Nm, 1.0); // the same with noise is contact
    assert_int_equal(run.touched, 1);
}

TEST(bias_is_learnt_in_air_only_and_only_when_asked)
{
    struct run off = start(), on = start();
    on.settings.air_bias_s = 2.0;
    hold(&off, 50.0, 30.0);
    hold(&on, 50.0, 30.0);
    assert_close(off.state.bias_Nm, 0.0, 0.0);
    assert_close(on.state.bias_Nm, 50.0, 10.0);

    hold(&on, 5000.0, 30.0);
    assert_close(on.state.bias_Nm, 50.0, 20.0);
}
