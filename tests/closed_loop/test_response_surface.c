#include "closed_loop/model/response_surface.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

#include <string.h>

static struct dig_curve_set       *set;
static struct dig_response_surface surface;

static void make(const struct made_options options)
{
    made_table_destroy(set);
    set = made_table(&options);
    assert_int_equal(dig_response_surface_fit(set, &surface), DIG_OK);
}

static int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    return 0;
}

// The made table is linear in friction and rolling friction and proportional to density: between
// its points the surface must agree with the closed form.
TEST(between_the_points_it_is_the_truth)
{
    make((struct made_options){ .relative_sd = 0.1, .packings = 5 });
    const struct dig_gravel gravel[] = { { { 0.4, 0.25, 2000 } }, { { 0.75, 0.8, 3300 } } };
    for (size_t i = 0; i < 2; i++) {
        for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
            double place[DIG_AXES];
            double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
            dig_response_surface_place(&surface, &gravel[i], place);
            dig_response_surface_curve(&surface, t, place, curve);
            for (size_t k = 0; k < DIG_CURVE_POINTS; k += 15) {
                const double truth = made_moment_Nm(&gravel[i], (enum made_trajectory)t,
                                                    (double)k / (DIG_CURVE_POINTS - 1), 0.0);
                assert_close(curve[0][k], truth, 0.02 * fabs(truth) + 0.01);
                assert_close(curve[1][k], -8.0 * truth, 8.0 * (0.02 * fabs(truth) + 0.01));
            }
        }
    }
}

TEST(a_place_is_a_gravel_and_back)
{
    make((struct made_options){ .packings = 2, .one_density = true });
    const struct dig_gravel gravel = { { 0.42, 0.87, 2500 } };
    double                  place[DIG_AXES];
    dig_response_surface_place(&surface, &gravel, place);
    assert_close(place[DIG_AXIS_DENSITY_kgpm3], 0.0, 0.0);
    const struct dig_gravel back = dig_response_surface_gravel(&surface, place);
    for (int a = 0; a < DIG_AXES; a++) {
        assert_close(back.value[a], gravel.value[a], 1e-9);
    }
}

// The made table is proportional to density: of three densities as copies the surface is as sure as
// of one, at each.
TEST(copies_vouch_for_nothing_twice)
{
    const struct dig_gravel one = { { 0.69, 0.37, 2500 } };
    double                  place[DIG_AXES], feature[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
    make((struct made_options){ .packings = 6, .one_density = true });
    dig_response_surface_place(&surface, &one, place);
    dig_response_surface_features(&surface, MADE_ACTUAL, place, feature, size);
    const double noise = dig_response_surface_noise(&surface, MADE_ACTUAL, place);
    make((struct made_options){ .packings = 6 });
    set->copies = 3;
    assert_int_equal(dig_response_surface_fit(set, &surface), DIG_OK);
    for (double density = 1200; density < 5000; density += 700) {
        struct dig_gravel other             = one;
        other.value[DIG_AXIS_DENSITY_kgpm3] = density;
        const double times                  = density / 2500;
        double       scaled[DIG_FEATURES];
        dig_response_surface_place(&surface, &other, place);
        dig_response_surface_features(&surface, MADE_ACTUAL, place, scaled, size);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            assert_close(scaled[f], times * feature[f], 1e-6 * size[f / DIG_FEATURE_BINS]);
        }
        assert_close(dig_response_surface_noise(&surface, MADE_ACTUAL, place), noise, 1e-6 * noise);
    }
}

