#include "closed_loop/fit/hypothesis.h"

#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <string.h>

enum { DIGS = 4, WORLDS = 10, MANY = 400 };

// What two DEM codes may differ by from bin to bin stands in the noise of every group:
// docs/numerics/closed_loop.md.
static const double rough = 0.01;

static struct dig_measured measured[DIGS];

// Plain digs, every force times so much.
static void dig(const struct dig_gravel *const gravel, const double larger, uint64_t seed)
{
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] = made_dig(gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                measured[i].value[c][k] *= larger;
            }
        }
    }
}

static void true_features(const struct dig_gravel *const gravel, double feature[DIG_FEATURES])
{
    static double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    uint64_t      seed = 77;
    memset(mean, 0, sizeof mean);
    for (int i = 0; i < MANY; i++) {
        const struct dig_measured one = made_dig(gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                mean[c][k] += one.value[c][k] / MANY;
            }
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])mean, feature);
}

// Mean square of what tables of other packings say of this gravel beside the truth, in the group's
// units: by making the tables.
static double made_variance(const struct dig_group *const  group,
                            const struct dig_gravel *const gravel)
{
    double truth[DIG_FEATURES];
    double y_true[DIG_FEATURES];
    double sum = 0.0;
    true_features(gravel, truth);
    dig_batch_whiten(group, truth, y_true);
    for (uint64_t w = 0; w < WORLDS; w++) {
        struct made_world other = made_world(1000 + w);
        double            place[DIG_AXES], feature[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double            y[DIG_FEATURES];
        dig_response_surface_place(other.surface, gravel, place);
        dig_response_surface_features(other.surface, MADE_ACTUAL, place, feature, size);
        dig_batch_whiten(group, feature, y);
        for (size_t k = 0; k < group->features; k++) {
            sum += (y[k] - y_true[k]) * (y[k] - y_true[k]) / (double)group->features / WORLDS;
        }
        made_world_finish(&other);
    }
    return sum;
}

// The unit of a group is what its digs scatter by. Beside digs three times as large as any the
// table holds, what the table does not know counts for so much less.
TEST(the_tables_error_counts_for_less_beside_larger_digs)
{
    const struct dig_gravel gravel = { { 0.6, 0.55, 3900 } };
    for (double larger = 1.0; larger < 4.0; larger += 2.0) {
        static struct dig_batch batch;
        dig(&gravel, larger, 9);
        batch_digs(DIGS, measured, &gravel, &batch);
        const struct dig_fitted fitted = fit_plain(&batch);
        const struct dig_gravel found  = dig_response_surface_gravel(world.surface, fitted.number);
        const double            truth  = made_variance(&batch.group[0], &found);
        struct dig_common_error error[DIG_TRAJECTORY_MAX];
        dig_hypothesis_errors(&batch, &fitted, error);
        const double said = error[0].even - rough;
        assert_true(said > 0.5 * truth && said < 2.0 * truth);
    }
}

// r' C^-1 r, where C^-1 = M' M.
static double over_covariance(const size_t n, const double inverse[], const double r[])
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            for (size_t k = i > j ? i : j; k < n; k++) {
                sum += r[i] * inverse[k * n + i] * inverse[k * n + j] * r[j];
            }
        }
    }
    return sum;
}

// The squares of the likelihood as its header has it, worked out anew at other numbers than those
// of the fit that tells the covariance; *means: of that, the means'.
static double squares_of(const struct dig_batch *const b, const struct dig_fitted *const by,
                         const struct dig_fitted *const f, double *const means)
{
    double                  sum = 0.0;
    struct dig_common_error error[DIG_TRAJECTORY_MAX];
    *means = 0.0;
    dig_hypothesis_errors(b, by, error);
    for (size_t g = 0; g < b->groups; g++) {
        const struct dig_group *const group = &b->group[g];
        double                        model[DIGS][DIG_FEATURES];
        double                        rest[DIG_FEATURES];
        double                        mean[DIG_FEATURES] = { 0.0 };
        for (size_t i = 0; i < b->digs; i++) {
            double feature[DIG_FEATURES];
            dig_fitted_features(soil, f, &b->measured[i], feature);
            dig_batch_whiten(group, feature, model[i]);
            for (size_t k = 0; b->dig[i].group == g && k < group->features; k++) {
                mean[k] += model[i][k] / (double)group->digs;
            }
        }
        for (size_t k = 0; k < group->features; k++) {
            rest[k] = group->mean[k] - mean[k];
            for (size_t i = 0; i < b->digs; i++) {
                sum += b->dig[i].group == g
                           ? pow(b->dig[i].y[k] - group->mean[k] - (model[i][k] - mean[k]), 2.0)
                           : 0.0;
            }
        }
        *means += over_covariance(group->features, error[g].inverse, rest);
    }
    return sum + *means;
}

