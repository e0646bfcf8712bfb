#include "closed_loop/model/soil.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

// The plain features and size at a gravel.
static void plain_at(const struct dig_gravel *const gravel, const size_t t, double place[DIG_AXES],
                     double plain[DIG_FEATURES], double size[DIG_FORCE_CHANNELS])
{
    dig_response_surface_place(world.surface, gravel, place);
    dig_response_surface_features(world.surface, t, place, plain, size);
}

// What the made world puts in at half its largest magnitude comes out, at a gravel that is none of
// the bases; adhesion acts by its ratio to the grains' weight.
TEST(a_template_gives_back_what_was_put_in)
{
    static const enum dig_effect_id effect[] = { DIG_EFFECT_COHESION, DIG_EFFECT_GROUND_SLOPE,
                                                 DIG_EFFECT_LAYERING };
    const struct dig_gravel         gravel   = { { 0.6, 0.5, 2500 } };
    for (size_t e = 0; e < sizeof effect / sizeof effect[0]; e++) {
        double place[DIG_AXES], plain[DIG_FEATURES], with[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double noise = 0.0;
        plain_at(&gravel, MADE_ACTUAL, place, plain, size);
        memcpy(with, plain, sizeof with);
        dig_soil_add(soil, effect[e], MADE_ACTUAL, place, 0.5, 1.0, 1.0, plain, size, with, &noise);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            size_t from, to;
            dig_feature_bin(f % DIG_FEATURE_BINS, &from, &to);
            double truth = 0.0;
            for (size_t k = from; k < to; k++) {
                truth +=
                    0.5 *
                    made_effect(effect[e], MADE_ACTUAL, (enum dig_channel)(f / DIG_FEATURE_BINS),
                                (double)k / (DIG_CURVE_POINTS - 1)) /
                    (double)(to - from);
            }
            // The made size is a channel's own rms, the features' that of the resultant force.
            const double own[DIG_FORCE_CHANNELS] = { 1.0, 8.0 / hypot(8.0, 5.0),
                                                     5.0 / hypot(8.0, 5.0) };
            const double found = (with[f] - plain[f]) / size[f / DIG_FEATURE_BINS];
            assert_close(found, truth * own[f / DIG_FEATURE_BINS],
                         4.0 * MADE_SCATTER * sqrt(fmax(noise, 0.05)));
        }
        assert_true(noise > 0.0 && noise < 0.5); // of 9 beds of 3 digs
    }
}

