#include "closed_loop/model/scatter.h"

#include "core/chance.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ENTRIES = 80, PACKINGS = 4 };

static struct dig_curve_set       *set;
static struct dig_response_surface surface;

static int set_up(void **state)
{
    (void)state;
    set = made_table(&(struct made_options){ .relative_sd = 0.15, .packings = 5 });
    return dig_response_surface_fit(set, &surface);
}

static int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    return 0;
}

// Residuals about their entry's mean of digs whose features have sd 0.1 (first half of the bins) or
// 0.2, neighbours correlated by a half, everything times sqrt(factor).
static struct dig_scatter *pooled(const double slope)
{
    uint64_t                     seed = 9;
    struct dig_scatter_residual *r    = calloc((size_t)ENTRIES * PACKINGS, sizeof *r);
    for (size_t e = 0; e < ENTRIES; e++) {
        double       mean[DIG_FEATURES] = { 0.0 };
        const double strength           = -1.0 + 2.0 * (double)e / (ENTRIES - 1);
        for (size_t p = 0; p < PACKINGS; p++) {
            struct dig_scatter_residual *const one = &r[e * PACKINGS + p];
            double                             w   = model_normal(&seed);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                const double next = model_normal(&seed);
                const double sd   = f % DIG_FEATURE_BINS < DIG_FEATURE_BINS / 2 ? 0.1 : 0.2;
                one->value[f]     = sd * sqrt(1.0 + slope * strength) * (w + next) / sqrt(2.0);
                w                 = next;
                mean[f] += one->value[f] / PACKINGS;
            }
            one->entry    = e;
            one->packings = PACKINGS;
            one->strength = strength;
        }
        for (size_t p = 0; p < PACKINGS; p++) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                r[e * PACKINGS + p].value[f] -= mean[f];
            }
        }
    }
    struct dig_scatter *scatter = NULL;
    assert_int_equal(dig_scatter_pool(&surface, (size_t)ENTRIES * PACKINGS, r, &scatter), DIG_OK);
    free(r);
    return scatter;
}

TEST(a_known_covariance_is_found)
{
    struct dig_scatter *s = pooled(0.0);
    assert_close(s->freedom[0], ENTRIES * (PACKINGS - 1), 1e-9);
    assert_close(s->widened[0], 1.05, 0.1);
    for (size_t f = 0; f + 1 < DIG_FEATURES; f++) {
        const double sd = f % DIG_FEATURE_BINS < DIG_FEATURE_BINS / 2 ? 0.1 : 0.2;
        assert_close(sqrt(s->covariance[0][f][f]) / sd, 1.03, 0.2);
        const double correlation = s->covariance[0][f][f + 1] /
                                   sqrt(s->covariance[0][f][f] * s->covariance[0][f + 1][f + 1]);
        assert_close(correlation, 0.5, 0.2);
    }
    assert_close(dig_scatter_factor(s, 0, 1.0), 1.0, 0.15);
    dig_scatter_destroy(s);
}

// Mean square of the residuals kept from the weaker half of the gravels, or from the stronger.
static double kept_from(const struct dig_scatter *const s, const size_t half)
{
    const size_t n   = s->residuals[0] / 2;
    double       sum = 0.0;
    for (size_t i = half * n; i < (half + 1) * n; i++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            sum += s->residual[0][i][f] * s->residual[0][i][f] / (double)(n * DIG_FEATURES);
        }
    }
    return sum;
}

TEST(stronger_gravels_may_scatter_more)
{
    struct dig_scatter *s = pooled(0.6);
    assert_close(dig_scatter_factor(s, 0, 1.0) / dig_scatter_factor(s, 0, 0.0), 1.6, 0.2);
    assert_close(dig_scatter_factor(s, 0, -1.0) / dig_scatter_factor(s, 0, 0.0), 0.45, 0.15);
    assert_true(dig_scatter_factor(s, 0, -100.0) >= 0.4);       // never none
    assert_close(kept_from(s, 1) / kept_from(s, 0), 1.0, 0.15); // as of factor 1
    dig_scatter_destroy(s);
}