// Whether there are clearly smaller squares a little off.
static bool is_lower_beside(const struct dig_batch *const b, const struct dig_fitted *const f)
{
    bool lower = false;
    for (size_t i = 0; i < DIG_AXES + f->hypothesis.effects; i++) {
        const size_t j = i < DIG_AXES ? i : DIG_AT_U(i - DIG_AXES);
        for (double step = -0.02; step <= 0.02; step += 0.04) {
            struct dig_fitted off = *f;
            double            means;
            off.number[j] += step;
            lower = lower || (fabs(off.number[j]) < 1.0 &&
                              squares_of(b, f, &off, &means) < f->squares - 0.02);
        }
    }
    return lower;
}

// What a fit keeps of the numbers it has tried is theirs: it ends where the squares are least, and
// tells those of that place.
TEST(a_fit_ends_where_the_squares_it_tells_are_least)
{
    static const struct dig_hypothesis all[] = {
        { .effects = 0 },
        { .effects = 1, .effect = { DIG_EFFECT_LAYERING } },
        { .effects = 1, .effect = { DIG_EFFECT_WEAR } },
        { .effects = 2, .effect = { DIG_EFFECT_COHESION, DIG_EFFECT_WEAR } },
    };
    const struct dig_gravel gravel                        = { { 0.6, 0.55, 2500 } };
    const double            start[DIG_HYPOTHESIS_NUMBERS] = { 0.2, -0.3, 0.1, 0.1, 1.0, 0.05, 1.0 };
    static struct dig_batch batch;
    dig(&gravel, 1.3, 17);
    for (size_t i = 0; i < DIGS; i++) {
        measured[i].order = i;
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    for (size_t h = 0; h < sizeof all / sizeof all[0]; h++) {
        struct dig_fitted fitted;
        dig_hypothesis_fit(&batch, &all[h], start, DIG_FIT_BARE, &fitted);
        double       means;
        const double squares = squares_of(&batch, &fitted, &fitted, &means);
        assert_close(fitted.squares, squares, 1e-9 * fitted.squares);
        assert_close(fitted.means, means, 1e-9 * fitted.squares);
        assert_false(is_lower_beside(&batch, &fitted));
    }
}

// A rock's template may be farther off than others'.
TEST(a_rock_of_no_size_makes_no_room_for_what_is_beside_it)
{
    static struct dig_batch batch;
    const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
    dig(&gravel, 1.0, 10);
    batch_digs(DIGS, measured, &gravel, &batch);
    struct dig_fitted one   = { .hypothesis = { .effects = 1, .effect = { DIG_EFFECT_LAYERING } } };
    one.number[DIG_AT_U(0)] = 0.5;
    one.number[DIG_AT_CONTRAST(0)] = 1.0;
    struct dig_fitted two          = one;
    two.hypothesis.effects         = 2;
    two.hypothesis.effect[1]       = DIG_EFFECT_OBSTACLE;
    two.number[DIG_AT_CONTRAST(1)] = 1.0;
    struct dig_common_error alone[DIG_TRAJECTORY_MAX], beside[DIG_TRAJECTORY_MAX];
    dig_hypothesis_errors(&batch, &one, alone);
    dig_hypothesis_errors(&batch, &two, beside);
    double most = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        most = fmax(most, fabs(alone[0].size[1][f]));
        assert_close(beside[0].size[1][f], alone[0].size[1][f], 1e-12);
    }
    assert_true(most > 0.0);
}

// Of tables whose frictions begin near nothing and far from it.
TEST(a_gravel_outside_the_grid_has_no_less_than_no_friction)
{
    static const double               first[]    = { 0.05, 0.1, 0.3, 0.5 };
    const struct dig_hypothesis       hypothesis = { .outside = true };
    const struct dig_curve_set *const made       = soil->surface->set;
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        double rolling[] = { first[i], 0.9 };
        double low[DIG_HYPOTHESIS_NUMBERS], high[DIG_HYPOTHESIS_NUMBERS];

        struct dig_curve_set               set = *made;
        static struct dig_response_surface surface;
        static struct dig_soil             beside;
        set.axis[DIG_AXIS_ROLLING]       = rolling;
        set.axis_count[DIG_AXIS_ROLLING] = 2;
        surface.set                      = &set;
        beside.surface                   = &surface;
        dig_hypothesis_bounds(&beside, &hypothesis, low, high);
        const struct dig_gravel least = dig_response_surface_gravel(&surface, low);
        const struct dig_gravel most  = dig_response_surface_gravel(&surface, high);
        for (int a = 0; a < DIG_AXES; a++) {
            assert_true(least.value[a] >= -1e-12);
            assert_true(least.value[a] < set.axis[a][0]);
            assert_true(most.value[a] > set.axis[a][set.axis_count[a] - 1]);
        }
    }
}

TESTS_WITH(world_setup, world_teardown)
