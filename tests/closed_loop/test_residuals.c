#include "closed_loop/verdict/residuals.h"

#include "closed_loop/accuracy/judge.h"
#include "closed_loop/recordings/regressors.h"
#include "tests/made_table.h"
#include "tests/testlib.h"

static struct dig_curve_set   *set;
static struct dig_measured     dig;
static struct dig_trace_curves curves;

static int set_up(void **state)
{
    (void)state;
    set = made_table(&(struct made_options){ .relative_sd = 0.1, .packings = 3 });
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    return 0;
}

// A dig of which the moment is so many sigmas off in the soil and when lifted, and all wrong where
// it was not measured; before is half of after's distance further.
static void make(const double soil, const double lifted)
{
    dig = (struct dig_measured){
        .trajectory = MADE_ACTUAL, .pass = 1, .pace = 1.0, .first = 0.1, .last = 0.95
    };
    dig.measured[DIG_CHANNEL_MY_Nm] = true;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double p            = (double)k / (DIG_CURVE_POINTS - 1);
        const double by           = dig_regressors_is_lifted(set, MADE_ACTUAL, p) ? lifted : soil;
        const bool   in           = p >= dig.first && p <= dig.last;
        curves.before.value[0][k] = 2.0 + p;
        curves.before.sd[0][k]    = 0.08;
        dig.sigma[0][k]           = 0.06;
        dig.value[0][k]           = 2.0 + p + (in ? 0.1 * by : 1e6);
        curves.after.value[0][k]  = 2.0 + p + (in ? 0.05 * by : 0.0);
        curves.after.sd[0][k]     = 0.08;
    }
}

TEST(sigmas_are_told_apart_by_part_and_by_before_and_after)
{
    make(0.5, 2.0);
    struct dig_residual r[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
    dig_residual_of(set, &dig, &curves.before, r);
    assert_close(r[DIG_PART_SOIL][0].sigmas, 0.5, 1e-9);
    assert_close(r[DIG_PART_LIFTED][0].sigmas, 2.0, 1e-9);
    assert_close(r[DIG_PART_SOIL][0].rms, 0.05, 1e-9);
    assert_close(r[DIG_PART_LIFTED][0].rms, 0.2, 1e-9);
    dig_residual_of(set, &dig, &curves.after, r);
    assert_close(r[DIG_PART_SOIL][0].sigmas, 0.25, 1e-9);
    assert_close(r[DIG_PART_LIFTED][0].rms, 0.1, 1e-9);
}

// A prediction's error is summed over rig time on another grid.
TEST(the_parts_add_up_to_the_error_of_the_dig)
{
    static const double off[][2] = { { 0.5, 2.0 }, { 3.0, 0.1 } };
    for (size_t i = 0; i < sizeof off / sizeof off[0]; i++) {
        make(off[i][0], off[i][1]);
        const bool              take   = true;
        const struct dig_judged judged = { set, 1, &dig, &curves };
        struct dig_residual     r[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
        // The error's grid may touch the point beside the range: nothing outrageous there.
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            dig.value[0][k] = fmin(dig.value[0][k], curves.before.value[0][k] + 0.5);
        }
        dig_residual_of(set, &dig, &curves.before, r);
        assert_close(hypot(r[DIG_PART_SOIL][0].relative, r[DIG_PART_LIFTED][0].relative),
                     dig_judge_error(&judged, &take, false, 1).value, 2e-3);
    }
}

TEST(what_was_not_measured_is_not_known)
{
    make(1.0, 1.0);
    struct dig_residual r[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
    dig.last = 0.3; // broken off before it was lifted
    dig_residual_of(set, &dig, &curves.before, r);
    assert_true(isnan(r[DIG_PART_SOIL][DIG_CHANNEL_FX_N].rms));
    assert_true(isnan(r[DIG_PART_AIR][DIG_CHANNEL_MY_Nm].rms));
    assert_true(isnan(r[DIG_PART_LIFTED][DIG_CHANNEL_MY_Nm].sigmas));
    assert_close(r[DIG_PART_SOIL][DIG_CHANNEL_MY_Nm].sigmas, 1.0, 1e-9);
}

TESTS_WITH(set_up, tear_down)
