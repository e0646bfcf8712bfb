// Tests for the steps of closed_loop/fit/likelihood.h: numbers that are known but for a normal
// distribution, and integrated out.

#include "closed_loop/fit/likelihood.h"

#include "closed_loop/fit/posterior.h"
#include "closed_loop/search/null_simulation.h"
#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <math.h>
#include <string.h>

enum { DIGS = 4, STEPS = 2, GRID = 141 };

static const double reach = 7.0; // of the grid, in sigmas

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;
static struct dig_steps    steps;

static int campaigns(void)
{
    return test_is_quick() ? 20 : 300;
}

static const struct dig_hypothesis plain = { .effects = 0 };

// Digs of two trajectories, and two steps that add to both, about as much as a dig scatters: one
// does what another gravel would do, the other anything.
static void make_digs(const struct dig_gravel *const gravel, uint64_t *const seed)
{
    double place[DIG_AXES];
    dig_in_turn(DIGS, gravel, 0, NULL, NULL, seed, measured);
    batch_digs(DIGS, measured, gravel, &batch);
    dig_response_surface_place(world.surface, gravel, place);
    steps = (struct dig_steps){ .steps = STEPS };
    for (size_t g = 0; g < batch.groups; g++) {
        const double           changed[DIG_AXES] = { place[0] + 0.4, place[1], place[2] };
        const size_t           t                 = batch.group[g].trajectory;
        const struct dig_plain here              = dig_plain_of(soil, t, place);
        const struct dig_plain there             = dig_plain_of(soil, t, changed);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            steps.of[0][t][f] = there.feature[f] - here.feature[f];
            steps.of[1][t][f] =
                0.1 * here.amplitude[f / DIG_FEATURE_BINS] * (2.0 * model_uniform(seed) - 0.5);
        }
    }
}

// Takes z steps off the digs of a batch.
static void shift(struct dig_batch *const digs, const double z[STEPS])
{
    for (size_t i = 0; i < digs->digs; i++) {
        const struct dig_group *const group = &digs->group[digs->dig[i].group];
        for (size_t k = 0; k < STEPS; k++) {
            double y[DIG_FEATURES];
            dig_batch_whiten(group, steps.of[k][group->trajectory], y);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                digs->dig[i].y[f] -= z[k] * y[f];
            }
        }
    }
    dig_batch_summarise(digs);
}

static double misfit_of(const struct dig_batch *const digs, const double x[], double z[])
{
    static struct dig_likelihood l;
    static double                r[DIG_LIKELIHOOD_RESIDUALS];
    double                       squares;
    dig_likelihood_init(&l, digs, &plain);
    dig_likelihood_weigh(&l, x);
    dig_likelihood_residual(&l, x, r);
    memcpy(z, r + l.residuals - l.steps, l.steps * sizeof z[0]);
    return dig_likelihood_misfit(&l, r, &squares);
}

// Against the integral itself, over a grid of z, of the likelihood without steps.
TEST(the_likelihood_is_the_integral_over_the_steps)
{
    static struct dig_batch shifted;
    const struct dig_gravel gravel   = { { 0.6, 0.6, 2500 } };
    const double            x[]      = { 0.1, -0.2, 0.15 };
    uint64_t                seed     = 3;
    double                  sum      = 0.0;
    double                  mean[]   = { 0.0, 0.0 };
    double                  z[STEPS] = { 0.0 };
    make_digs(&gravel, &seed);
    const double none = misfit_of(&batch, x, z);
    for (int i = 0; i < GRID * GRID; i++) {
        const double at[STEPS] = { reach * (2.0 * (i % GRID) / (GRID - 1.0) - 1.0),
                                   reach * (2.0 * (i / GRID) / (GRID - 1.0) - 1.0) };
        shifted                = batch;
        shift(&shifted, at);
        const double density =
            exp(0.5 * (none - misfit_of(&shifted, x, z) - at[0] * at[0] - at[1] * at[1]));
        sum += density;
        mean[0] += density * at[0];
        mean[1] += density * at[1];
    }
    const double cell = pow(2.0 * reach / (GRID - 1.0), 2.0) / (2.0 * 3.14159265358979324);
    batch.steps       = &steps;
    const double with = misfit_of(&batch, x, z);
    assert_close(with, none - 2.0 * log(sum * cell), 1e-6);
    assert_close(z[0], mean[0] / sum, 1e-6);
    assert_close(z[1], mean[1] / sum, 1e-6);
    assert_true(fabs(z[0]) > 0.05); // or the test would say nothing
    // The same about another middle, from which so much is taken off.
    steps.middle[0] = -0.7;
    steps.middle[1] = 0.4;
    shifted         = batch;
    shift(&shifted, (double[STEPS]){ 0.7, -0.4 });
    double off[STEPS];
    assert_close(misfit_of(&shifted, x, off), with, 1e-6);
    assert_close(off[0], z[0], 1e-6); // from the middle
    assert_close(off[1], z[1], 1e-6);
}