// Digs whose size goes to and fro over four frictions, as no parabola does, in so many beds that
// what a table is before it is dug does not count.
TEST(a_table_of_few_gravels_bends_as_it_was_dug)
{
    static const double log_times[] = { -0.2, 0.17, -0.17, 0.2 };
    make((struct made_options){ .packings = 10000, .one_density = true });
    for (size_t e = 0; e < set->entries; e++) {
        struct dig_curve *const curve = &set->curve[e * set->trajectories];
        const float             times = (float)exp(log_times[e / set->axis_count[1]]);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                curve->mean[c][k] *= times;
            }
        }
    }
    assert_int_equal(dig_response_surface_fit(set, &surface), DIG_OK);
    for (size_t e = 0; e < set->entries; e++) {
        double place[DIG_AXES], feature[DIG_FEATURES];
        double size[DIG_FORCE_CHANNELS], dug[DIG_FORCE_CHANNELS];
        dig_response_surface_place(&surface, &set->gravel[e], place);
        dig_response_surface_features(&surface, 0, place, feature, size);
        dig_features_of_table(
            (const float(*)[DIG_CURVE_POINTS])set->curve[e * set->trajectories].mean, feature);
        dig_features_amplitude(feature, NULL, dug);
        assert_close(size[0], dug[0], 0.02 * dug[0]);
    }
}

// Features are linear in the curve, so those of the surface are those of its curve.
TEST(features_are_those_of_the_curve)
{
    make((struct made_options){ .packings = 3 });
    const double place[DIG_AXES] = { 0.3, -0.4, 0.1 };
    double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double       of_curve[DIG_FEATURES], feature[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
    dig_response_surface_curve(&surface, MADE_ACTUAL, place, curve);
    dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, of_curve);
    dig_response_surface_features(&surface, MADE_ACTUAL, place, feature, size);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        assert_close(feature[f], of_curve[f], 1e-9 * size[f / DIG_FEATURE_BINS]);
    }
}

// How much of an entry's own size the surface takes over there: by making the entry larger.
static double share_taken_over(const size_t e)
{
    enum { BEFORE, AFTER, TIMES };
    static const float larger = 1.01F;
    const size_t       slot   = e * set->trajectories;
    double             log_size[TIMES];
    for (int time = BEFORE; time < TIMES; time++) {
        double place[DIG_AXES], feature[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        assert_int_equal(dig_response_surface_fit(set, &surface), DIG_OK);
        dig_response_surface_place(&surface, &set->gravel[e], place);
        dig_response_surface_features(&surface, 0, place, feature, size);
        log_size[time] = log(size[DIG_CHANNEL_MY_Nm]);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                float *const value = &set->curve[slot].mean[c][k];
                *value             = time == BEFORE ? *value * larger : *value / larger;
            }
        }
    }
    return (log_size[AFTER] - log_size[BEFORE]) / log((double)larger);
}

// An entry of n packings, each of variance 1, that gives the surface a share h of itself: the
// surface's variance there is h / n.
TEST(its_noise_is_what_it_takes_over_from_each_entry)
{
    make((struct made_options){ .packings = 4 });
    for (size_t e = 0; e < set->entries; e += 5) {
        double place[DIG_AXES];
        dig_response_surface_place(&surface, &set->gravel[e], place);
        assert_close(dig_response_surface_noise(&surface, 0, place), share_taken_over(e) / 4.0,
                     1e-3);
    }
}

TEST(too_few_entries_are_refused)
{
    make((struct made_options){ .packings = 4 });
    for (size_t e = 5; e < set->entries; e++) {
        for (size_t t = 0; t < set->trajectories; t++) {
            set->packings[e * set->trajectories + t] = 0;
        }
    }
    assert_int_equal(dig_response_surface_fit(set, &surface), DIG_EINVAL);
    made_table_destroy(set);
    set = made_table(&(struct made_options){ .packings = 4 });
    memset(set->packings, 0, set->entries * set->trajectories * sizeof *set->packings);
    set->copies = 3;
    for (size_t e = 0; e < 5 * set->copies; e++) {
        set->packings[e * set->trajectories] = 4;
    }
    assert_int_equal(dig_response_surface_fit(set, &surface), DIG_EINVAL);
}

TESTS_WITH(NULL, tear_down)
