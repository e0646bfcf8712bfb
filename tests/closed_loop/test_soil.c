#include "closed_loop/model/soil.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

// A gravel's dig, plain and with an effect: features and curves.
struct dug {
    double size[DIG_FORCE_CHANNELS], noise;
    double plain[DIG_FEATURES], with[DIG_FEATURES];
    double bare[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS], curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

static struct dug dig_with(const struct dig_gravel *const gravel, const size_t t,
                           const enum dig_effect_id effect, const double u, const double contrast,
                           const double share)
{
    struct dug dug = { .noise = 0.0 };
    double     place[DIG_AXES];
    dig_response_surface_place(world.surface, gravel, place);
    dig_response_surface_features(world.surface, t, place, dug.plain, dug.size);
    dig_response_surface_curve(world.surface, t, place, dug.bare);
    memcpy(dug.with, dug.plain, sizeof dug.with);
    memcpy(dug.curve, dug.bare, sizeof dug.curve);
    dig_soil_add(soil, effect, t, place, u, contrast, share, dug.plain, dug.size, dug.with,
                 &dug.noise);
    dig_soil_add_curve(soil, effect, t, place, u, contrast, share,
                       (const double(*)[DIG_CURVE_POINTS])dug.bare, dug.curve);
    return dug;
}

// What the made world puts in at half its largest magnitude comes out, at a gravel that is none of
// the bases.
TEST(a_template_gives_back_what_was_put_in)
{
    static const enum dig_effect_id effect[] = { DIG_EFFECT_COHESION, DIG_EFFECT_GROUND_SLOPE,
                                                 DIG_EFFECT_LAYERING };
    const struct dig_gravel         gravel   = { { 0.6, 0.5, 2500 } };
    for (size_t e = 0; e < sizeof effect / sizeof effect[0]; e++) {
        const struct dug dug = dig_with(&gravel, MADE_ACTUAL, effect[e], 0.5, 1.0, 1.0);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            const struct dig_bin points = dig_feature_bin(f % DIG_FEATURE_BINS);
            double               truth  = 0.0;
            for (size_t k = points.from; k < points.to; k++) {
                truth +=
                    0.5 *
                    made_effect(effect[e], MADE_ACTUAL, (enum dig_channel)(f / DIG_FEATURE_BINS),
                                (double)k / (DIG_CURVE_POINTS - 1)) /
                    (double)(points.to - points.from);
            }
            // The made size is a channel's own rms, the features' that of the resultant force.
            const double own[DIG_FORCE_CHANNELS] = { 1.0, 8.0 / hypot(8.0, 5.0),
                                                     5.0 / hypot(8.0, 5.0) };
            const double found = (dug.with[f] - dug.plain[f]) / dug.size[f / DIG_FEATURE_BINS];
            assert_close(found, truth * own[f / DIG_FEATURE_BINS],
                         4.0 * MADE_SCATTER * sqrt(fmax(dug.noise, 0.05)));
        }
        assert_true(dug.noise > 0.0 && dug.noise < 0.5); // of 9 beds of 3 digs
    }
}

// The made effects are proportional to the magnitude and alike in all gravels: the terms that say
// otherwise are drawn to nothing, and the variance of what is known of the effect is of the order
// of what one term alone would have from all beds. Five free terms have nine times as much.
TEST(terms_that_the_beds_do_not_ask_for_bring_no_noise)
{
    const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        const double noise = dig_with(&gravel, t, DIG_EFFECT_LAYERING, 0.5, 1.0, 1.0).noise;
        double       known = 0.0;
        for (size_t e = 0; e < world.effects->entries; e++) {
            if (world.effects->entry[e].effect == DIG_EFFECT_LAYERING) {
                known += (double)world.effects->packings[e * world.effects->trajectories + t] *
                         pow(world.effects->entry[e].magnitude, 2.0);
            }
        }
        assert_true(noise > 0.5 * 0.25 / known && noise < 4.0 * 0.25 / known);
    }
}

// What a layer of another material adds is a multiple, in features and curves alike.
TEST(a_contrast_multiplies_what_a_template_adds)
{
    const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };
    const struct dug one  = dig_with(&gravel, MADE_ACTUAL, DIG_EFFECT_LAYERING, 0.5, 1.0, 1.0);
    const struct dug part = dig_with(&gravel, MADE_ACTUAL, DIG_EFFECT_LAYERING, 0.5, 0.4, 1.0);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        assert_close(part.with[f] - part.plain[f], 0.4 * (one.with[f] - one.plain[f]), 1e-12);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(part.curve[0][k] - part.bare[0][k], 0.4 * (one.curve[0][k] - one.bare[0][k]),
                     1e-12);
    }
    assert_true(part.noise > 0.0);
    assert_close(part.noise, 0.16 * one.noise, 1e-12);
}

