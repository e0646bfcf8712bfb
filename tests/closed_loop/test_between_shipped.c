// What the table that ships is uncertain by between its points, by our own digs there
// (tests/data/between). The size of the shift was chosen by them.

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/fit/posterior.h"
#include "closed_loop/numeric/dense.h"
#include "tests/closed_loop/shipped_fixture.h"

#include <string.h>

#define DUG "tests/data/between/rig.sqlite"

static struct dig_curve_set *dug;

static const struct dig_hypothesis plain = { .effects = 0 };

static int setup(void **state)
{
    struct dig_error error = { "" };
    assert_ok(dig_table_load(DUG, &dug, &error), error);
    return shipped_rig_setup(state);
}

static int teardown(void **state)
{
    dig_curve_set_destroy(dug);
    return shipped_teardown(state);
}

// A gravel's mean of two beds along two trajectories, as a batch of two digs each.
static void make_batch(const size_t entry, double place[DIG_AXES], struct dig_batch *const batch)
{
    static struct dig_measured mean[DIG_TRAJECTORY_MAX];
    static const bool          all[DIG_TRAJECTORY_MAX] = { true, true };
    size_t                     digs                    = 0;
    for (size_t t = 0; t < dug->trajectories; t++) {
        if (dug->packings[entry * dug->trajectories + t] != 2) {
            continue;
        }
        size_t to = 0;
        while (strcmp(set->trajectory[to].name, dug->trajectory[t].name) != 0) {
            to++;
        }
        mean[digs++] = shipped_dig(&dug->curve[entry * dug->trajectories + t], to);
    }
    assert_int_equal(digs, 2);
    dig_response_surface_place(surface, &dug->gravel[entry], place);
    assert_int_equal(dig_batch_make(soil, scatter, digs, mean, all, place, batch), DIG_OK);
    for (size_t g = 0; g < batch->groups; g++) {
        batch->group[g].digs = 2;
    }
}

TEST(intervals_hold_between_the_grids_points)
{
    static struct dig_batch      batch;
    static struct dig_likelihood likelihood;
    static double                residual[DIG_LIKELIHOOD_RESIDUALS];
    static const double          middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    double                       log_likelihood                 = 0.0;
    int                          held                           = 0;
    size_t                       gravels                        = 0;
    for (size_t e = 0; e < dug->entries; e++) {
        double            place[DIG_AXES];
        struct dig_fitted fitted;
        if (dug->packings[e * dug->trajectories] + dug->packings[e * dug->trajectories + 1] == 0) {
            continue; // the grid of these gravels has holes
        }
        make_batch(e, place, &batch);
        dig_likelihood_init(&likelihood, &batch, &plain);
        dig_likelihood_weigh(&likelihood, place);
        dig_likelihood_residual(&likelihood, place, residual);
        log_likelihood -= 0.5 * dig_product(likelihood.means, residual, residual);
        for (size_t g = 0; g < batch.groups; g++) {
            log_likelihood -= 0.5 * likelihood.error[g].log_det;
        }
        dig_hypothesis_fit(&batch, &plain, middle, DIG_FIT_THOROUGH, &fitted);
        dig_posterior_intervals(&batch, 1, &fitted, NULL);
        for (size_t a = 0; a < DIG_AXES; a++) {
            held += fitted.low[a] <= place[a] && place[a] <= fitted.high[a] ? 1 : 0;
        }
        gravels++;
    }
    print_message("log likelihood %.1f; 90 %% intervals of the gravel hold %d times of %zu\n",
                  log_likelihood, held, DIG_AXES * gravels);
    assert_int_equal(gravels, 6);
    assert_true(held >= 14);
    assert_true(log_likelihood > -39.0);
}

TESTS_WITH(setup, teardown)
