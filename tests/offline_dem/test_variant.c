// Tests for offline_dem/dig/variant.c: what each effect does to the rig's scene.

#include "core/ground.h"
#include "core/units.h"
#include "offline_dem/dig/variant.h"
#include "tests/read.h"

#include <string.h>

static struct dig_scene make(const enum dig_effect_id effect, const double magnitude)
{
    const struct dig_scene plain = read_scene("config/scenes/rig.yaml");
    struct dig_scene       varied;
    struct dig_error       error = { "" };
    assert_ok(dig_variant_make(&plain, effect, magnitude, &varied, &error), error);
    assert_int_equal(dig_scene_check(&varied, &error), DIG_OK);
    return varied;
}

TEST(every_effect_of_a_bed_makes_another_scene)
{
    const struct dig_scene plain = read_scene("config/scenes/rig.yaml");
    char                   before[65];
    dig_scene_hash(&plain, before);
    static const struct {
        enum dig_effect_id effect;
        double             magnitude[2];
        const char        *unit;
    } held[] = {
        { DIG_EFFECT_COHESION, { 1e4, 2e4 }, "J/m3" },
        { DIG_EFFECT_ADHESION, { 1e4, 2e4 }, "J/m3" },
        { DIG_EFFECT_POLYDISPERSITY, { 1.667, 2.0 }, "1" },
        { DIG_EFFECT_GRAIN_SHAPE, { 1.3, 2.0 }, "1" },
        { DIG_EFFECT_GROUND_SLOPE, { -8.0, 8.0 }, "deg" },
        { DIG_EFFECT_LAYERING, { 0.04, 0.05 }, "m" },
        { DIG_EFFECT_OBSTACLE, { 0.02, 0.03 }, "m" },
        { DIG_EFFECT_COMPACTION, { 1.0, 2.0 }, "digs" },
        { DIG_EFFECT_BUCKET_FRICTION, { 0.4, 0.75 }, "1" },
    };
    for (size_t i = 0; i < sizeof held / sizeof held[0]; i++) {
        char hex[2][65];
        for (int k = 0; k < 2; k++) {
            const struct dig_scene varied = make(held[i].effect, held[i].magnitude[k]);
            dig_scene_hash(&varied, hex[k]);
            assert_string_not_equal(hex[k], before);
        }
        assert_string_not_equal(hex[0], hex[1]);
        assert_string_equal(dig_variant_unit(held[i].effect), held[i].unit);
    }
}

TEST(what_sticks_to_itself_sticks_to_the_bucket)
{
    const struct dig_scene cohesive = make(DIG_EFFECT_COHESION, 2e4);
    assert_close(cohesive.laws.cohesion_Jpm3, 2e4, 0.0);
    assert_close(cohesive.laws.adhesion_Jpm3, 2e4, 0.0);
    const struct dig_scene adhesive = make(DIG_EFFECT_ADHESION, 2e4);
    assert_close(adhesive.laws.cohesion_Jpm3, 0.0, 0.0);
    assert_close(adhesive.laws.adhesion_Jpm3, 2e4, 0.0);
}

TEST(sizes_are_mixed_as_in_the_reference)
{
    const struct dig_scene s = make(DIG_EFFECT_POLYDISPERSITY, 5.0 / 3.0);
    assert_int_equal(s.bed.sizes, 3);
    assert_close(s.bed.size[0].diameter_m, 0.006, 1e-12);
    assert_close(s.bed.size[1].diameter_m, 0.0075, 1e-12);
    assert_close(s.bed.size[2].diameter_m, 0.010, 1e-12);
    assert_close(s.time_step_s, 5e-5, 1e-15);
}

TEST(a_slope_passes_below_every_tooth_and_touches_one)
{
    for (double slope = -12.0; slope <= 12.0; slope += 6.0) {
        if (fabs(slope) < 1.0) {
            continue;
        }
        const struct dig_scene s = make(DIG_EFFECT_GROUND_SLOPE, slope);
        assert_close((dig_scene_ground_m(&s, 0.2, 0.0) - dig_scene_ground_m(&s, 0.1, 0.0)) / 0.1,
                     tan(slope * DIG_RAD_PER_DEG), 1e-9);
        // The tooth is below the pin by its length, turned by theta.
        double least_m = 1.0;
        for (size_t i = 0; i < s.trajectories; i++) {
            const struct dig_trajectory *const t   = &s.trajectory[i];
            const double                       x_m = t->start_x_m + 0.09 * sin(t->theta0_rad);
            const double                       z_m = t->start_z_m - 0.09 * cos(t->theta0_rad);
            least_m = fmin(least_m, z_m - dig_scene_ground_m(&s, x_m, 0.0));
        }
        assert_close(least_m, 0.0, 1e-9);
    }
    // Steep enough to reach the floor: it stays covered.
    const struct dig_scene steep = make(DIG_EFFECT_GROUND_SLOPE, -30.0);
    assert_close(dig_scene_ground_m(&steep, 0.31, 0.0), 0.015, 1e-12);
}