// The made effects are proportional to the magnitude and alike in all gravels: the terms that say
// otherwise are drawn to nothing, and the variance of what is known of the effect is of the order
// of what one term alone would have from all beds. Five free terms have nine times as much.
TEST(terms_that_the_beds_do_not_ask_for_bring_no_noise)
{
    const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        double place[DIG_AXES], plain[DIG_FEATURES], with[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double noise = 0.0;
        double known = 0.0;
        plain_at(&gravel, t, place, plain, size);
        memcpy(with, plain, sizeof with);
        dig_soil_add(soil, DIG_EFFECT_LAYERING, t, place, 0.5, 1.0, 1.0, plain, size, with, &noise);
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
    double                  place[DIG_AXES], plain[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
    double                  bare[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double                  feature[2][DIG_FEATURES];
    double                  curve[2][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double                  noise[2] = { 0.0 };
    plain_at(&gravel, MADE_ACTUAL, place, plain, size);
    dig_response_surface_curve(world.surface, MADE_ACTUAL, place, bare);
    for (int i = 0; i < 2; i++) {
        const double contrast = i == 0 ? 1.0 : 0.4;
        memcpy(feature[i], plain, sizeof plain);
        memcpy(curve[i], bare, sizeof bare);
        dig_soil_add(soil, DIG_EFFECT_LAYERING, MADE_ACTUAL, place, 0.5, contrast, 1.0, plain, size,
                     feature[i], &noise[i]);
        dig_soil_add_curve(soil, DIG_EFFECT_LAYERING, MADE_ACTUAL, place, 0.5, contrast, 1.0,
                           (const double(*)[DIG_CURVE_POINTS])bare, curve[i]);
    }
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        assert_close(feature[1][f] - plain[f], 0.4 * (feature[0][f] - plain[f]), 1e-12);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(curve[1][0][k] - bare[0][k], 0.4 * (curve[0][0][k] - bare[0][k]), 1e-12);
    }
    assert_true(noise[1] > 0.0);
    assert_close(noise[1], 0.16 * noise[0], 1e-12);
}

TEST(an_effect_that_is_absent_adds_nothing)
{
    const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };
    for (int e = 0; e < DIG_EFFECTS; e++) {
        if (dig_effect_is_of_machine((enum dig_effect_id)e) ||
            !dig_soil_knows(soil, (enum dig_effect_id)e, MADE_SIMPLE_A)) {
            continue;
        }
        double place[DIG_AXES], plain[DIG_FEATURES], with[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double noise = 0.0;
        plain_at(&gravel, MADE_SIMPLE_A, place, plain, size);
        memcpy(with, plain, sizeof with);
        dig_soil_add(soil, (enum dig_effect_id)e, MADE_SIMPLE_A, place, 0.0, 1.0, 1.0, plain, size,
                     with, &noise);
        assert_memory_equal(with, plain, sizeof with);
        assert_close(noise, 0.0, 0.0);
        assert_close(dig_soil_magnitude(soil, (enum dig_effect_id)e, 0.0), soil->absent[e], 0.0);
    }
}

TEST(features_are_those_of_the_curve)
{
    static const enum dig_effect_id effect[] = { DIG_EFFECT_COHESION, DIG_EFFECT_RATE_DEPENDENCE,
                                                 DIG_EFFECT_WEAR };
    const struct dig_gravel         gravel   = { { 0.5, 0.7, 3000 } };
    for (size_t e = 0; e < sizeof effect / sizeof effect[0]; e++) {
        double place[DIG_AXES], plain[DIG_FEATURES], with[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
        double noise = 0.0, of_curve[DIG_FEATURES];
        double bare[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        plain_at(&gravel, MADE_ACTUAL, place, plain, size);
        memcpy(with, plain, sizeof with);
        dig_soil_add(soil, effect[e], MADE_ACTUAL, place, 0.1, 1.0, 2.0, plain, size, with, &noise);
        dig_response_surface_curve(world.surface, MADE_ACTUAL, place, bare);
        memcpy(curve, bare, sizeof curve);
        dig_soil_add_curve(soil, effect[e], MADE_ACTUAL, place, 0.1, 1.0, 2.0,
                           (const double(*)[DIG_CURVE_POINTS])bare, curve);
        dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, of_curve);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            assert_close(with[f], of_curve[f], 1e-9 * size[f / DIG_FEATURE_BINS]);
        }
    }
}

// Over a bin the factor is that of its mean speed: 1 % of the dig's size for a strong dependence.
TEST(the_tooths_speed_tells_features_as_it_tells_the_curve)
{
    const struct dig_gravel gravel = { { 0.5, 0.7, 3000 } };
    double place[DIG_AXES], plain[DIG_FEATURES], with[DIG_FEATURES], size[DIG_FORCE_CHANNELS];
    double noise = 0.0, of_curve[DIG_FEATURES];
    double bare[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    soil->along = 1.0;
    plain_at(&gravel, MADE_ACTUAL, place, plain, size);
    memcpy(with, plain, sizeof with);
    dig_soil_add(soil, DIG_EFFECT_RATE_DEPENDENCE, MADE_ACTUAL, place, 0.3, 1.0, 0.0, plain, size,
                 with, &noise);
    dig_response_surface_curve(world.surface, MADE_ACTUAL, place, bare);
    memcpy(curve, bare, sizeof curve);
    dig_soil_add_curve(soil, DIG_EFFECT_RATE_DEPENDENCE, MADE_ACTUAL, place, 0.3, 1.0, 0.0,
                       (const double(*)[DIG_CURVE_POINTS])bare, curve);
    soil->along = 0.0;
    dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, of_curve);
    double most = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        assert_close(with[f], of_curve[f], 0.01 * size[f / DIG_FEATURE_BINS]);
        most = fmax(most, fabs(with[f] - plain[f]) / size[f / DIG_FEATURE_BINS]);
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
