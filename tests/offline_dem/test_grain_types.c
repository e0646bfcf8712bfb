#include "offline_dem/world/grain_types.h"

#include "tests/testlib.h"

static const struct dig_gravel gravel = { { 0.5, 0.4, 2500.0 } };

static double pull_Jpm3(const struct dig_scene *const scene, const size_t a, const size_t b)
{
    return dig_grain_types_between(scene, &gravel, a, b).cohesion_Jpm3;
}

TEST(grains_pull_by_cohesion_the_bucket_by_adhesion_walls_not_at_all)
{
    const struct dig_scene scene = { .laws = { .cohesion_Jpm3 = 3e4, .adhesion_Jpm3 = 2e4 } };
    assert_close(pull_Jpm3(&scene, 0, 0), 3e4, 0.0);
    assert_close(pull_Jpm3(&scene, 0, DIG_MATERIAL_WALLS), 0.0, 0.0);
    assert_close(pull_Jpm3(&scene, DIG_MATERIAL_WALLS, 0), 0.0, 0.0);
    assert_close(pull_Jpm3(&scene, 0, DIG_MATERIAL_BUCKET), 2e4, 0.0);
    assert_close(pull_Jpm3(&scene, DIG_MATERIAL_BUCKET, 0), 2e4, 0.0);
}

TEST(walls_and_bucket_have_the_grains_own_friction)
{
    const struct dig_scene scene = { .material = { .restitution = 0.2 } };
    for (size_t other = DIG_MATERIAL_BUCKET; other <= DIG_MATERIAL_WALLS; other++) {
        const struct dig_law_material between = dig_grain_types_between(&scene, &gravel, 0, other);
        assert_close(between.friction, 0.5, 0.0);
        assert_close(between.rolling, 0.4, 0.0);
        assert_close(between.restitution, 0.2, 0.0);
    }
}

// The pair's value, which both materials decide; walls keep the gravel's.
TEST(a_smoother_bucket_takes_its_share_off_both_frictions_and_nothing_off_walls)
{
    struct dig_scene scene = {
        .material = { .restitution = 0.2 },
        .laws     = { .bucket_smoothness = 0.75 },
    };
    const struct dig_law_material bucket =
        dig_grain_types_between(&scene, &gravel, DIG_MATERIAL_BUCKET, 0);
    assert_close(bucket.friction, 0.125, 1e-15);
    assert_close(bucket.rolling, 0.1, 1e-15);
    assert_close(bucket.restitution, 0.2, 0.0);
    const size_t rough[] = { 0, DIG_MATERIAL_WALLS };
    for (size_t i = 0; i < 2; i++) {
        const struct dig_law_material between =
            dig_grain_types_between(&scene, &gravel, 0, rough[i]);
        assert_close(between.friction, 0.5, 0.0);
        assert_close(between.rolling, 0.4, 0.0);
    }
    // Off what a pair says as well: steel that is worn smooth.
    scene.bed.pairs   = 1;
    scene.bed.pair[0] = (struct dig_material_pair){ 0, DIG_MATERIAL_BUCKET, 0.4, 0.2, 0.3 };
    const struct dig_law_material steel =
        dig_grain_types_between(&scene, &gravel, 0, DIG_MATERIAL_BUCKET);
    assert_close(steel.friction, 0.1, 1e-15);
    assert_close(steel.rolling, 0.05, 1e-15);
    assert_close(steel.restitution, 0.3, 0.0);
}

// Between two materials of grains the smaller frictions and the geometric mean of restitution.
TEST(unlike_grains_share_the_smoother_surface)
{
    const struct dig_scene scene = {
        .material = { .restitution = 0.2 },
        .bed      = { .materials = 1, .material = { { "layer", 0.9, 0.1, 4000.0, 0.8 } } }
    };
    const struct dig_law_material between = dig_grain_types_between(&scene, &gravel, 0, 1);
    assert_close(between.friction, 0.5, 0.0);
    assert_close(between.rolling, 0.1, 0.0);
    assert_close(between.restitution, 0.4, 1e-15);
}
