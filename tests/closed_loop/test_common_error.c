// Tests for closed_loop/fit/common_error.h.

#include "closed_loop/fit/common_error.h"

#include "core/chance.h"
#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <math.h>
#include <string.h>

enum { DIGS = 3, DRAWS = 20000 };

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;

static const struct dig_group *make_group(void)
{
    const struct dig_gravel gravel = { { 0.5, 0.5, 2500 } };
    uint64_t                seed   = 3;
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] = made_dig(&gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    return &batch.group[0];
}

// A factor that changes along the dig and from channel to channel.
static struct dig_common_error some_error(const struct dig_group *const group)
{
    struct dig_common_error error = { .even = 0.05, .shift = { .shifts = 2 } };
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const double amplitude = group->amplitude[f / DIG_FEATURE_BINS];
        error.size[0][f]       = 0.1 * amplitude * cos(0.3 * (double)f);
        error.size[1][f]       = f % DIG_FEATURE_BINS > 5 ? 0.2 * amplitude : 0.0;
        error.shift.of[1][f]   = 0.1 * amplitude * sin(0.5 * (double)f);

        error.shift.as_gravels[2][f] = 0.1 * amplitude * cos(0.7 * (double)f);
    }
    dig_common_error_build(group, &error);
    return error;
}

// What is drawn has the covariance that is built: the squares of the mean of n digs, the even part
// and the smooth one, over it are chi squared, in the mean and in their variance.
TEST(what_is_drawn_has_the_covariance_that_is_built)
{
    const struct dig_group *const group = make_group();
    const struct dig_common_error error = some_error(group);
    const double                  n     = (double)group->features;
    uint64_t                      seed  = 11;
    double                        sum   = 0.0;
    double                        sum2  = 0.0;
    for (int i = 0; i < DRAWS; i++) {
        double y[DIG_FEATURES];
        dig_common_error_draw(group, &error, &seed, y);
        for (size_t k = 0; k < group->features; k++) {
            y[k] += sqrt(1.0 / DIGS + error.even) * model_normal(&seed);
        }
        const double squares = dig_common_error_squares(group, &error, y);
        sum += squares / DRAWS;
        sum2 += squares * squares / DRAWS;
    }
    // Five standard errors of mean and variance of chi squared.
    assert_close(sum, n, 5.0 * sqrt(2.0 * n / DRAWS));
    assert_close(sum2 - sum * sum, 2.0 * n, 5.0 * 2.0 * n * sqrt((2.0 + 12.0 / n) / DRAWS));
}

// What a factor may be wrong by, all along the dig alike, is told by no number of digs: the squares
// of ten times as much are near those of ten sigmas, however small the scatter is beside it.
TEST(a_smooth_factor_is_as_uncertain_as_its_size)
{
    const struct dig_group *const group = make_group();
    struct dig_common_error       error = { .even = 0.0 };
    double                        ten[DIG_FEATURES];
    double                        y[DIG_FEATURES];
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        error.size[0][f] = 20.0 * group->amplitude[f / DIG_FEATURE_BINS];
        ten[f]           = 10.0 * error.size[0][f];
    }
    dig_common_error_build(group, &error);
    dig_batch_whiten(group, ten, y);
    const double squares = dig_common_error_squares(group, &error, y);
    assert_true(squares > 100.0 && squares < 4.0 * 100.0);
}

// A dig off by so many sigmas of a shift, and by nothing else, is as far off as that says.
TEST(a_shift_is_as_uncertain_as_it_says)
{
    const struct dig_group *const group = make_group();
    struct dig_common_error       error = { .even = 1e-4, .shift = { .shifts = 3 } };
    double                        three[DIG_FEATURES];
    double                        y[DIG_FEATURES];
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        error.shift.of[2][f] = 20.0 * group->amplitude[f / DIG_FEATURE_BINS] * cos(0.4 * (double)f);
        three[f]             = 3.0 * error.shift.of[2][f];
    }
    dig_common_error_build(group, &error);
    dig_batch_whiten(group, three, y);
    assert_close(dig_common_error_squares(group, &error, y), 9.0, 1e-2);
}

