// Sensors that are off for tenths of a second, by digs of another DEM code (LIGGGHTS) and the table
// that ships: noise is no effect, and an effect beside it is named all the same. DIG_TEST_QUICK=1:
// one trace with noise.

#include "closed_loop/recordings/observe.h"
#include "closed_loop/verdict/trace.h"
#include "core/chance.h"
#include "tests/closed_loop/shipped_fixture.h"
#include "tests/read.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DIGS = 2 };

static struct dig_measured measured[DIGS];

static double *channel_of(struct dig_force_row *const row, const size_t channel)
{
    return channel == DIG_CHANNEL_MY_Nm ? &row->My_Nm
                                        : (channel == DIG_CHANNEL_FX_N ? &row->Fx_N : &row->Fz_N);
}

// Noise of a share of the channel's rms, which is what it was a row before but for what it forgets.
static void add_noise(struct dig_recording *const r, const size_t channel, const double share,
                      const double memory_s, uint64_t *const seed)
{
    double square = 0.0;
    for (size_t i = 0; i < r->rows; i++) {
        square += pow(*channel_of(&r->row[i], channel), 2.0) / (double)r->rows;
    }
    const double kept = exp(-(r->row[1].t_s - r->row[0].t_s) / memory_s);
    double       off  = dig_chance_normal(seed);
    for (size_t i = 0; i < r->rows; i++) {
        *channel_of(&r->row[i], channel) += share * sqrt(square) * off;
        off = kept * off + sqrt(1.0 - kept * kept) * dig_chance_normal(seed);
    }
}

// A bed's digs along simpleA and actual, with noise of 5 % that lasts so long (0: none), traced.
static void trace_digs(const char *const bed, const double memory_s, struct dig_trace *const trace)
{
    static const char *const  along[DIGS] = { "simpleA", "actual" };
    uint64_t                  seed        = 3;
    struct dig_trace_settings settings    = dig_trace_settings_default();
    struct dig_error          error       = { "" };
    for (size_t i = 0; i < DIGS; i++) {
        char                path[200];
        struct dig_measured seen;
        (void)snprintf(path, sizeof path, "tests/data/%s__%s.csv", bed, along[i]);
        struct dig_recording recording = read_recording(path);
        for (size_t c = 0; memory_s > 0.0 && c < DIG_FORCE_CHANNELS; c++) {
            add_noise(&recording, c, 0.05, memory_s, &seed);
        }
        assert_ok(dig_observe_dig(set, &recording, &seen, &error), error);
        dig_recording_finish(&recording);
        measured[i] = (struct dig_measured){ .order      = i,
                                             .trajectory = seen.trajectory,
                                             .use        = i == 0 ? DIG_USE_IDENTIFY : DIG_USE_FIT,
                                             .pass       = 1,
                                             .pace       = seen.pace,
                                             .first      = seen.first,
                                             .last       = seen.last };
        memcpy(measured[i].measured, seen.measured, sizeof seen.measured);
        memcpy(measured[i].value, seen.value, sizeof seen.value);
        memcpy(measured[i].sigma, seen.sigma, sizeof seen.sigma);
    }
    settings.bootstraps = 50;
    assert_ok(dig_trace_run(set, RIG, effects, &settings, NULL, DIGS, measured, trace, &error),
              error);
    print_message("%s, %.2f s: p %.3f, noise of %.3f N for %.2f s\n", bed, memory_s,
                  trace->p_complete, measured[0].lasting.sigma[DIG_CHANNEL_FX_N],
                  measured[0].lasting.memory_s);
}

// Without the noise told, every one of them is `unlisted`.
TEST(noise_that_lasts_is_no_effect)
{
    static const struct {
        const char *bed;
        double      memory_s;
    } plain[] = { { "reference/mu0.3_mur0.3_rho2500", 0.1 },
                  { "reference/mu0.9_mur0.9_rho2500", 0.03 },
                  { "liggghts_more/mu0.35_mur0.6_rho3500_seed1", 0.3 },
                  { "liggghts_more/mu0.4_mur0.4_rho2000_seed1", 0.1 } };
    for (size_t i = 0; i < (test_is_quick() ? 1 : sizeof plain / sizeof plain[0]); i++) {
        struct dig_trace trace;
        trace_digs(plain[i].bed, plain[i].memory_s, &trace);
        assert_int_equal(trace.effects, 0);
        assert_false(trace.significant);
        assert_true(measured[0].lasting.memory_s > 0.0);
        dig_trace_finish(&trace);
    }
}

TEST(an_effect_beside_noise_that_lasts_is_named)
{
    static const struct {
        const char        *bed;
        enum dig_effect_id effect;
    } with[] = { { "liggghts_more/slope_up_seed1", DIG_EFFECT_GROUND_SLOPE },
                 { "liggghts_more/cohesion_2e5_seed1", DIG_EFFECT_COHESION } };
    for (size_t i = 0; i < sizeof with / sizeof with[0] && !test_is_quick(); i++) {
        struct dig_trace trace;
        trace_digs(with[i].bed, 0.1, &trace);
        assert_int_equal(trace.effects, 1);
        assert_int_equal(trace.effect[0].effect, with[i].effect);
        dig_trace_finish(&trace);
    }
}

// Beds are not as smooth as the table has them, and effects not as its templates: that is no noise.
TEST(digs_without_noise_have_none)
{
    static const char *const bed[] = { "reference/mu0.5_mur0.5_rho2500",
                                       "liggghts_more/slope_up_seed1" };
    for (size_t i = 0; i < sizeof bed / sizeof bed[0] && !test_is_quick(); i++) {
        struct dig_trace trace;
        trace_digs(bed[i], 0.0, &trace);
        assert_close(measured[0].lasting.memory_s, 0.0, 0.0);
        assert_close(measured[0].lasting.sigma[DIG_CHANNEL_FX_N], 0.0, 0.0);
        dig_trace_finish(&trace);
    }
}

TESTS_WITH(shipped_rig_effects_setup, shipped_teardown)
