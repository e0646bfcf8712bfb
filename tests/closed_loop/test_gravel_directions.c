#include "closed_loop/model/gravel_directions.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

#include <math.h>
#include <string.h>

static struct dig_curve_set       *set;
static struct dig_response_surface surface;

// A wave along the dig that friction tightens, rolling friction moves and density enlarges: what an
// axis changes is another curve at each gravel.
static void make_waves(const struct dig_gravel *const gravel, struct dig_curve *const curve)
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double progress = (double)k / (DIG_CURVE_POINTS - 1);
            const double phase    = (3.0 + 4.0 * gravel->value[DIG_AXIS_FRICTION]) * progress +
                                 2.0 * gravel->value[DIG_AXIS_ROLLING] + (double)c;
            curve->mean[c][k] =
                (float)(gravel->value[DIG_AXIS_DENSITY_kgpm3] / 2500.0 * (2.0 + sin(phase)));
        }
    }
}

static int set_up(void **state)
{
    (void)state;
    set = made_table(&(struct made_options){ .relative_sd = 0.15, .packings = 5 });
    for (size_t e = 0; e < set->entries; e++) {
        for (size_t t = 0; t < set->trajectories; t++) {
            make_waves(&set->gravel[e], &set->curve[e * set->trajectories + t]);
        }
    }
    return dig_response_surface_fit(set, &surface);
}

static int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    return 0;
}

// An S whose features are of several sizes, neighbours correlated by a half: its L.
static void make_lower(double lower[DIG_FEATURES][DIG_FEATURES])
{
    memset(lower, 0, DIG_FEATURES * sizeof lower[0]);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        lower[f][f] = 0.1 + 0.01 * (double)f;
        if (f > 0) {
            lower[f][f - 1] = 0.5 * lower[f][f];
        }
    }
}

// Squared length of L^-1 r.
static double whitened2(const double lower[DIG_FEATURES][DIG_FEATURES], const double r[])
{
    double before = 0.0;
    double sum    = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        before = (r[f] - (f > 0 ? lower[f][f - 1] * before : 0.0)) / lower[f][f];
        sum += before * before;
    }
    return sum;
}

// What a dig at a place changes where its gravel moves by so much along each axis, over amplitude.
static void change(const size_t t, const double place[DIG_AXES], const double by[DIG_AXES],
                   double of[DIG_FEATURES])
{
    double amplitude[DIG_FORCE_CHANNELS], ends[2][DIG_FEATURES];
    for (size_t side = 0; side < 2; side++) {
        double at[DIG_AXES];
        for (size_t a = 0; a < DIG_AXES; a++) {
            at[a] = place[a] + (side == 0 ? -0.5 : 0.5) * by[a];
        }
        dig_response_surface_features(&surface, t, at, ends[side], amplitude);
    }
    dig_response_surface_features(&surface, t, place, of, amplitude);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        of[f] = (ends[1][f] - ends[0][f]) / amplitude[f / DIG_FEATURE_BINS];
    }
}

// Shares of a change of the gravel at one place that lie in the directions taken at another: 1
// where they are the same. The variance is their mean.
static double share_within(const double changed[DIG_AXES], const double taken[DIG_AXES])
{
    static const double by[] = { 0.004, -0.006, 0.005 };
    double              lower[DIG_FEATURES][DIG_FEATURES];
    double              residual[DIG_FEATURES];
    make_lower(lower);
    change(MADE_ACTUAL, changed, by, residual);
    const double(*const l)[DIG_FEATURES] = (const double(*)[DIG_FEATURES])lower;
    return DIG_AXES * dig_gravel_directions_variance(&surface, MADE_ACTUAL, taken, l, residual) /
           whitened2(l, residual);
}

TEST(a_gravel_that_moves_stays_within_the_directions_of_its_place_alone)
{
    static const double place[][DIG_AXES] = { { 0.6, 0.5, -0.4 },
                                              { -0.5, -0.6, 0.3 },
                                              { 0.1, -0.7, 0.6 } };
    for (size_t i = 0; i < 3; i++) {
        for (size_t k = 0; k < 3; k++) {
            const double share = share_within(place[i], place[k]);
            assert_true(i == k ? fabs(1.0 - share) < 5e-4 : share < 0.995);
        }
        const double corner[DIG_AXES] = { -1.0, -1.0, -1.0 };
        assert_true(share_within(place[i], corner) < 0.99);
    }
}

// Of one length, at right angles; the third, a sum of the others, is none.
TEST(directions_are_orthogonal_and_a_sum_of_others_is_none)
{
    double lower[DIG_FEATURES][DIG_FEATURES];
    double u[DIG_AXES][DIG_FEATURES];
    make_lower(lower);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        u[0][f] = 1.0 + 0.1 * (double)f;
        u[1][f] = sin(0.4 * (double)f);
        u[2][f] = 3.0 * u[0][f] - 2.0 * u[1][f];
    }
    dig_gravel_directions_whiten((const double(*)[DIG_FEATURES])lower, u);
    for (size_t a = 0; a < DIG_AXES; a++) {
        for (size_t b = 0; b < DIG_AXES; b++) {
            double product = 0.0;
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                product += u[a][f] * u[b][f];
            }
            assert_close(product, a == b && a < 2 ? 1.0 : 0.0, 1e-9);
        }
    }
}

TESTS_WITH(set_up, tear_down)
