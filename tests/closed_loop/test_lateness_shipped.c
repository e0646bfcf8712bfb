// Force sensors that lag, by digs of another DEM code (LIGGGHTS) in plain gravel and the table that
// ships: the lag is named, in the right gravel, and no effect of the soil. DIG_TEST_QUICK=1: one
// gravel, one lag.

#include "closed_loop/recordings/observe.h"
#include "closed_loop/verdict/trace.h"
#include "tests/closed_loop/shipped_fixture.h"
#include "tests/read.h"

#include <math.h>
#include <stdio.h>

enum { DIGS = 4 };

// A filter of first order, as a load cell's amplifier has it.
static void filter(const double lag_s, double *const read, const double force, const double dt_s)
{
    *read += (force - *read) * (1.0 - exp(-dt_s / lag_s));
}

static void lag(const double lag_s, struct dig_recording *const r)
{
    struct dig_force_row read = r->row[0];
    for (size_t i = 1; i < r->rows && lag_s > 0.0; i++) {
        const double dt_s = r->row[i].t_s - r->row[i - 1].t_s;
        filter(lag_s, &read.My_Nm, r->row[i].My_Nm, dt_s);
        filter(lag_s, &read.Fx_N, r->row[i].Fx_N, dt_s);
        filter(lag_s, &read.Fz_N, r->row[i].Fz_N, dt_s);
        r->row[i].My_Nm = read.My_Nm;
        r->row[i].Fx_N  = read.Fx_N;
        r->row[i].Fz_N  = read.Fz_N;
    }
}

// Digs along simpleA and actual of two beds, or of one where the second is NULL.
static void trace_beds(const char *const bed[2], const double lag_s, struct dig_trace *const trace)
{
    static const char *const   along[] = { "simpleA", "actual" };
    static struct dig_measured measured[DIGS];
    struct dig_trace_settings  settings = dig_trace_settings_default();
    struct dig_error           error    = { "" };
    const size_t               digs     = bed[1] != NULL ? DIGS : DIGS / 2;
    for (size_t i = 0; i < digs; i++) {
        char path[200];
        (void)snprintf(path, sizeof path, "tests/data/%s__%s.csv", bed[i / 2], along[i % 2]);
        struct dig_recording recording = read_recording(path);
        lag(lag_s, &recording);
        measured[i] = (struct dig_measured){ .order = i, .use = DIG_USE_FIT, .pass = 1 };
        assert_ok(dig_observe_dig(set, &recording, &measured[i], &error), error);
        dig_recording_finish(&recording);
    }
    settings.bootstraps = 50;
    assert_ok(dig_trace_run(set, RIG, effects, &settings, NULL, digs, measured, trace, &error),
              error);
}

static const struct {
    const char       *bed[2];
    struct dig_gravel is;
} gravels[] = { { { "reference/mu0.5_mur0.5_rho2500", "reference/mu0.5_mur0.5_rho2500_seed2" },
                  { { 0.5, 0.5, 2500 } } },
                { { "reference/mu0.3_mur0.3_rho2500", "reference/mu0.3_mur0.3_rho2500_seed2" },
                  { { 0.3, 0.3, 2500 } } },
                { { "reference/mu0.9_mur0.9_rho2500", "reference/mu0.9_mur0.9_rho2500_seed2" },
                  { { 0.9, 0.9, 2500 } } } };

static size_t some(const size_t all)
{
    return test_is_quick() ? 1 : all;
}

TEST(a_sensor_that_lags_is_named_and_no_soil)
{
    static const double lag_s[] = { 0.12, 0.07, 0.04, 0.02, 0.0 };
    const size_t        lags    = some(sizeof lag_s / sizeof lag_s[0]);
    for (size_t l = 0; l < lags; l++) {
        size_t named = 0, held = 0, axes = 0;
        double least_s = INFINITY, most_s = -INFINITY;
        for (size_t g = 0; g < some(sizeof gravels / sizeof gravels[0]); g++) {
            struct dig_trace trace;
            trace_beds(gravels[g].bed, lag_s[l], &trace);
            for (int a = 0; a < DIG_AXES; a++) {
                axes++;
                held += trace.low.value[a] <= gravels[g].is.value[a] &&
                                gravels[g].is.value[a] <= trace.high.value[a]
                            ? 1
                            : 0;
            }
            assert_true(lag_s[l] > 0.0 || trace.effects == 0);
            for (size_t e = 0; e < trace.effects; e++) {
                const bool   late    = trace.effect[e].effect == DIG_EFFECT_SENSOR_DELAY;
                const double delay_s = trace.effect[e].parameter[0].value;
                assert_true(late || trace.effect[e].effect == DIG_EFFECT_UNLISTED);
                named += late ? 1 : 0;
                least_s = late ? fmin(least_s, delay_s) : least_s;
                most_s  = late ? fmax(most_s, delay_s) : most_s;
            }
            dig_trace_finish(&trace);
        }
        print_message("lag %.0f ms: named %zu times; hold %zu of %zu\n", 1e3 * lag_s[l], named,
                      held, axes);
        if (named > 0) {
            print_message("  as %.0f to %.0f ms\n", 1e3 * least_s, 1e3 * most_s);
        }
        if (lag_s[l] >= 0.04) {
            assert_int_equal(named, axes / DIG_AXES);
            assert_close(least_s, lag_s[l], 0.2 * lag_s[l]);
            assert_close(most_s, lag_s[l], 0.2 * lag_s[l]);
        }
        assert_true(held + 1 >= axes);
    }
}

TEST(an_effect_of_the_soil_beside_a_lag_is_named_with_it)
{
    static const struct {
        const char        *bed[2];
        enum dig_effect_id effect;
        double             is;
    } with[] = { { { "liggghts_more/slope_up_seed1", NULL }, DIG_EFFECT_GROUND_SLOPE, 8.0 },
                 { { "liggghts_more/cohesion_2e5_seed1", "liggghts_more/cohesion_2e5_seed2" },
                   DIG_EFFECT_COHESION,
                   2e5 } };
    for (size_t i = 0; i < sizeof with / sizeof with[0] && !test_is_quick(); i++) {
        struct dig_trace trace;
        trace_beds(with[i].bed, 0.07, &trace);
        assert_int_equal(trace.effects, 2);
        assert_int_equal(trace.effect[0].effect, DIG_EFFECT_SENSOR_DELAY);
        assert_int_equal(trace.effect[1].effect, with[i].effect);
        const struct dig_model_parameter *const late = &trace.effect[0].parameter[0];
        const struct dig_model_parameter *const of   = &trace.effect[1].parameter[0];
        print_message("lag 70 ms beside %s: %.0f ms (%.0f to %.0f), %.4g (%.4g to %.4g)\n",
                      dig_effect_name(with[i].effect), 1e3 * late->value, 1e3 * late->low,
                      1e3 * late->high, of->value, of->low, of->high);
        assert_true(late->low <= 0.07 && 0.07 <= late->high);
        assert_true(of->low <= with[i].is && with[i].is <= of->high);
        dig_trace_finish(&trace);
    }
}

TESTS_WITH(shipped_rig_effects_setup, shipped_teardown)
