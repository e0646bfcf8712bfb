// Tests for closed_loop/accuracy/score.c, and by it: that the band of a prediction holds on digs
// that took no part in the table.

#include "closed_loop/accuracy/score.h"

#include "closed_loop/recordings/observe.h"
#include "estimator/match/match.h"
#include "tables/load.h"
#include "tests/read.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST(points_within_the_band_are_counted_where_something_was_measured)
{
    static struct dig_observation dig = { .first = 10.0 / 255.0, .last = 29.5 / 255.0 };
    static struct dig_curve       curve;
    struct dig_coverage           coverage = { .points = { 0 } };
    assert_true(isnan(dig_coverage_share(&coverage, DIG_CHANNEL_MY_Nm)));
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        curve.mean[0][k] = 5.0f;
        curve.sd[0][k]   = 3.0f;
        dig.sigma_Nm[k]  = 4.0;
        // The band is 1.645 * 5 to either side.
        dig.moment_Nm[k]  = 5.0 + (k % 2 == 0 ? 1.0 : -1.0) * (k % 4 < 3 ? 8.2 : 8.3);
        curve.mean[1][k]  = -2.0f;
        curve.sd[1][k]    = 1.0f;
        dig.force_N[0][k] = k < 15 ? -3.6 : -3.7;
    }
    dig_coverage_add(&coverage, &dig, &curve);
    assert_int_equal(coverage.points[0], 20);
    assert_int_equal(coverage.inside[0], 15);
    assert_close(dig_coverage_share(&coverage, DIG_CHANNEL_MY_Nm), 0.75, 1e-12);
    assert_true(isnan(dig_coverage_share(&coverage, DIG_CHANNEL_FX_N)));
    dig.forces = true;
    dig_coverage_add(&coverage, &dig, &curve);
    assert_int_equal(coverage.points[0], 40);
    assert_int_equal(coverage.points[1], 20);
    assert_int_equal(coverage.inside[1], 5);
    assert_int_equal(coverage.inside[2], 20); // 0 predicted, 0 seen
}

// Moment and forces.
static struct dig_observation observed(const struct dig_curve_set *const set,
                                       const char *const                 path)
{
    struct dig_measured  seen;
    struct dig_recording recording = read_recording(path);
    assert_int_equal(dig_observe_dig(set, &recording, &seen, NULL), DIG_OK);
    dig_recording_finish(&recording);
    struct dig_observation o = { .trajectory = seen.trajectory, .last = 1.0, .forces = true };
    memcpy(o.moment_Nm, seen.value[0], sizeof o.moment_Nm);
    memcpy(o.force_N, seen.value[1], sizeof o.force_N);
    assert_true(seen.measured[1] && seen.measured[2]);
    return o;
}

// Sigma as told, half of it and twice of it.
enum { TOLD, HALF, TWICE, WIDTHS };

static void scale(const struct dig_curve *const from, const double by, struct dig_curve *const to)
{
    *to = *from;
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            to->sd[c][k] = (float)(by * (double)from->sd[c][k]);
        }
    }
}

// One gravel from its simple dig, and its actual dig predicted.
static void judge(const struct dig_curve_set *const set, const char *const simple,
                  struct dig_coverage coverage[WIDTHS])
{
    static const double          by[WIDTHS] = { 1.0, 0.5, 2.0 };
    char                         path[256];
    const struct dig_observation dig = observed(set, simple);
    const char *const            end = strstr(simple, "simpleA.csv");
    assert_non_null(end);
    (void)snprintf(path, sizeof path, "%.*sactual.csv", (int)(end - simple), simple);
    const struct dig_observation actual = observed(set, path);

    struct dig_match match;
    struct dig_curve curve, wide;
    assert_int_equal(dig_match_nearest(set, 1, &dig, 3.0, &match), DIG_OK);
    assert_int_equal(dig_fit_refine(set, 1, &dig, 400, &match), DIG_OK);
    assert_int_equal(dig_predict_curve(set, &match, (size_t)actual.trajectory, &curve), DIG_OK);
    for (int w = 0; w < WIDTHS; w++) {
        scale(&curve, by[w], &wide);
        dig_coverage_add(&coverage[w], &actual, &wide);
    }
}

TEST(the_90_percent_band_holds_85_to_95_on_digs_of_another_code)
{
    static const char *const files[]          = { "tests/data/reference/*__simpleA.csv",
                                                  "tests/data/liggghts_more/mu*__simpleA.csv" };
    struct dig_curve_set    *set              = NULL;
    struct dig_coverage      coverage[WIDTHS] = { { .points = { 0 } } };
    size_t                   digs             = 0;
    assert_int_equal(dig_table_load("tables/reference_rig.sqlite", &set, NULL), DIG_OK);
    for (size_t f = 0; f < 2; f++) {
        glob_t found;
        assert_int_equal(glob(files[f], 0, NULL, &found), 0);
        for (size_t i = 0; i < found.gl_pathc; i++) {
            judge(set, found.gl_pathv[i], coverage);
            digs++;
        }
        globfree(&found);
    }
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double share[WIDTHS];
        for (int w = 0; w < WIDTHS; w++) {
            share[w] = dig_coverage_share(&coverage[w], (enum dig_channel)c);
        }
        print_message("%zu digs, channel %d: %.3f in the band, %.3f were it half as wide, %.3f "
                      "twice\n",
                      digs, c, share[TOLD], share[HALF], share[TWICE]);
        assert_in_range((int)(1000.0 * share[TOLD]), 850, 950);
        assert_true(share[HALF] < 0.85 && share[TWICE] > 0.95);
    }
    assert_true(digs >= 26);
    dig_curve_set_destroy(set);
}
