#include "closed_loop/accuracy/judge.h"

#include "core/chance.h"
#include "tests/made_campaign.h"
#include "tests/testlib.h"

#include <stdlib.h>

enum { DRAWS = 4000 };

static struct made_world         world;
static struct dig_scatter       *drawn_from; // a covariance of the test's own
static const struct dig_measured dig = { .trajectory = MADE_ACTUAL, .last = 1.0 };

static int make(void **state)
{
    (void)state;
    world      = made_world(5);
    drawn_from = calloc(1, sizeof *drawn_from);
    return drawn_from != NULL ? 0 : 1;
}

static int clean(void **state)
{
    (void)state;
    free(drawn_from);
    made_world_finish(&world);
    return 0;
}

// Neighbouring bins of the moment share their error: e = (z[b] + z[b + 1]) / sqrt 2.
static void correlate_neighbours(void)
{
    for (size_t a = 0; a < DIG_FEATURE_BINS; a++) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const size_t apart                        = a > b ? a - b : b - a;
            drawn_from->covariance[MADE_ACTUAL][a][b] = apart == 0 ? 1.0 : (apart == 1 ? 0.5 : 0.0);
        }
    }
}

static double change_at(const double size, const double progress)
{
    return size * (progress < 0.5 ? 1.0 : 0.4);
}

static double sigma_at(const double progress)
{
    return 0.5 + progress;
}

// Rig time that every point stands for; none beyond what was measured.
static void fill_times(const double last, double time_s[DIG_CURVE_POINTS])
{
    const struct dig_trajectory *const path = &world.set->trajectory[MADE_ACTUAL];
    const double                       half = 0.5 / (DIG_CURVE_POINTS - 1);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        time_s[k]       = at > last
                              ? 0.0
                              : dig_trajectory_time_s(path, world.set->tooth_m, fmin(at + half, 1.0)) -
                              dig_trajectory_time_s(path, world.set->tooth_m, fmax(at - half, 0.0));
    }
}

// How often a dig drawn about the curve after is nearer to the curve before, point by point.
static double fraction_worse(const double size, const double last)
{
    double   time_s[DIG_CURVE_POINTS];
    uint64_t seed  = 11;
    int      worse = 0;
    fill_times(last, time_s);
    for (int draw = 0; draw < DRAWS; draw++) {
        double z[DIG_FEATURE_BINS + 1];
        for (size_t b = 0; b <= DIG_FEATURE_BINS; b++) {
            z[b] = dig_chance_normal(&seed);
        }
        double before = 0.0;
        double after  = 0.0;
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const struct dig_bin points = dig_feature_bin(b);
            for (size_t k = points.from; k < points.to; k++) {
                const double at     = (double)k / (DIG_CURVE_POINTS - 1);
                const double off_Nm = sigma_at(at) * (z[b] + z[b + 1]) / sqrt(2.0);
                before += time_s[k] * pow(off_Nm + change_at(size, at), 2.0);
                after += time_s[k] * off_Nm * off_Nm;
            }
        }
        worse += after > before ? 1 : 0;
    }
    return (double)worse / DRAWS;
}

static struct dig_trace_curves *make_curves(const double size)
{
    struct dig_trace_curves *const curves = calloc(1, sizeof *curves);
    assert_non_null(curves);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at                           = (double)k / (DIG_CURVE_POINTS - 1);
        curves->after.value[DIG_CHANNEL_MY_Nm][k] = change_at(size, at);
        curves->before.sd[DIG_CHANNEL_MY_Nm][k]   = sigma_at(at);
    }
    return curves;
}

// The formula against counting, from a change far below the scatter to one far above it, of a whole
// dig and of one measured in part.
TEST(the_chance_is_what_drawing_finds)
{
    static const double size[] = { 0.1, 0.5, 1.0, 2.0, 4.0 };
    correlate_neighbours();
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++) {
        struct dig_trace_curves *const curves = make_curves(size[i]);
        struct dig_measured            part   = dig;
        const struct dig_judged        judged = { world.set, 1, &part, curves };
        assert_close(dig_decision_chance_of_worse(&judged, drawn_from),
                     fraction_worse(size[i], 1.0), 0.03);
        part.last = 0.4;
        assert_close(dig_decision_chance_of_worse(&judged, drawn_from),
                     fraction_worse(size[i], 0.4), 0.03);
        free(curves);
    }
}

TEST(no_change_is_as_good_as_any)
{
    struct dig_trace_curves *const curves = make_curves(0.0);
    const struct dig_judged        judged = { world.set, 1, &dig, curves };
    assert_close(dig_decision_chance_of_worse(&judged, drawn_from), 0.5, 0.0);
    free(curves);
}

// Two digs of one size and curves after that are nearer to the first and further from the second.
TEST(what_counts_is_the_error_of_the_digs_fitted_to)
{
    struct dig_measured *const     measured = calloc(2, sizeof *measured);
    struct dig_trace_curves *const curves   = calloc(2, sizeof *curves);
    assert_non_null(measured);
    assert_non_null(curves);
    for (size_t i = 0; i < 2; i++) {
        measured[i] = dig;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_MY_Nm][k]      = 2.0;
            curves[i].before.value[DIG_CHANNEL_MY_Nm][k] = 1.5;
            curves[i].after.value[DIG_CHANNEL_MY_Nm][k]  = i == 0 ? 1.9 : 3.0;
        }
    }
    const struct dig_judged judged   = { world.set, 2, measured, curves };
    const bool              first[]  = { true, false };
    const bool              second[] = { false, true };
    const bool              both[]   = { true, true };
    assert_true(dig_decision_brings_nearer(&judged, first));
    assert_false(dig_decision_brings_nearer(&judged, second));
    assert_false(dig_decision_brings_nearer(&judged, both));
    free(curves);
    free(measured);
}

TESTS_WITH(make, clean)
