#include "closed_loop/verdict/residuals.h"

#include "tests/testlib.h"

enum { DIGS = 8, POINTS = 100 };

static double x[DIGS][POINTS];
static double y[DIGS][POINTS];

// Digs whose points lie on lines of their own through the middle.
static struct dig_trend fit(const size_t digs, const double slope[])
{
    struct dig_trend_dig dig[DIGS];
    struct dig_trend     trend;
    for (size_t i = 0; i < digs; i++) {
        for (size_t k = 0; k < POINTS; k++) {
            x[i][k] = 3.0 + (double)k / (POINTS - 1);
            y[i][k] = slope[i] * (x[i][k] - 3.5);
        }
        dig[i] = (struct dig_trend_dig){ POINTS, x[i], y[i] };
    }
    dig_trend_fit(digs, dig, &trend);
    return trend;
}

TEST(what_all_digs_show_is_a_slope)
{
    const double           slope[DIGS] = { 2.1, 1.9, 2.0, 2.2, 1.8, 2.0, 2.05, 1.95 };
    const struct dig_trend t           = fit(DIGS, slope);
    assert_close(t.slope, 2.0, 1e-9);
    assert_true(t.correlation > 0.98 && t.correlation <= 1.0);
    assert_int_equal(t.bins, DIG_TREND_BINS);
    for (size_t b = 0; b < t.bins; b++) {
        assert_int_equal(t.bin[b].digs, DIGS);
        assert_close(t.bin[b].mean, 2.0 * (t.bin[b].at - 3.5), 0.02);
        assert_true(t.bin[b].standard_error < 0.03);
    }
}

// The standard error of a bin is that of the mean over digs, whatever a dig's points do within it.
TEST(a_bin_s_error_is_told_by_its_digs)
{
    double               level[DIGS] = { 1.0, 3.0, 1.0, 3.0, 1.0, 3.0, 1.0, 3.0 };
    struct dig_trend_dig dig[DIGS];
    struct dig_trend     t;
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < POINTS; k++) {
            x[i][k] = (double)k;
            y[i][k] = level[i];
        }
        dig[i] = (struct dig_trend_dig){ POINTS, x[i], y[i] };
    }
    dig_trend_fit(DIGS, dig, &t);
    // Eight of sd sqrt(8 / 7): 2 +- sqrt(1 / 7).
    for (size_t b = 0; b < t.bins; b++) {
        assert_close(t.bin[b].mean, 2.0, 1e-12);
        assert_close(t.bin[b].standard_error, 0.37796447300922725, 1e-9);
    }
    assert_close(t.slope, 0.0, 1e-12);
}

TEST(what_does_not_vary_has_no_slope)
{
    const double     slope[2] = { 1.0, 1.0 };
    struct dig_trend t        = fit(2, slope);
    assert_close(t.slope, 1.0, 1e-9);
    assert_int_equal(t.bin[0].digs, 2);

    struct dig_trend_dig dig[DIGS];
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < POINTS; k++) {
            x[i][k] = 1.0;
        }
        dig[i] = (struct dig_trend_dig){ POINTS, x[i], y[i] };
    }
    dig_trend_fit(DIGS, dig, &t);
    assert_true(isnan(t.slope) && isnan(t.correlation));
    assert_int_equal(t.bins, 1);

    dig_trend_fit(0, NULL, &t);
    assert_true(isnan(t.slope));
    assert_int_equal(t.bins, 0);
}

// Constant along a dig, as the pass is: the digs differ from each other.
TEST(what_differs_between_digs_alone_has_a_slope_too)
{
    struct dig_trend_dig dig[DIGS];
    struct dig_trend     t;
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < POINTS; k++) {
            x[i][k] = 1.0 + (double)(i % 4);
            y[i][k] = 0.5 * x[i][k] + (k % 2 == 0 ? 0.1 : -0.1);
        }
        dig[i] = (struct dig_trend_dig){ POINTS, x[i], y[i] };
    }
    dig_trend_fit(DIGS, dig, &t);
    assert_close(t.slope, 0.5, 1e-9);
    assert_int_equal(t.bins, 4);
}
