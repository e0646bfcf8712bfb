// Tests for closed_loop/search/unlisted_regression.c

#include "closed_loop/search/unlisted.h"

#include "core/units.h"
#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 8 };

static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
static struct dig_batch        batch;
static struct dig_measured     measured[DIGS];

// How the digs of a campaign differ.
struct differ {
    bool passes, paces, pitches;
    bool hardly; // as a machine keeps its pace and stands
};

// Digs along simpleA, and every other along actual where asked for.
static void draw(const bool two, const struct differ *const differ, uint64_t *const seed)
{
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] =
            made_dig(&gravel, two && i % 2 == 1 ? MADE_ACTUAL : MADE_SIMPLE_A, 0, NULL, NULL, seed);
        measured[i].order       = i;
        measured[i].pass        = differ->passes ? 1 + (unsigned)(i / 2) % 4 : 1;
        measured[i].pace        = differ->paces && (i / 2) % 2 == 1 ? 1.6 : 1.0;
        measured[i].pitch_known = differ->pitches;
        measured[i].pitch_rad   = differ->pitches ? DIG_RAD_PER_DEG * (double)((i / 2) % 4) : 0.0;
        if (differ->hardly) {
            measured[i].pace        = 1.0 + 0.05 * (model_uniform(seed) - 0.5);
            measured[i].pitch_known = true;
            measured[i].pitch_rad   = 0.2 * DIG_RAD_PER_DEG * model_uniform(seed);
        }
    }
}

static double size_of(const struct dig_measured *const dig, const size_t c)
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += dig->value[c][k] * dig->value[c][k] / DIG_CURVE_POINTS;
    }
    return sqrt(sum);
}

// Fits the plain hypothesis to all digs and regresses what it leaves.
static void regress(struct dig_regressed *const means, struct dig_regressed *const digs)
{
    batch_digs(DIGS, measured, &gravel, &batch);
    const struct dig_fitted plain = fit_plain(&batch);
    *means                        = dig_regress(&batch, &plain, false);
    *digs                         = dig_regress(&batch, &plain, true);
}

static bool has(const struct dig_regressed *const r, const enum dig_basis basis)
{
    bool found = false;
    for (size_t i = 0; i < r->functions; i++) {
        found = found || r->function[i] == basis;
    }
    return found;
}

TEST(what_grows_with_the_pass_is_said_to)
{
    const struct differ  differ = { .passes = true };
    uint64_t             seed   = 21;
    struct dig_regressed means;
    struct dig_regressed digs;
    draw(true, &differ, &seed);
    for (size_t i = 0; i < DIGS; i++) {
        const double size = size_of(&measured[i], DIG_CHANNEL_MY_Nm);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_MY_Nm][k] += 0.1 * size * (measured[i].pass - 1.0);
        }
    }
    regress(&means, &digs);
    assert_true(digs.functions > 0);
    assert_int_equal(digs.function[0], DIG_BASIS_PASS);
    // Of digs in a row of which nobody wrote the pass, nothing tells it.
    for (size_t i = 0; i < DIGS; i++) {
        measured[i].pass = 1;
    }
    regress(&means, &digs);
    assert_false(has(&digs, DIG_BASIS_PASS));
}

TEST(what_grows_with_the_machines_pitch_is_said_to)
{
    const struct differ  differ = { .pitches = true };
    uint64_t             seed   = 22;
    struct dig_regressed means;
    struct dig_regressed digs;
    draw(true, &differ, &seed);
    for (size_t i = 0; i < DIGS; i++) {
        const double size = size_of(&measured[i], DIG_CHANNEL_FZ_N);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_FZ_N][k] += 6.0 * size * measured[i].pitch_rad;
        }
    }
    regress(&means, &digs);
    assert_true(digs.functions > 0);
    assert_int_equal(digs.function[0], DIG_BASIS_PITCH);
    measured[3].pitch_known = false;
    regress(&means, &digs);
    assert_false(has(&digs, DIG_BASIS_PITCH));
}

// Where simpleA turns from in to along and from along to out the tooth's velocity jumps by these;
// differences +-0.16 s apart make a triangle of the jump. All its phases are straight.
static double jerked(const double progress)
{
    static const double vx[]  = { 0.02515, 0.0463, 0.0 };
    static const double vz[]  = { -0.04356107781035726, 0.0, 0.0915 };
    static const double s[]   = { 0.6, 2.0, 0.4 };
    static const double half  = 0.16;
    double              path  = 0.0;
    double              whole = 0.0;
    double              time  = 0.0;
    for (int p = 0; p < 3; p++) {
        whole += hypot(vx[p], vz[p]) * s[p];
    }
    for (int p = 0; p < 3; p++) {
        const double here = hypot(vx[p], vz[p]);
        const double part = fmin(fmax((progress * whole - path) / here, 0.0), s[p]);
        path += here * s[p];
        time += part;
    }
    const double first  = hypot(vx[1] - vx[0], vz[1] - vz[0]);
    const double second = hypot(vx[2] - vx[1], vz[2] - vz[1]);
    return first * fmax(half - fabs(time - 0.6), 0.0) + second * fmax(half - fabs(time - 2.6), 0.0);
}

TEST(what_comes_where_the_bucket_is_jerked_is_said_to)
{
    const struct differ  none = { .passes = false };
    uint64_t             seed = 23;
    struct dig_regressed means;
    struct dig_regressed digs;
    draw(false, &none, &seed);
    for (size_t i = 0; i < DIGS; i++) {
        const double size = size_of(&measured[i], DIG_CHANNEL_MY_Nm);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_MY_Nm][k] +=
                40.0 * size * jerked((double)k / (DIG_CURVE_POINTS - 1));
        }
    }
    regress(&means, &digs);
    assert_true(digs.functions > 0);
    assert_int_equal(digs.function[0], DIG_BASIS_ACCELERATION);
    assert_true(digs.log_evidence > means.log_evidence + 3.0);
}

// Plain campaigns, alike or as different as campaigns are: with more to choose from, chance finds
// no more, but for what two such counts differ by (2 sigma). In 6000 campaigns each it was 99 and
// 100, 110 and 12, 176 and 33, 171 and 25.
TEST(plain_digs_depend_on_nothing_more_often_than_before)
{
    const int                  draws    = test_is_quick() ? 60 : 600;
    static const struct differ differ[] = { { false, false, false, false },
                                            { true, false, false, false },
                                            { false, true, false, false },
                                            { true, true, true, false },
                                            { false, false, false, true } };
    static const char *const   name[]   = { "all alike", "passes", "paces", "all three", "hardly" };
    for (size_t d = 0; d < sizeof differ / sizeof differ[0]; d++) {
        uint64_t seed   = 31 + d;
        int      before = 0;
        int      after  = 0;
        for (int n = 0; n < draws; n++) {
            struct dig_regressed means;
            struct dig_regressed digs;
            draw(true, &differ[d], &seed);
            regress(&means, &digs);
            before += (int)means.functions;
            after += (int)digs.functions;
        }
        print_message("  %s: false terms in %d campaigns, on the trajectory's functions %d, on "
                      "all %d\n",
                      name[d], draws, before, after);
        assert_true(after <= before + 2.0 * sqrt(before + after));
    }
}

TESTS_WITH(world_setup, world_teardown)