TEST(a_layer_is_hard_or_loose_by_its_sign)
{
    struct dig_scene s = make(DIG_EFFECT_LAYERING, 0.05);
    assert_close(s.bed.material[0].friction, 0.9, 0.0);
    assert_close(s.bed.layer[0].to_m, 0.05, 1e-15);
    s = make(DIG_EFFECT_LAYERING, -0.04);
    assert_close(s.bed.layer[0].to_m, 0.04, 1e-15);
    assert_close(s.bed.material[0].friction, 0.3, 0.0);
    assert_close(s.bed.material[0].density_kgpm3, 1500.0, 0.0);
}

TEST(an_obstacle_stands_in_the_way)
{
    const struct dig_scene           s = make(DIG_EFFECT_OBSTACLE, 0.02);
    const struct dig_obstacle *const o = &s.bed.obstacle[0];
    assert_false(o->movable);
    // The tooth enters at .06 and, at the drag's end, leaves at .06 + .01509 + .0926.
    assert_close(o->centre_m[0], 0.5 * (0.06 + 0.16769), 1e-4);
    assert_close(o->centre_m[1], 0.0, 0.0);
    assert_close(o->centre_m[2], 0.085, 0.0);
    assert_close(o->size_m[0], 0.02, 0.0);
}

TEST(a_clump_is_as_long_as_it_says)
{
    const struct dig_scene        s = make(DIG_EFFECT_GRAIN_SHAPE, 1.6);
    const struct dig_clump *const c = &s.bed.clump;
    assert_int_equal(c->spheres, 2);
    assert_close((c->x[1] - c->x[0] + c->radius[0] + c->radius[1]) / (2.0 * c->radius[0]), 1.6,
                 1e-12);
    assert_true(s.time_step_s < 6.25e-5 && s.time_step_s > 0.75 * 6.25e-5);
}

TEST(what_no_bed_can_hold_is_refused_by_name)
{
    const struct dig_scene plain = read_scene("config/scenes/rig.yaml");
    static const struct {
        enum dig_effect_id effect;
        double             magnitude;
    } bad[] = {
        { DIG_EFFECT_CYLINDER_FRICTION, 1.0 }, { DIG_EFFECT_UNLISTED, 1.0 },
        { DIG_EFFECT_COHESION, 0.0 },          { DIG_EFFECT_COHESION, -5.0 },
        { DIG_EFFECT_ADHESION, NAN },          { DIG_EFFECT_POLYDISPERSITY, 1.0 },
        { DIG_EFFECT_GRAIN_SHAPE, 2.5 },       { DIG_EFFECT_GROUND_SLOPE, 0.0 },
        { DIG_EFFECT_GROUND_SLOPE, 45.0 },     { DIG_EFFECT_LAYERING, 0.2 },
        { DIG_EFFECT_OBSTACLE, INFINITY },     { DIG_EFFECT_COMPACTION, 1.5 },
        { DIG_EFFECT_COMPACTION, 0.0 },        { DIG_EFFECT_LAYERING, -0.2 },
        { DIG_EFFECT_LAYERING, 0.0 },          { DIG_EFFECT_BUCKET_FRICTION, 0.0 },
        { DIG_EFFECT_BUCKET_FRICTION, 1.01 },  { DIG_EFFECT_BUCKET_FRICTION, NAN },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_scene varied;
        memset(&varied, 0x5a, sizeof varied);
        const struct dig_scene untouched = varied;
        struct dig_error       error     = { "" };
        assert_int_equal(dig_variant_make(&plain, bad[i].effect, bad[i].magnitude, &varied, &error),
                         DIG_EINVAL);
        assert_memory_equal(&varied, &untouched, sizeof varied);
        assert_contains(error.text, dig_effect_name(bad[i].effect));
    }
    assert_null(dig_variant_unit(DIG_EFFECT_CYLINDER_FRICTION));
    assert_null(dig_variant_unit(DIG_EFFECT_RATE_DEPENDENCE));
}
