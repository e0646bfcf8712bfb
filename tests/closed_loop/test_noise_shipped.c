// What the table that ships is uncertain by, judged by digs of another DEM code (LIGGGHTS) whose
// gravel is known: thirteen plain gravels, ten of them on no point of the table's grid or seldom
// dug.

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/fit/posterior.h"
#include "closed_loop/numeric/dense.h"
#include "closed_loop/recordings/observe.h"
#include "tests/closed_loop/shipped_fixture.h"
#include "tests/read.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { GRAVELS_MAX = 32, DIGS_MAX = 12 };

static const struct dig_hypothesis plain = { .effects = 0 };

struct ground {
    struct dig_gravel   gravel;
    size_t              digs;
    struct dig_measured dig[DIGS_MAX];
};

static struct ground ground[GRAVELS_MAX];
static size_t        grounds;

static void take(const char *const path, const struct dig_gravel *const gravel)
{
    size_t g = 0;
    while (g < grounds && memcmp(&ground[g].gravel, gravel, sizeof *gravel) != 0) {
        g++;
    }
    assert_true(g < GRAVELS_MAX && ground[g].digs < DIGS_MAX);
    struct dig_measured  seen;
    struct dig_recording recording = read_recording(path);
    assert_int_equal(dig_observe_dig(set, &recording, &seen, NULL), DIG_OK);
    dig_recording_finish(&recording);
    ground[g].gravel             = *gravel;
    struct dig_measured *const m = &ground[g].dig[ground[g].digs++];

    *m = (struct dig_measured){ .trajectory = seen.trajectory,
                                .pass       = 1,
                                .pace       = seen.pace,
                                .first      = seen.first,
                                .last       = seen.last };
    memcpy(m->measured, seen.measured, sizeof seen.measured);
    memcpy(m->value, seen.value, sizeof seen.value);
    grounds = g == grounds ? g + 1 : grounds;
}

static int setup(void **state)
{
    static const char *const files[] = { "tests/data/reference/mu*.csv",
                                         "tests/data/liggghts_more/mu*.csv" };
    (void)shipped_rig_setup(state);
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++) {
        glob_t found;
        assert_int_equal(glob(files[f], 0, NULL, &found), 0);
        for (size_t i = 0; i < found.gl_pathc; i++) {
            struct dig_gravel gravel;
            assert_int_equal(sscanf(strrchr(found.gl_pathv[i], '/'), "/mu%lf_mur%lf_rho%lf",
                                    &gravel.value[0], &gravel.value[1], &gravel.value[2]),
                             DIG_AXES);
            // One has no rolling friction, which no gravel of the table has.
            if (gravel.value[DIG_AXIS_ROLLING] > 0.0) {
                take(found.gl_pathv[i], &gravel);
            }
        }
        globfree(&found);
    }
    return grounds == 13 ? 0 : 1;
}

static void make_batch(const struct ground *const g, double place[DIG_AXES],
                       struct dig_batch *const batch)
{
    bool all[DIGS_MAX];
    memset(all, true, sizeof all);
    dig_response_surface_place(surface, &g->gravel, place);
    assert_int_equal(dig_batch_make(soil, scatter, g->digs, g->dig, all, place, batch), DIG_OK);
}

// At the gravel that was dug, the means differ from the table by no more than the covariance says,
// and by not much less; so do the digs from their means.
TEST(what_the_digs_leave_of_the_table_is_as_large_as_expected)
{
    static struct dig_batch      batch;
    static struct dig_likelihood likelihood;
    static double                residual[DIG_LIKELIHOOD_RESIDUALS];
    double means = 0.0, features = 0.0, about = 0.0, freedom = 0.0, misfit = 0.0;
    for (size_t i = 0; i < grounds; i++) {
        double place[DIG_AXES];
        make_batch(&ground[i], place, &batch);
        dig_likelihood_init(&likelihood, &batch, &plain);
        dig_likelihood_weigh(&likelihood, place);
        dig_likelihood_residual(&likelihood, place, residual);
        const double of_means = dig_product(likelihood.means, residual, residual);
        means += of_means;
        misfit += of_means;
        for (size_t g = 0; g < batch.groups; g++) {
            const double n = (double)batch.group[g].features;
            misfit += batch.group[g].about + likelihood.error[g].log_det;
            for (size_t k = 0; k < batch.group[g].features; k++) {
                // In units of the digs, not of their scatter: so that it may be compared.
                misfit -= 2.0 * (double)batch.group[g].digs * log(batch.group[g].whiten[k][k]);
            }
            features += n;
            about += batch.group[g].about;
            freedom += n * (double)(batch.group[g].digs - 1);
        }
    }
    print_message("squares over expected: means %.2f of %.0f, digs about them %.2f of %.0f; log "
                  "likelihood %.0f\n",
                  means / features, features, about / freedom, freedom, -0.5 * misfit);
    assert_true(means / features > 0.5 && means / features < 1.0);
    assert_true(about / freedom > 0.6 && about / freedom < 1.1);
}

TEST(intervals_of_the_gravel_hold)
{
    static struct dig_batch batch;
    const double            middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    size_t                  held                           = 0;
    for (size_t i = 0; i < grounds; i++) {
        struct dig_fitted fitted;
        double            place[DIG_AXES];
        make_batch(&ground[i], place, &batch);
        dig_hypothesis_fit(&batch, &plain, middle, DIG_FIT_THOROUGH, &fitted);
        dig_posterior_intervals(&batch, 1, &fitted, NULL);
        for (size_t a = 0; a < DIG_AXES; a++) {
            // An interval may not hold everything either.
            held += place[a] >= fitted.low[a] - 1e-9 && place[a] <= fitted.high[a] + 1e-9 &&
                            fitted.high[a] - fitted.low[a] < 1.5
                        ? 1
                        : 0;
        }
    }
    print_message("90 %% intervals of the gravel hold %zu times of %zu\n", held,
                  grounds * DIG_AXES);
    assert_true((double)held >= 0.75 * (double)(grounds * DIG_AXES));
}

// Along what the axes change of a dig, left-out packings exceed the pooled covariance.
TEST(beds_scatter_more_as_gravels_do)
{
    static const char *const           table[] = { RIG, PRODUCT };
    static struct dig_response_surface fitted;
    for (size_t i = 0; i < 2; i++) {
        struct dig_curve_set *loaded = NULL;
        struct dig_scatter   *pooled = NULL;
        struct dig_error      error  = { "" };
        assert_ok(dig_table_load(table[i], &loaded, &error), error);
        assert_int_equal(dig_response_surface_fit(loaded, &fitted), DIG_OK);
        assert_ok(dig_scatter_measure(table[i], &fitted, &pooled, &error), error);
        for (size_t t = 0; t < loaded->trajectories; t++) {
            print_message("%s: beds along %s, as gravels differ: %.2f times\n", table[i],
                          loaded->trajectory[t].name, 1.0 + pooled->as_gravels[t]);
            assert_true(pooled->as_gravels[t] > 0.05);
        }
        dig_scatter_destroy(pooled);
        dig_curve_set_destroy(loaded);
    }
}

TESTS_WITH(setup, shipped_teardown)
