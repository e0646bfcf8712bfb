// What the table that ships is uncertain by between its points, by our own digs there
// (tests/data/between). The size of the shift was chosen by them.

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/fit/posterior.h"
#include "tables/load.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TABLE "tables/reference_rig.sqlite"
#define DUG   "tests/data/between/rig.sqlite"

static struct dig_curve_set        *set, *dug;
static struct dig_response_surface *surface;
static struct dig_scatter          *scatter;
static struct dig_soil             *soil;

static const struct dig_hypothesis plain = { .effects = 0 };

static int setup(void **state)
{
    (void)state;
    surface = calloc(1, sizeof *surface);
    return surface == NULL || dig_table_load(TABLE, &set, NULL) != DIG_OK ||
           dig_table_load(DUG, &dug, NULL) != DIG_OK ||
           dig_response_surface_fit(set, surface) != DIG_OK ||
           dig_scatter_measure(TABLE, surface, &scatter, NULL) != DIG_OK ||
           dig_soil_create(surface, NULL, NULL, &soil) != DIG_OK;
}

static int teardown(void **state)
{
    (void)state;
    free(soil);
    dig_scatter_destroy(scatter);
    free(surface);
    dig_curve_set_destroy(dug);
    dig_curve_set_destroy(set);
    return 0;
}

// A gravel's mean of two beds along two trajectories, as a batch of two digs each.
static void make_batch(const size_t entry, double place[DIG_AXES],
                       struct dig_whitened_digs *const batch)
{
    static struct dig_measured mean[DIG_TRAJECTORY_MAX];
    static const bool          all[DIG_TRAJECTORY_MAX] = { true, true };
    memset(mean, 0, sizeof mean);
    size_t digs = 0;
    for (size_t t = 0; t < dug->trajectories; t++) {
        if (dug->packings[entry * dug->trajectories + t] != 2) {
            continue;
        }
        struct dig_measured *const m = &mean[digs++];
        while (strcmp(set->trajectory[m->trajectory].name, dug->trajectory[t].name) != 0) {
            m->trajectory++;
        }
        m->pass = 1;
        m->pace = 1.0;
        m->last = 1.0;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            m->measured[c] = true;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                m->value[c][k] = (double)dug->curve[entry * dug->trajectories + t].mean[c][k];
            }
        }
    }
    assert_int_equal(digs, 2);
    dig_response_surface_place(surface, &dug->gravel[entry], place);
    assert_int_equal(dig_whitened_digs_make(soil, scatter, digs, mean, all, place, batch), DIG_OK);
    for (size_t g = 0; g < batch->groups; g++) {
        batch->group[g].digs = 2;
    }
}

TEST(intervals_hold_between_the_grids_points)
{
    static struct dig_whitened_digs batch;
    static struct dig_likelihood    likelihood;
    static const double             middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    double                          log_likelihood                 = 0.0;
    int                             held                           = 0;
    size_t                          gravels                        = 0;
    for (size_t e = 0; e < dug->entries; e++) {
        double            place[DIG_AXES];
        struct dig_fitted fitted;
        if (dug->packings[e * dug->trajectories] + dug->packings[e * dug->trajectories + 1] == 0) {
            continue; // the grid of these gravels has holes
        }
        make_batch(e, place, &batch);
        dig_likelihood_init(&likelihood, &batch, &plain);
        dig_likelihood_weigh(&likelihood, place);
        log_likelihood -= 0.5 * dig_likelihood_means(&likelihood, place);
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
