// Tests for closed_loop/accuracy/score.c

#include "closed_loop/accuracy/score.h"

#include "tests/testlib.h"

static const struct dig_trajectory drag_and_lift = {
    .name   = "drag",
    .phases = 2,
    .phase  = { { "drag", 2.0, 0.05, 0.0, 0.0 }, { "lift", 1.0, 0.0, 0.1, 0.0 } },
};

static void fill(double curve[], const double value)
{
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        curve[k] = value;
    }
}

TEST(a_constant_shortfall_is_its_own_fraction)
{
    double measured[DIG_CURVE_POINTS], predicted[DIG_CURVE_POINTS], sigma[DIG_CURVE_POINTS];
    fill(measured, 4.0);
    fill(predicted, 3.0);
    fill(sigma, 0.5);
    struct dig_score score = { 0 };
    assert_true(isnan(dig_score_error(&score)));
    assert_true(isnan(dig_score_noise_floor(&score)));
    dig_score_add(&score, &drag_and_lift, 0.09, 0.0, 1.0, measured, predicted, sigma);
    assert_close(dig_score_error(&score), 0.25, 1e-12);
    assert_close(dig_score_noise_floor(&score), 0.125, 1e-12);
}

// The drag takes two thirds of the time but half of the path: an error over the drag alone must
// weigh sqrt(2/3), and sqrt(1/2) would be a score over path.
TEST(time_is_what_is_integrated_over_not_path)
{
    double measured[DIG_CURVE_POINTS], predicted[DIG_CURVE_POINTS], sigma[DIG_CURVE_POINTS];
    fill(measured, 1.0);
    fill(sigma, 0.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        predicted[k] = k < DIG_CURVE_POINTS / 2 ? 0.0 : 1.0;
    }
    struct dig_score score = { 0 };
    dig_score_add(&score, &drag_and_lift, 0.09, 0.0, 1.0, measured, predicted, sigma);
    assert_close(dig_score_error(&score), sqrt(2.0 / 3.0), 3e-3);
}

TEST(only_the_range_between_contact_and_exit_counts)
{
    double measured[DIG_CURVE_POINTS], predicted[DIG_CURVE_POINTS], sigma[DIG_CURVE_POINTS];
    fill(measured, 1.0);
    fill(sigma, 0.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        predicted[k] = k < 52 || k > 203 ? 100.0 : 0.9;
    }
    struct dig_score score = { 0 };
    dig_score_add(&score, &drag_and_lift, 0.09, 0.21, 0.79, measured, predicted, sigma);
    assert_close(dig_score_error(&score), 0.1, 1e-12);
}

// Two digs: squares are summed before the root, so the larger dig weighs more.
TEST(digs_are_pooled_by_their_squares)
{
    double m1[DIG_CURVE_POINTS], m2[DIG_CURVE_POINTS], zero[DIG_CURVE_POINTS];
    fill(m1, 3.0);
    fill(m2, 4.0);
    fill(zero, 0.0);
    struct dig_score score = { 0 };
    dig_score_add(&score, &drag_and_lift, 0.09, 0.0, 1.0, m1, zero, zero);
    dig_score_add(&score, &drag_and_lift, 0.09, 0.0, 1.0, m2, m2, zero);
    assert_close(dig_score_error(&score), 3.0 / 5.0, 1e-12);
}