// Digs drawn with steps of the prior: what is fitted is off by what the covariance says. One of
// them does what another gravel would do.
TEST(fitted_steps_are_as_far_off_as_is_said)
{
    static struct dig_batch drawn;
    const struct dig_gravel gravel     = { { 0.6, 0.6, 2500 } };
    uint64_t                seed       = 8;
    double                  sum[STEPS] = { 0.0 };
    make_digs(&gravel, &seed);
    const struct dig_fitted truth = fit_plain(&batch);
    for (int c = 0; c < campaigns(); c++) {
        double                  z[STEPS];
        double                  covariance[STEPS * STEPS];
        struct dig_fitted       fitted;
        struct dig_common_error error[DIG_TRAJECTORY_MAX];
        drawn = batch;
        dig_hypothesis_errors(&batch, &truth, error);
        dig_null_simulation_digs(&batch, &truth, error, &seed, &drawn);
        for (size_t k = 0; k < STEPS; k++) {
            z[k] = -model_normal(&seed);
        }
        shift(&drawn, z);
        drawn.steps = &steps;
        dig_hypothesis_fit(&drawn, &plain, truth.number, DIG_FIT_THOROUGH, &fitted);
        dig_posterior_intervals(&drawn, (uint64_t)c, &fitted, covariance);
        for (size_t k = 0; k < STEPS; k++) {
            sum[k] += pow(fitted.z[k] + z[k], 2.0) / covariance[k * STEPS + k] / campaigns();
        }
    }
    // A simulation draws the steps, too, about their middle.
    double left[2] = { 0.0, 0.0 };
    batch.steps    = &steps;
    for (int c = 0; c < campaigns(); c++) {
        struct dig_fitted       fitted;
        struct dig_common_error error[DIG_TRAJECTORY_MAX];
        steps.middle[1] = c % 2 == 0 ? 0.0 : 5.0;
        drawn           = batch;
        dig_hypothesis_errors(&batch, &truth, error);
        dig_null_simulation_digs(&batch, &truth, error, &seed, &drawn);
        dig_hypothesis_fit(&drawn, &plain, truth.number, DIG_FIT_THOROUGH, &fitted);
        left[c % 2] += fitted.squares / (0.5 * campaigns());
    }
    print_message("squares left about a middle of 0 and of 5: %.1f, %.1f\n", left[0], left[1]);
    assert_true(fabs(left[0] - left[1]) < 4.0);
    // Chi-squared over its degrees of freedom, to three sigmas.
    const double chance = 3.0 * sqrt(2.0 / campaigns());
    print_message("squares of the steps' errors over expected: %.2f, %.2f\n", sum[0], sum[1]);
    assert_true(fabs(sum[0] - 1.0) < 0.1 + chance);
    assert_true(fabs(sum[1] - 1.0) < 0.1 + chance);
}

// The integral is exact, and the covariance the digs' own, where the table's S is known to be
// theirs.
static int known_scatter_setup(void **state)
{
    const int status = world_setup(state);
    memset(world.scatter->freedom, 0, sizeof world.scatter->freedom);
    memset(world.scatter->residuals, 0, sizeof world.scatter->residuals);
    return status;
}

TESTS_WITH(known_scatter_setup, world_teardown)