// The beds of one entry, each of its gravel moved by so much along each axis, besides an even
// scatter, about their mean.
static void move_beds(const double moved, uint64_t *const seed,
                      struct dig_scatter_residual r[PACKINGS])
{
    double mean[DIG_FEATURES] = { 0.0 };
    for (size_t p = 0; p < PACKINGS; p++) {
        double amplitude[DIG_FORCE_CHANNELS];
        double at[DIG_AXES];
        for (size_t a = 0; a < DIG_AXES; a++) {
            at[a] = r[p].place[a] + moved * model_normal(seed);
        }
        dig_response_surface_features(&surface, 0, r[p].place, r[p].value, amplitude);
        dig_response_surface_features(&surface, 0, at, r[p].value,
                                      (double[DIG_FORCE_CHANNELS]){ 0 });
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            r[p].value[f] =
                r[p].value[f] / amplitude[f / DIG_FEATURE_BINS] + 0.02 * model_normal(seed);
            mean[f] += r[p].value[f] / PACKINGS;
        }
    }
    for (size_t p = 0; p < PACKINGS; p++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            r[p].value[f] -= mean[f];
        }
    }
}

// How much more than S digs scatter as other gravels do, of gravels that lie all over the table.
static double more_as_gravels(const double moved)
{
    static struct dig_scatter_residual r[ENTRIES][PACKINGS];
    struct dig_scatter                *s    = NULL;
    uint64_t                           seed = 12;
    for (size_t e = 0; e < ENTRIES; e++) {
        const struct dig_scatter_residual entry = {
            .entry    = e,
            .packings = PACKINGS,
            .place = { 1.8 * dig_chance_uniform(&seed) - 0.9, 1.8 * dig_chance_uniform(&seed) - 0.9,
                       1.8 * dig_chance_uniform(&seed) - 0.9 }
        };
        for (size_t p = 0; p < PACKINGS; p++) {
            r[e][p] = entry;
        }
        move_beds(moved, &seed, r[e]);
    }
    assert_int_equal(dig_scatter_pool(&surface, (size_t)ENTRIES * PACKINGS, r[0], &s), DIG_OK);
    const double more = s->as_gravels[0];
    dig_scatter_destroy(s);
    return more;
}

TEST(beds_that_differ_as_gravels_do_scatter_more_there)
{
    const double none = more_as_gravels(0.0);
    const double some = more_as_gravels(0.1);
    print_message("more than S as gravels: %.2f and %.2f\n", none, some);
    assert_true(none < 0.15);
    assert_true(some > 0.3);
}

// Without second packings the curves' own standard deviation is all there is.
TEST(a_table_without_runs_uses_its_curves)
{
    struct dig_scatter *s = NULL;
    assert_int_equal(dig_scatter_pool(&surface, 0, NULL, &s), DIG_OK);
    assert_int_equal(s->residuals[0], 0);
    assert_close(s->freedom[0], 0.0, 0.0);
    // The made table's is 0.15 of the curve at each point, so of the rms it is between.
    double mean = 0.0;
    for (size_t f = 0; f < DIG_FEATURE_BINS; f++) {
        mean += s->covariance[0][f][f] / DIG_FEATURE_BINS;
    }
    assert_close(sqrt(mean), 0.15, 0.02);
    dig_scatter_destroy(s);
}

// Three packings of one entry whose channels are each too strong or too weak all along the dig, or
// have nothing to do with it from bin to bin.
static double neighbours_of_few(const double alike)
{
    struct dig_scatter         *s    = NULL;
    struct dig_scatter_residual r[3] = { { .packings = 3 }, { .packings = 3 }, { .packings = 3 } };
    uint64_t                    seed = 4;
    assert_int_equal(dig_scatter_pool(&surface, 0, NULL, &s), DIG_OK); // how large the curves say
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        double off[3];
        for (size_t p = 0; p < 3; p++) {
            const double of_channel = (double)p - 1.0;
            off[p]                  = sqrt(s->covariance[0][f][f]) *
                     (alike * of_channel + (1.0 - alike) * model_normal(&seed));
        }
        for (size_t p = 0; p < 3; p++) {
            r[p].value[f] = off[p] - (off[0] + off[1] + off[2]) / 3.0;
        }
    }
    dig_scatter_destroy(s);
    assert_int_equal(dig_scatter_pool(&surface, 3, r, &s), DIG_OK);
    assert_close(s->freedom[0], 2.0, 1e-9);
    const double correlation =
        s->covariance[0][3][4] / sqrt(s->covariance[0][3][3] * s->covariance[0][4][4]);
    dig_scatter_destroy(s);
    return correlation;
}

TEST(few_packings_say_how_alike_neighbours_are)
{
    assert_true(neighbours_of_few(0.95) > 0.85);
    assert_true(neighbours_of_few(0.0) < 0.55);
}

TESTS_WITH(set_up, tear_down)