TEST(an_effect_that_is_absent_adds_nothing)
{
    const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };
    for (int e = 0; e < DIG_EFFECTS; e++) {
        if (dig_effect_is_of_machine((enum dig_effect_id)e) ||
            !dig_soil_knows(soil, (enum dig_effect_id)e, MADE_SIMPLE_A)) {
            continue;
        }
        const struct dug dug =
            dig_with(&gravel, MADE_SIMPLE_A, (enum dig_effect_id)e, 0.0, 1.0, 1.0);
        assert_memory_equal(dug.with, dug.plain, sizeof dug.with);
        assert_close(dug.noise, 0.0, 0.0);
        assert_close(dig_soil_magnitude(soil, (enum dig_effect_id)e, 0.0), soil->absent[e], 0.0);
    }
}

TEST(features_are_those_of_the_curve)
{
    static const enum dig_effect_id effect[] = { DIG_EFFECT_COHESION, DIG_EFFECT_RATE_DEPENDENCE,
                                                 DIG_EFFECT_WEAR };
    const struct dig_gravel         gravel   = { { 0.5, 0.7, 3000 } };
    for (size_t e = 0; e < sizeof effect / sizeof effect[0]; e++) {
        const struct dug dug = dig_with(&gravel, MADE_ACTUAL, effect[e], 0.1, 1.0, 2.0);
        double           of_curve[DIG_FEATURES];
        dig_features_of((const double(*)[DIG_CURVE_POINTS])dug.curve, of_curve);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            assert_close(dug.with[f], of_curve[f], 1e-9 * dug.size[f / DIG_FEATURE_BINS]);
        }
    }
}

// Over a bin the factor is that of its mean speed: 1 % of the dig's size for a strong dependence.
TEST(the_tooths_speed_tells_features_as_it_tells_the_curve)
{
    const struct dig_gravel gravel = { { 0.5, 0.7, 3000 } };
    double                  of_curve[DIG_FEATURES];
    double                  most = 0.0;
    soil->along                  = 1.0;
    const struct dug dug =
        dig_with(&gravel, MADE_ACTUAL, DIG_EFFECT_RATE_DEPENDENCE, 0.3, 1.0, 0.0);
    soil->along = 0.0;
    dig_features_of((const double(*)[DIG_CURVE_POINTS])dug.curve, of_curve);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const double size = dug.size[f / DIG_FEATURE_BINS];
        assert_close(dug.with[f], of_curve[f], 0.01 * size);
        most = fmax(most, fabs(dug.with[f] - dug.plain[f]) / size);
    }
    assert_true(most > 0.05);
}

TEST(digs_differ_by_pass_pace_and_order)
{
    const struct dig_measured dig = { .pass = 3, .pace = 2.0, .order = 5 };
    assert_close(dig_soil_share(DIG_EFFECT_COMPACTION, &dig), 2.0, 0.0);
    assert_close(dig_soil_share(DIG_EFFECT_RATE_DEPENDENCE, &dig), log(2.0), 1e-15);
    assert_close(dig_soil_share(DIG_EFFECT_WEAR, &dig), 5.0, 0.0);
    assert_close(dig_soil_share(DIG_EFFECT_COHESION, &dig), 1.0, 0.0);
}

TEST(another_scene_is_refused_and_writes_nothing)
{
    struct dig_soil *untouched = soil;
    world.effects->scene_hash[0] ^= 1;
    assert_int_equal(dig_soil_create(world.surface, world.effects, world.scatter, &untouched),
                     DIG_EINVAL);
    world.effects->scene_hash[0] ^= 1;
    assert_ptr_equal(untouched, soil);
}

TEST(without_beds_only_the_reduced_forms_are_known)
{
    struct dig_soil *bare = NULL;
    assert_int_equal(dig_soil_create(world.surface, NULL, NULL, &bare), DIG_OK);
    assert_false(dig_soil_knows(bare, DIG_EFFECT_COHESION, 0));
    assert_true(dig_soil_knows(bare, DIG_EFFECT_WEAR, 0));
    assert_true(dig_soil_knows(bare, DIG_EFFECT_RATE_DEPENDENCE, 0));
    free(bare);
}

TESTS_WITH(world_setup, world_teardown)
