// Tests for estimator/predict/predict.c

#include "estimator/predict/predict.h"

#include "estimator/match/match.h"
#include "tests/made_table.h"
#include "tests/testlib.h"

#include <string.h>

static const struct made_options plain = { .relative_sd = 0.1, .packings = 1000 };

static struct dig_match match_of(const size_t samples, const struct dig_gravel sample[])
{
    struct dig_match match = { .valid = true, .gravel = sample[0], .samples = samples };
    for (size_t s = 0; s < samples; s++) {
        match.sample[s] = sample[s];
    }
    return match;
}

TEST(a_sure_gravel_is_predicted_as_the_table_has_it)
{
    struct dig_curve_set *const set    = made_table(&plain);
    const struct dig_gravel     gravel = { { 0.62, 0.52, 2500 } };
    const struct dig_match      match  = match_of(1, &gravel);
    struct dig_curve            curve;
    assert_int_equal(dig_predict_curve(set, &match, MADE_ACTUAL, &curve), DIG_OK);
    for (int k = 0; k < DIG_CURVE_POINTS; k += 5) {
        const double expected = made_moment_Nm(&gravel, MADE_ACTUAL, k / 255.0, 0.0);
        assert_close((double)curve.mean[DIG_CHANNEL_MY_Nm][k], expected, 1e-5);
        assert_close((double)curve.sd[DIG_CHANNEL_MY_Nm][k], 0.1 * expected,
                     1e-3 * expected + 1e-6);
        assert_close((double)curve.mean[DIG_CHANNEL_FX_N][k], -8.0 * expected, 1e-4);
    }
    made_table_destroy(set);
}

// Two gravels, one as likely as the other: the mean lies between, the spread spans both.
TEST(doubt_about_the_gravel_widens_the_prediction)
{
    struct dig_curve_set *const set       = made_table(&plain);
    const struct dig_gravel     gravels[] = { { { 0.3, 0.4, 2500 } }, { { 0.9, 0.4, 2500 } } };
    const struct dig_match      match     = match_of(2, gravels);
    struct dig_curve            curve;
    assert_int_equal(dig_predict_curve(set, &match, MADE_ACTUAL, &curve), DIG_OK);
    const double low     = made_moment_Nm(&gravels[0], MADE_ACTUAL, 100 / 255.0, 0.0);
    const double high    = made_moment_Nm(&gravels[1], MADE_ACTUAL, 100 / 255.0, 0.0);
    const double within2 = 0.01 * 1.001 * 0.5 * (low * low + high * high);
    assert_close((double)curve.mean[DIG_CHANNEL_MY_Nm][100], 0.5 * (low + high), 1e-5);
    assert_close((double)curve.sd[DIG_CHANNEL_MY_Nm][100],
                 sqrt(within2 + pow(0.5 * (high - low), 2.0)), 1e-5);
    made_table_destroy(set);
}

TEST(a_match_not_refined_predicts_for_its_gravel_or_its_entry)
{
    struct dig_curve_set *const set   = made_table(&plain);
    struct dig_match            match = { .valid = true, .nearest = 7, .gravel = set->gravel[7] };
    struct dig_curve            curve;
    assert_int_equal(dig_predict_curve(set, &match, 0, &curve), DIG_OK);
    assert_close((double)curve.mean[0][99], (double)set->curve[7 * 3].mean[0][99], 1e-6);

    // A gravel between the entries where one is missing falls back on the nearest.
    match.gravel.value[DIG_AXIS_FRICTION] = 5.0;
    assert_int_equal(dig_predict_curve(set, &match, 0, &curve), DIG_OK);
    assert_close((double)curve.mean[0][99], (double)set->curve[7 * 3].mean[0][99], 1e-6);
    made_table_destroy(set);
}

TEST(refusals_write_nothing)
{
    struct dig_curve_set *const set  = made_table(&plain);
    struct dig_match            none = { .valid = false };
    struct dig_match            one  = { .valid = true, .nearest = 7, .gravel = set->gravel[7] };
    struct dig_curve            curve, before;
    memset(&curve, 0x5a, sizeof curve);
    memcpy(&before, &curve, sizeof before);
    assert_int_equal(dig_predict_curve(set, &none, 0, &curve), DIG_EINVAL);
    assert_int_equal(dig_predict_curve(set, &one, 3, &curve), DIG_EINVAL);
    set->packings[7 * 3] = 0;
    assert_int_equal(dig_predict_curve(set, &one, 0, &curve), DIG_ENOMATCH);
    one.nearest = -1;
    assert_int_equal(dig_predict_curve(set, &one, 1, &curve), DIG_EINVAL);
    assert_memory_equal(&curve, &before, sizeof curve);
    made_table_destroy(set);
}

TEST(points_ahead_are_the_curve_at_machine_scale)
{
    struct dig_curve curve;
    memset(&curve, 0, sizeof curve);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        curve.mean[DIG_CHANNEL_MY_Nm][k] = (float)k / 255.0f;
        curve.sd[DIG_CHANNEL_MY_Nm][k]   = 0.25f;
        curve.mean[DIG_CHANNEL_FX_N][k]  = 2.0f;
        curve.sd[DIG_CHANNEL_FX_N][k]    = (float)k / 255.0f;
        curve.sd[DIG_CHANNEL_FZ_N][k]    = 3.0f;
    }
    struct dig_prediction p = { .from_progress = 0.4, .to_progress = 1.0 };
    dig_predict_points(&curve, 10.0, &p);
    assert_close(p.moment_Nm[0], 4000.0, 1e-2);
    assert_close(p.moment_Nm[DIG_PREDICTION_POINTS - 1], 10000.0, 1e-2);
    assert_close(p.moment_Nm[21], 6000.0, 1e-2);
    assert_close(p.sigma_Nm[9], 2500.0, 1e-2);
    assert_close(p.Fx_N[9], 2000.0, 1e-2);
    assert_close(p.sigma_Fx_N[21], 600.0, 1e-2);
    assert_close(p.sigma_Fz_N[9], 3000.0, 1e-2);
}