// Beds that differ as gravels do make the gravel less certain, and nothing else: a fit of the
// gravel leaves nothing of it.
TEST(what_beds_differ_by_as_gravels_is_no_noise)
{
    const struct dig_group *const group = make_group();
    struct dig_common_error       error = { .even = 0.1 };
    double                        y[DIG_FEATURES];
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        error.shift.as_gravels[0][f] = group->amplitude[f / DIG_FEATURE_BINS];
    }
    dig_common_error_build(group, &error);
    dig_batch_whiten(group, error.shift.as_gravels[0], y);
    assert_true(dig_common_error_squares(group, &error, y) < 1.0);
    assert_close(error.noise, 0.1, 1e-12);
}

// What the two parts and the shift of some_error() have between two features, units of the table.
static double between(const struct dig_common_error *const error, const size_t a, const size_t b)
{
    const double apart = fabs((double)(a % DIG_FEATURE_BINS) - (double)(b % DIG_FEATURE_BINS));
    const double alike = (a / DIG_FEATURE_BINS == b / DIG_FEATURE_BINS ? 1.0 : 0.7) *
                         exp(-0.5 * apart * apart / (2.5 * 2.5));
    return (error->size[0][a] * error->size[0][b] + error->size[1][a] * error->size[1][b]) *
               (alike + (a == b ? 1e-6 : 0.0)) +
           error->shift.of[1][a] * error->shift.of[1][b] +
           error->shift.as_gravels[2][a] * error->shift.as_gravels[2][b];
}

// Digs that lack bins at their ends have the covariance of those that they have: C x over C is
// x' C x, C by its formula.
TEST(a_covariance_is_of_the_features_that_were_measured)
{
    static struct dig_group group;
    struct dig_gravel       gravel = { { 0.5, 0.5, 2500 } };
    (void)make_group();
    measured[1].first = 0.25;
    measured[2].last  = 0.85;
    batch_digs(DIGS, measured, &gravel, &batch);
    group = batch.group[0];
    assert_true(group.features < DIG_FEATURES && group.feature[0] > 0);
    const struct dig_common_error error = some_error(&group);
    double                        x[DIG_FEATURES];
    double                        along[DIG_FEATURES] = { 0.0 }; // W' x
    double                        y[DIG_FEATURES]     = { 0.0 };
    double                        squares             = 0.0;
    for (size_t i = 0; i < group.features; i++) {
        x[i] = cos(1.3 * (double)i);
        for (size_t k = 0; k <= i; k++) {
            along[k] += group.whiten[k][i] * x[i];
        }
    }
    for (size_t i = 0; i < group.features; i++) {
        y[i] = (1.0 / DIGS + error.even) * x[i];
        for (size_t k = 0; k <= i; k++) {
            for (size_t l = 0; l < group.features; l++) {
                y[i] += group.whiten[k][i] * between(&error, group.feature[k], group.feature[l]) *
                        along[l];
            }
        }
        squares += x[i] * y[i];
    }
    assert_close(dig_common_error_squares(&group, &error, y), squares, 1e-9 * squares);
}

TEST(without_parts_only_scatter_and_the_even_part_are_left)
{
    const struct dig_group *const group           = make_group();
    struct dig_common_error       error           = { .even = 0.1 };
    double                        y[DIG_FEATURES] = { 0.0 };
    dig_common_error_build(group, &error);
    y[4] = 3.0;
    assert_close(dig_common_error_squares(group, &error, y), 9.0 / (1.0 / DIGS + 0.1), 1e-9);
    assert_close(error.log_det, (double)group->features * log(1.0 / DIGS + 0.1), 1e-9);
    assert_close(error.noise, 0.1, 1e-12);
}

TESTS_WITH(world_setup, world_teardown)
