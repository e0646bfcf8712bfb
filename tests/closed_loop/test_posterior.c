// Tests for closed_loop/fit/posterior.h.

#include "closed_loop/fit/posterior.h"

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/search/null_simulation.h"
#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { DIGS = 4, CAMPAIGNS = 100 };

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;

static const struct dig_hypothesis plain = { .effects = 0 };

static struct dig_fitted fit_digs(const struct dig_gravel *const gravel, uint64_t *const seed)
{
    dig_in_turn(DIGS, gravel, 0, NULL, NULL, seed, measured);
    batch_digs(DIGS, measured, gravel, &batch);
    return fit_plain(&batch);
}

// Digs drawn from the model itself at places of its prior: nine of ten intervals hold the place,
// to three sigmas of a binomial, more where a bound is counted in.
TEST(nine_intervals_of_ten_hold_the_truth)
{
    static struct dig_batch drawn;
    const struct dig_gravel gravel    = { { 0.6, 0.6, 2500 } };
    uint64_t                seed      = 21;
    struct dig_fitted       truth     = fit_digs(&gravel, &seed);
    double                  held      = 0.0;
    const int               campaigns = test_is_quick() ? CAMPAIGNS / 4 : CAMPAIGNS;
    for (int c = 0; c < campaigns; c++) {
        struct dig_fitted       fitted;
        struct dig_common_error error[DIG_TRAJECTORY_MAX];
        for (size_t a = 0; a < DIG_AXES; a++) {
            truth.number[a] = 2.0 * model_uniform(&seed) - 1.0;
        }
        drawn = batch;
        dig_hypothesis_errors(&batch, &truth, error);
        dig_null_simulation_digs(&batch, &truth, error, &seed, &drawn);
        dig_hypothesis_fit(&drawn, &plain, truth.number, DIG_FIT_THOROUGH, &fitted);
        dig_posterior_intervals(&drawn, (uint64_t)c, &fitted, NULL);
        for (size_t a = 0; a < DIG_AXES; a++) {
            const double at = truth.number[a];
            assert_true(fitted.low[a] <= fitted.number[a] && fitted.number[a] <= fitted.high[a]);
            held += at >= fitted.low[a] && at <= fitted.high[a] ? 1.0 : 0.0;
        }
    }
    const double n = (double)(campaigns * DIG_AXES);
    assert_true(held / n > 0.9 - 3.0 * sqrt(0.09 / n) && held / n < 0.99);
}

// The posterior itself, on a grid of places.
static double density_at(struct dig_likelihood *const l, const struct dig_fitted *const fitted,
                         const double x[DIG_AXES])
{
    static double r[DIG_LIKELIHOOD_RESIDUALS];
    double        squares;
    dig_likelihood_residual(l, x, r);
    return exp(0.5 * (fitted->misfit - dig_likelihood_misfit(l, r, &squares)));
}

// Of a bent ridge that leans on two bounds, whatever the seed.
TEST(an_interval_holds_nine_tenths_of_the_posterior)
{
    enum { SEEDS = 10 };
    static struct dig_likelihood l;
    static struct dig_fitted     fitted[SEEDS];
    const struct dig_gravel      gravel                  = { { 0.34, 0.6, 3600 } };
    uint64_t                     seed                    = 5;
    const struct dig_fitted      found                   = fit_digs(&gravel, &seed);
    double                       inside[SEEDS][DIG_AXES] = { { 0.0 } };
    double                       all                     = 0.0;
    const int                    grid                    = test_is_quick() ? 31 : 61;
    for (size_t s = 0; s < SEEDS; s++) {
        fitted[s] = found;
        dig_posterior_intervals(&batch, s, &fitted[s], NULL);
    }
    dig_likelihood_init(&l, &batch, &plain);
    dig_likelihood_weigh(&l, found.number);
    for (int i = 0; i < grid * grid * grid; i++) {
        const double x[DIG_AXES] = { 2.0 * (i % grid) / (grid - 1.0) - 1.0,
                                     2.0 * (i / grid % grid) / (grid - 1.0) - 1.0,
                                     2.0 * (i / grid / grid) / (grid - 1.0) - 1.0 };
        const double density     = density_at(&l, &found, x);
        all += density;
        for (size_t j = 0; j < SEEDS * DIG_AXES; j++) {
            const size_t s = j / DIG_AXES;
            const size_t a = j % DIG_AXES;
            inside[s][a] += x[a] >= fitted[s].low[a] && x[a] <= fitted[s].high[a] ? density : 0.0;
        }
    }
    for (size_t s = 0; s < SEEDS; s++) {
        for (size_t a = 0; a < DIG_AXES; a++) {
            const double share = inside[s][a] / all;
            const bool   leans = fitted[s].low[a] <= -1.0 || fitted[s].high[a] >= 1.0;
            // What is drawn has an error of its own, and so has the grid; a bound is counted in.
            assert_true(share > 0.86 && (share < 0.95 || leans));
        }
    }
}

// A recording of others may hold anything: of digs beyond all numbers the posterior still ends.
TEST(digs_beyond_all_numbers_leave_the_whole_of_the_bounds)
{
    const struct dig_gravel gravel = { { 0.6, 0.6, 2500 } };
    uint64_t                seed   = 3;
    struct dig_fitted       fitted = fit_digs(&gravel, &seed);
    batch.dig[0].y[0]              = 1e200;
    dig_batch_summarise(&batch);
    (void)alarm(60);
    dig_posterior_intervals(&batch, 1, &fitted, NULL);
    (void)alarm(0);
    for (size_t a = 0; a < DIG_AXES; a++) {
        assert_true(fitted.high[a] - fitted.low[a] > 1.5);
    }
}

TESTS_WITH(world_setup, world_teardown)
