// Tests for closed_loop/verdict/tell_apart.c

#include "closed_loop/verdict/trace_work.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 4 };

static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
static struct dig_search       search;
static struct dig_trace        trace;
static struct dig_measured     measured[DIGS];

static void candidate(const enum dig_effect_id effect, const double u)
{
    struct dig_fitted *const f = &search.rival[search.rivals++].fitted;
    *f                         = (struct dig_fitted){ .hypothesis = { 1, { effect }, false } };
    dig_response_surface_place(world.surface, &gravel, f->number);
    f->number[DIG_AT_U(0)]        = u;
    f->number[DIG_AT_CONTRAST(0)] = 1.0;
}

// Of these candidates, all of one set; the digs measure the moment and forces, or the first so
// many.
static void tell(const size_t channels, const size_t effects, const enum dig_effect_id effect[],
                 const double u[])
{
    const struct dig_trace_work t = { .set      = world.set,
                                      .surface  = world.surface,
                                      .scatter  = world.scatter,
                                      .soil     = soil,
                                      .digs     = DIGS,
                                      .measured = measured,
                                      .search   = &search };
    memset(&search, 0, sizeof search);
    memset(&trace, 0, sizeof trace);
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            measured[i].measured[c] = c < channels;
        }
    }
    trace.sets           = 1;
    trace.set[0].effects = effects;
    for (size_t i = 0; i < effects; i++) {
        trace.set[0].effect[i] = effect[i];
        candidate(effect[i], u[i]);
    }
    assert_int_equal(dig_tell_apart(&t, &trace), DIG_OK);
}

// Rms over the features of so much of the whole dig, in one dig's scatter.
static double of_the_whole(const double share, const size_t trajectory)
{
    double place[DIG_AXES];
    double feature[DIG_FEATURES];
    double size[DIG_FORCE_CHANNELS];
    double sum = 0.0;
    dig_response_surface_place(world.surface, &gravel, place);
    dig_response_surface_features(world.surface, trajectory, place, feature, size);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const double sd =
            size[f / DIG_FEATURE_BINS] * sqrt(world.scatter->covariance[trajectory][f][f]);
        sum += pow(share * feature[f] / sd, 2.0) / (double)DIG_FEATURES;
    }
    return sqrt(sum);
}

TEST(what_differs_at_speed_alone_is_told_by_digging_faster)
{
    const enum dig_effect_id effect[] = { DIG_EFFECT_RATE_DEPENDENCE, DIG_EFFECT_COHESION };
    const double             u[]      = { 0.3, 0.0 };
    soil->along                       = 0.0;
    tell(3, 2, effect, u);
    assert_int_equal(trace.tells, 1);
    assert_false(trace.tell[0].in_air);
    assert_non_null(strstr(trace.tell[0].how, "at twice the pace"));
    double most = 0.0;
    for (size_t k = 0; k < MADE_TRAJECTORIES; k++) {
        most = fmax(most, of_the_whole(exp2(0.3) - 1.0, k));
    }
    // Over the size with the effect in it.
    assert_close(trace.tell[0].sigmas * exp2(0.3) / most, 1.0, 0.1);
    assert_close(trace.tell[0].repeats, fmax(ceil(9.0 / pow(trace.tell[0].sigmas, 2.0)), 1.0), 0.0);
}

TEST(what_grows_with_the_digs_is_told_by_later_ones)
{
    const enum dig_effect_id effect[] = { DIG_EFFECT_WEAR, DIG_EFFECT_COHESION };
    const double             u[]      = { 0.02, 0.0 };
    tell(3, 2, effect, u);
    assert_non_null(strstr(trace.tell[0].how, "after ten more digs"));
}

// Adhesion of the made world shows in Fz alone.
TEST(what_is_not_measured_tells_nothing)
{
    const enum dig_effect_id effect[] = { DIG_EFFECT_ADHESION, DIG_EFFECT_COHESION };
    const double             u[]      = { 0.8, 0.0 };
    tell(3, 2, effect, u);
    const double with_forces = trace.tell[0].sigmas;
    assert_true(with_forces > 0.5);
    tell(1, 2, effect, u);
    assert_true(trace.tell[0].sigmas < 0.5 * with_forces);
}

// In the made world the slope is felt along the real dig by 0.6 of what it is along the others.
TEST(what_differs_in_one_dig_is_told_by_that)
{
    const enum dig_effect_id effect[] = { DIG_EFFECT_GROUND_SLOPE, DIG_EFFECT_COHESION,
                                          DIG_EFFECT_ADHESION };
    const double             u[]      = { 0.8, 0.0, 0.0 };
    tell(3, 3, effect, u);
    assert_int_equal(trace.tells, 3);
    assert_int_equal(trace.tell[1].effect[0], DIG_EFFECT_GROUND_SLOPE);
    assert_int_equal(trace.tell[1].effect[1], DIG_EFFECT_ADHESION);
    for (size_t i = 0; i < 2; i++) {
        assert_non_null(strstr(trace.tell[i].how, "a dig along simple"));
        assert_null(strstr(trace.tell[i].how, "pace"));
    }
    // Neither of the others is there: nothing tells them apart, and that is said.
    char text[256];
    assert_string_equal(trace.tell[2].how, "");
    dig_tell_apart_say(&trace.tell[2], sizeof text, text);
    assert_string_equal(text, "cohesion and adhesion: nothing that was tried tells them apart");
    dig_tell_apart_say(&trace.tell[0], sizeof text, text);
    assert_non_null(strstr(text, "ground_slope and cohesion differ most by a dig along simple"));
    dig_tell_apart_say(&trace.tell[0], 8, text);
    assert_string_equal(text, "ground_");
}

TEST(there_is_room_for_so_many_pairs)
{
    const struct dig_trace_work t = { .set = world.set, .search = &search, .digs = DIGS };
    memset(&search, 0, sizeof search);
    memset(&trace, 0, sizeof trace);
    trace.sets = 2;
    for (size_t s = 0; s < 2; s++) {
        for (int e = 0; e <= DIG_EFFECT_SENSOR_DELAY; e++) {
            trace.set[s].effect[trace.set[s].effects++] = (enum dig_effect_id)e;
        }
    }
    assert_int_equal(dig_tell_apart(&t, &trace), DIG_OK);
    assert_int_equal(trace.tells, DIG_TRACE_TELLS_MAX);
    assert_string_equal(trace.tell[0].how, "");
}

TESTS_WITH(world_setup, world_teardown)
