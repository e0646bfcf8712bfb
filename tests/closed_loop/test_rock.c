// A rock that lies elsewhere than the table's. The made world's beds of layers, which are humps,
// are taken for beds of a rock here.

#include "closed_loop/search/rock.h"

#include "closed_loop/search/search.h"
#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>

enum { DIGS = 6, DRAWS = 24 };

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;

static int rocky_setup(void **state)
{
    const int status = world_setup(state);
    for (size_t e = 0; e < world.effects->entries; e++) {
        if (world.effects->entry[e].effect == DIG_EFFECT_LAYERING) {
            world.effects->entry[e].effect = DIG_EFFECT_OBSTACLE;
        }
    }
    free(soil);
    return status != 0 ? status
                       : (int)dig_soil_create(world.surface, world.effects, world.scatter, &soil);
}

static double tooth_x_m(const size_t t, const double progress)
{
    const struct dig_trajectory *const path = &world.set->trajectory[t];
    const struct dig_pose              pose =
        dig_trajectory_pose(path, dig_trajectory_time_s(path, world.set->tooth_m, progress));
    return pose.x_m + world.set->tooth_m * sin(pose.theta_rad);
}

// By bisection; below 0 where the tooth has not been.
static double progress_at(const size_t t, const double x_m)
{
    double low  = 0.0;
    double high = 1.0;
    if (x_m < tooth_x_m(t, 0.0)) {
        return -1.0;
    }
    for (int i = 0; i < 40; i++) {
        const double middle                          = 0.5 * (low + high);
        *(tooth_x_m(t, middle) < x_m ? &low : &high) = middle;
    }
    return low;
}

// Three simple and three real digs, with factor[] of the hump, so much further along.
static void dig(const double ahead_m, const double factor[], uint64_t seed)
{
    const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
    for (size_t i = 0; i < DIGS; i++) {
        const enum made_trajectory which = i % 2 == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
        struct dig_measured       *m     = &measured[i];
        *m                               = made_dig(&gravel, which, 0, NULL, NULL, &seed);
        m->order                         = i;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double squares = 0.0;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                squares += m->value[c][k] * m->value[c][k] / DIG_CURVE_POINTS;
            }
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                const double x_m = tooth_x_m(which, (double)k / (DIG_CURVE_POINTS - 1)) - ahead_m;
                const double at  = progress_at(which, x_m);
                m->value[c][k] += factor[i % 2] * sqrt(squares) *
                                  made_effect(DIG_EFFECT_LAYERING, which, (enum dig_channel)c, at);
            }
        }
    }
    batch_digs(DIGS, measured, &gravel, &batch);
}

static struct dig_search search(void)
{
    static struct dig_search found;
    dig_search_run(&batch, 0.01, DRAWS, 5, &found);
    return found;
}

TEST(a_rock_elsewhere_is_found_where_it_lies)
{
    static const double ahead_m[]   = { 0.02, 0.035 };
    static const double factor[][2] = { { 1.5, 1.0 }, { 0.4, 2.0 } };
    for (size_t i = 0; i < 2; i++) {
        dig(ahead_m[i], factor[i], 61 + i);
        const struct dig_search found = search();
        assert_true(found.significant);
        assert_true(found.is_rock);
        assert_close(found.rock.ahead_m, ahead_m[i], 0.006);
        assert_true(found.rock.low_m < ahead_m[i] && ahead_m[i] < found.rock.high_m);
        assert_close(found.rock.factor[batch.dig[0].group], factor[i][0], 0.4);
        assert_close(found.rock.factor[batch.dig[1].group], factor[i][1], 0.4);
    }
}

// The same dip or hollow in the ground is no rock, nor is what another effect explains.
TEST(what_is_no_hump_is_no_rock)
{
    static const double hollow[] = { -1.5, -1.5 };
    dig(0.02, hollow, 63);
    struct dig_search found = search();
    assert_true(found.significant);
    assert_false(found.is_rock);

    const enum dig_effect_id effect[]  = { DIG_EFFECT_UNLISTED };
    const double             strong[]  = { 1.5 };
    const struct dig_gravel  gravel    = { { 0.6, 0.55, 2500 } };
    static const double      nothing[] = { 0.0, 0.0 };
    uint64_t                 seed      = 64;
    dig(0.0, nothing, seed);
    for (size_t i = 0; i < DIGS; i++) {
        measured[i] =
            made_dig(&gravel, i % 2 == 0 ? MADE_SIMPLE_A : MADE_ACTUAL, 1, effect, strong, &seed);
    }
    batch_digs(DIGS, measured, NULL, &batch);
    found = search();
    assert_true(found.significant && found.unlisted);
    assert_false(found.is_rock);
}

TESTS_WITH(rocky_setup, world_teardown)
