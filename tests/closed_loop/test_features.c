#include "closed_loop/recordings/features.h"

#include "tests/testlib.h"

#include <math.h>

TEST(a_bin_is_the_mean_of_its_points)
{
    double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            curve[c][k] = (c + 1) * k;
        }
    }
    double feature[DIG_FEATURES];
    dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, feature);
    size_t before = 0;
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        const struct dig_bin points = dig_feature_bin(b);
        assert_int_equal(points.from, before); // no point twice, none left out
        before = points.to;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            assert_close(feature[c * DIG_FEATURE_BINS + b],
                         ((double)c + 1.0) * 0.5 * (double)(points.from + points.to - 1), 1e-9);
        }
    }
    assert_int_equal(before, DIG_CURVE_POINTS);
}

TEST(a_dig_that_stops_early_lacks_its_last_bins)
{
    const bool both[DIG_FORCE_CHANNELS] = { true, false, true };
    bool       mask[DIG_FEATURES];
    dig_features_mask(both, 0.0, 0.55, mask);
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        assert_int_equal(mask[b], b < 5);
        assert_false(mask[DIG_FEATURE_BINS + b]); // a channel that was not measured
        assert_int_equal(mask[2 * DIG_FEATURE_BINS + b], b < 5);
    }
}

TEST(the_size_of_a_dig_is_its_rms)
{
    double feature[DIG_FEATURES];
    bool   mask[DIG_FEATURES];
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const double of[DIG_FORCE_CHANNELS] = { -2.0, 3.0, 4.0 };
        feature[f]                          = of[f / DIG_FEATURE_BINS];
        mask[f]                             = f % DIG_FEATURE_BINS < 3;
    }
    feature[DIG_FEATURE_BINS - 1] = 1e6; // masked
    double size[DIG_FORCE_CHANNELS];
    dig_features_amplitude(feature, mask, size);
    assert_close(size[0], 2.0, 1e-12);
    assert_close(size[1], 5.0, 1e-12); // of the resultant
    assert_close(size[2], 5.0, 1e-12);
    const double none[DIG_FEATURES] = { 0.0 };
    dig_features_amplitude(none, NULL, size);
    assert_true(size[0] > 0.0);
}

// Against sums over a fine grid: what a feature makes of each instant, and how alike two are.
TEST(noise_that_lasts_goes_into_features_as_it_does)
{
    enum { STEPS = 1000 };
    const double  half_s                       = 0.16;
    const double  step_s                       = 0.005;
    const double  memory_s                     = 0.1;
    double        edge_s[DIG_FEATURE_BINS + 1] = { 1.0 };
    double        covariance[DIG_FEATURE_BINS * DIG_FEATURE_BINS];
    static double weight[DIG_FEATURE_BINS][STEPS];
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        edge_s[b + 1] = edge_s[b] + (b % 2 == 0 ? 0.2 : 0.4);
        double sum    = 0.0;
        for (size_t k = 0; k < STEPS; k++) {
            const double at_s = ((double)k + 0.5) * step_s;
            const double from = fmax(at_s - half_s, edge_s[b]);
            const double to   = fmin(at_s + half_s, edge_s[b + 1]);
            weight[b][k]      = fmax(to - from, 0.0);
            sum += weight[b][k];
        }
        for (size_t k = 0; k < STEPS; k++) {
            weight[b][k] /= sum;
        }
    }
    dig_features_lasting(edge_s, half_s, memory_s, covariance);
    for (size_t b = 3; b < 6; b++) {
        double sum = 0.0;
        for (size_t k = 0; k < STEPS * STEPS; k++) {
            const double apart_s = step_s * fabs((double)(k / STEPS) - (double)(k % STEPS));
            sum += weight[3][k / STEPS] * weight[b][k % STEPS] * exp(-apart_s / memory_s);
        }
        assert_close(covariance[3 * DIG_FEATURE_BINS + b], sum, 1e-3);
        assert_close(covariance[b * DIG_FEATURE_BINS + 3], sum, 1e-3);
    }
}
