// A table of three beds of one gravel knows little of how digs scatter. What a trace takes for
// significant by it must still be as rare as the level says, and what is large be found.

#include "closed_loop/search/search.h"

#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { PACKINGS = 3, DIGS = 3, DRAWS = 200, CAMPAIGNS = 100 };

static const double level = 0.01;

// A dig is too strong or too weak all along it, and a little more so at one end.
static struct dig_measured make_dig(const double strength, uint64_t *const seed)
{
    struct dig_measured     m      = { .use = DIG_USE_FIT, .pass = 1, .pace = 1.0, .last = 1.0 };
    const struct dig_gravel gravel = { { 0.3, 0.1, 2500 } };
    const double            whole  = 0.15 * model_normal(seed);
    const double            tilt   = 0.05 * model_normal(seed);
    m.measured[DIG_CHANNEL_MY_Nm]  = true;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress         = (double)k / (DIG_CURVE_POINTS - 1);
        m.value[DIG_CHANNEL_MY_Nm][k] = strength * (1.0 + whole + tilt * (2.0 * progress - 1.0)) *
                                        made_moment_Nm(&gravel, MADE_SIMPLE_A, progress, 0.0);
    }
    return m;
}

// The table's one curve, and the residuals of its digs about it.
static void dig_table(struct dig_curve_set *const set, uint64_t *const seed,
                      struct dig_scatter_residual residual[PACKINGS])
{
    struct dig_measured     dig[PACKINGS];
    struct dig_curve *const curve              = &set->curve[0];
    double                  mean[DIG_FEATURES] = { 0.0 };
    double                  amplitude[DIG_FORCE_CHANNELS];
    memset(curve, 0, sizeof *curve);
    memset(residual, 0, PACKINGS * sizeof residual[0]);
    for (size_t p = 0; p < PACKINGS; p++) {
        dig[p] = make_dig(1.0, seed);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[DIG_CHANNEL_MY_Nm][k] +=
                (float)(dig[p].value[DIG_CHANNEL_MY_Nm][k] / PACKINGS);
        }
        dig_features_of((const double(*)[DIG_CURVE_POINTS])dig[p].value, residual[p].value);
        residual[p].packings = PACKINGS;
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            mean[f] += residual[p].value[f] / PACKINGS;
        }
    }
    dig_features_amplitude(mean, NULL, amplitude);
    for (size_t p = 0; p < PACKINGS; p++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double off =
                dig[p].value[DIG_CHANNEL_MY_Nm][k] - (double)curve->mean[DIG_CHANNEL_MY_Nm][k];
            curve->sd[DIG_CHANNEL_MY_Nm][k] += (float)(off * off / (PACKINGS - 1));
        }
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const double size    = amplitude[f / DIG_FEATURE_BINS];
            residual[p].value[f] = size > 0.0 ? (residual[p].value[f] - mean[f]) / size : 0.0;
        }
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        curve->sd[DIG_CHANNEL_MY_Nm][k] = sqrtf(curve->sd[DIG_CHANNEL_MY_Nm][k]);
    }
}

// How many campaigns of three digs, so many times as strong as the table's, lack something.
static size_t found(const double strength)
{
    const struct made_options   options = { .relative_sd = 0.15, .packings = PACKINGS };
    struct dig_curve_set *const set     = made_table(&options);
    uint64_t                    seed    = 11;
    size_t                      count   = 0;
    set->entries                        = 1;
    set->trajectories                   = 1;
    for (size_t a = 0; a < DIG_AXES; a++) {
        set->axis_count[a] = 1;
    }
    for (size_t c = 0; c < CAMPAIGNS; c++) {
        static const bool            take[DIGS] = { true, true, true };
        static struct dig_batch      batch;
        static struct dig_search     search;
        struct dig_scatter_residual  residual[PACKINGS];
        struct dig_measured          dig[DIGS];
        struct dig_response_surface *surface         = malloc(sizeof *surface);
        struct dig_scatter          *scatter         = NULL;
        struct dig_soil             *soil            = NULL;
        const double                 place[DIG_AXES] = { 0.0 };
        dig_table(set, &seed, residual);
        for (size_t i = 0; i < DIGS; i++) {
            dig[i]       = make_dig(strength, &seed);
            dig[i].order = i;
        }
        assert_int_equal(dig_response_surface_fit(set, surface), DIG_OK);
        assert_int_equal(dig_scatter_pool(surface, PACKINGS, residual, &scatter), DIG_OK);
        assert_int_equal(dig_soil_create(surface, NULL, scatter, &soil), DIG_OK);
        assert_int_equal(dig_batch_make(soil, scatter, DIGS, dig, take, place, &batch), DIG_OK);
        dig_search_run(&batch, level, DRAWS, c, &search);
        count += search.significant ? 1 : 0;
        free(soil);
        dig_scatter_destroy(scatter);
        free(surface);
    }
    made_table_destroy(set);
    return count;
}

// More than four of a hundred come once in three hundred times.
TEST(chance_is_as_rare_as_the_level_says)
{
    const size_t alarms = found(1.0);
    print_message("alarms: %zu of %d\n", alarms, CAMPAIGNS);
    assert_true(alarms <= 4);
}

TEST(what_is_four_times_as_strong_is_found)
{
    const size_t seen = found(4.0);
    print_message("found: %zu of %d\n", seen, CAMPAIGNS);
    assert_true(seen >= 80);
}
