#include "closed_loop/accuracy/judge.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

#include <stdlib.h>

enum { DIGS = 3 };

// Digs of height one; the prediction after is off by a known share in each.
static void make(struct dig_measured measured[DIGS], struct dig_trace_curves curves[DIGS],
                 const double off[DIGS])
{
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] = (struct dig_measured){ .trajectory = MADE_ACTUAL, .last = 1.0 };
        curves[i]   = (struct dig_trace_curves){ .before.value = { { 0.0 } } };
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_MY_Nm][k]     = 1.0;
            curves[i].after.value[DIG_CHANNEL_MY_Nm][k] = 1.0 + off[i];
            curves[i].after.sd[DIG_CHANNEL_MY_Nm][k]    = 0.2;
        }
    }
}

TEST(errors_pool_by_squares_over_the_digs_taken)
{
    const struct made_options options    = { .packings = 2 };
    struct dig_curve_set     *set        = made_table(&options);
    struct dig_measured      *m          = calloc(DIGS, sizeof *m);
    struct dig_trace_curves  *c          = calloc(DIGS, sizeof *c);
    const double              off[DIGS]  = { 0.3, 0.4, 9.0 };
    const bool                take[DIGS] = { true, true, false };
    const struct dig_judged   judged     = { set, DIGS, m, c };
    make(m, c, off);
    const struct dig_error_range after  = dig_judge_error(&judged, take, true, 1);
    const struct dig_error_range before = dig_judge_error(&judged, take, false, 1);
    assert_close(after.value, sqrt((0.09 + 0.16) / 2.0), 1e-9);
    assert_close(before.value, 1.0, 1e-9); // predicted nothing
    assert_close(after.low, 0.3, 1e-9);    // a quarter of the draws holds the first dig only
    assert_close(after.high, 0.4, 1e-9);
    assert_close(dig_judge_floor(&judged, take), 0.2, 1e-9);
    free(c);
    free(m);
    made_table_destroy(set);
}

TEST(one_dig_has_no_interval_and_none_no_error)
{
    const struct made_options options    = { .packings = 2 };
    struct dig_curve_set     *set        = made_table(&options);
    struct dig_measured      *m          = calloc(DIGS, sizeof *m);
    struct dig_trace_curves  *c          = calloc(DIGS, sizeof *c);
    const double              off[DIGS]  = { 0.3, 0.4, 9.0 };
    const bool                one[DIGS]  = { false, true, false };
    const bool                none[DIGS] = { false, false, false };
    const struct dig_judged   judged     = { set, DIGS, m, c };
    make(m, c, off);
    const struct dig_error_range alone = dig_judge_error(&judged, one, true, 1);
    assert_close(alone.low, 0.4, 1e-9);
    assert_close(alone.high, 0.4, 1e-9);
    assert_true(isnan(dig_judge_error(&judged, none, true, 1).value));
    assert_true(isnan(dig_judge_floor(&judged, none)));
    free(c);
    free(m);
    made_table_destroy(set);
}

// The made table's digs scatter by 0.1 of the curve; the noise of the prediction adds in squares.
TEST(sigma_is_the_tables_own)
{
    const struct made_options    options = { .packings = 5, .relative_sd = 0.1 };
    struct dig_curve_set        *set     = made_table(&options);
    struct dig_response_surface *surface = malloc(sizeof *surface);
    struct dig_scatter          *scatter = NULL;
    assert_int_equal(dig_response_surface_fit(set, surface), DIG_OK);
    assert_int_equal(dig_scatter_pool(surface, 0, NULL, &scatter), DIG_OK);
    const double place[DIG_AXES] = { 0.1, 0.2, 0.0 };
    double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double       sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double       more[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    dig_response_surface_curve(surface, MADE_ACTUAL, place, curve);
    dig_judge_sd(surface, scatter, MADE_ACTUAL, place, 0.0, sd);
    dig_judge_sd(surface, scatter, MADE_ACTUAL, place, 3.0, more);
    for (size_t k = 20; k < DIG_CURVE_POINTS - 20; k += 20) {
        assert_close(sd[0][k] / curve[0][k], 0.1, 0.02);
        assert_close(more[0][k], 2.0 * sd[0][k], 1e-9);
    }
    dig_scatter_destroy(scatter);
    free(surface);
    made_table_destroy(set);
}

// A dig that its ground makes three times as strong in the moment and twice in the forces.
TEST(sigma_grows_with_what_is_dug)
{
    static const double times[DIG_FORCE_CHANNELS] = { 3.0, 2.0, 2.0 };
    double              plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double              dug[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double              sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            plain[c][k] = 10.0 + sin(0.05 * (double)(k * (c + 1)));
            dug[c][k]   = -times[c] * plain[c][k];
            sd[c][k]    = 0.1 * plain[c][k];
        }
    }
    dig_judge_sd_of_dug((const double(*)[DIG_CURVE_POINTS])plain,
                        (const double(*)[DIG_CURVE_POINTS])dug, sd);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            assert_close(sd[c][k], 0.1 * fabs(dug[c][k]), 1e-9);
        }
    }
}
