// Tests for core/scene.c

#include "core/scene.h"

#include "tests/testlib.h"

static struct dig_scene plausible(void)
{
    return (struct dig_scene){
        .name         = "box",
        .bucket       = { 3, { 0.0, -0.04, 0.0 }, { -0.09, -0.04, 0.0 }, 0.07 },
        .box          = { 0.0, 0.3, -0.06, 0.06, 0.0, 0.085 },
        .packing      = { 0.3, 0.7, 0.3, 0.45, 0.15 },
        .material     = { 0.0075, 5e6, 0.2, 0.2, 2.0 },
        .gravity_mps2 = 9.81,
        .time_step_s  = 0.0,
        .output_s     = 0.005,
        .trajectories = 1,
        .trajectory   = { { "down", 0.0, 0.1, 0.2, 1, { { "down", 1.0, 0.0, -0.01, 0.0 } } } },
    };
}

static void expect_refusal(const struct dig_scene *const scene, const char *const starts_with)
{
    struct dig_error e = { "" };
    assert_refused_by(dig_scene_check(scene, &e), e, DIG_EINVAL, starts_with);
}

TEST(what_cannot_be_computed_is_refused_by_its_key)
{
    struct dig_scene s = plausible();
    assert_int_equal(dig_scene_check(&s, NULL), DIG_OK);
    const struct {
        const char *key;
        double     *at, wrong;
    } number[] = {
        { "material.young_Pa: -1", &s.material.young_Pa, -1.0 },
        { "material.restitution", &s.material.restitution, NAN },
        { "box_m.y", &s.box.y_max_m, s.box.y_min_m + 0.01 },
        { "trajectories[0].phases[0].duration_s", &s.trajectory[0].phase[0].duration_s, 0.0 },
        { "output_s", &s.output_s, 0.05 },
    };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        *number[i].at = number[i].wrong;
        expect_refusal(&s, number[i].key);
        s = plausible();
    }
    s.bucket.points = 2;
    expect_refusal(&s, "bucket.profile_m");
    s               = plausible();
    s.bucket.x_m[2] = s.bucket.x_m[1];
    s.bucket.z_m[2] = s.bucket.z_m[1];
    expect_refusal(&s, "bucket.profile_m[2]");
    s               = plausible();
    s.trajectory[1] = s.trajectory[0];
    s.trajectories  = 2;
    expect_refusal(&s, "trajectories[1].name");
}

TEST(tooth_is_the_first_point_and_trajectories_are_found)
{
    const struct dig_scene s = plausible();
    assert_close(dig_scene_tooth_m(&s), 0.09, 1e-15);
    assert_ptr_equal(dig_scene_find(&s, "down"), &s.trajectory[0]);
    assert_null(dig_scene_find(&s, "up"));
}

// Every number that changes a curve must change the identity.
TEST(the_canonical_text_changes_with_every_number)
{
    char             before[DIG_SCENE_TEXT_SIZE], after[DIG_SCENE_TEXT_SIZE];
    struct dig_scene s = plausible();
    dig_scene_canonical(&s, before);

    double *const number[] = {
        &s.bucket.width_m,
        &s.bucket.x_m[1],
        &s.bucket.z_m[2],
        &s.box.x_min_m,
        &s.box.z_max_m,
        &s.packing.solid_fraction,
        &s.packing.fill_factor,
        &s.packing.fall_mps,
        &s.packing.settle_s,
        &s.packing.relax_s,
        &s.material.diameter_m,
        &s.material.young_Pa,
        &s.material.poisson,
        &s.material.restitution,
        &s.gravity_mps2,
        &s.material.characteristic_velocity_mps,
        &s.material.young_at_kgpm3,
        &s.time_step_s,
        &s.output_s,
        &s.trajectory[0].theta0_rad,
        &s.trajectory[0].start_z_m,
        &s.trajectory[0].phase[0].duration_s,
        &s.trajectory[0].phase[0].omega_radps,
    };
    for (size_t i = 0; i < sizeof number / sizeof number[0]; i++) {
        const double kept = *number[i];
        *number[i]        = kept + 1e-9;
        dig_scene_canonical(&s, after);
        assert_string_not_equal(before, after);
        *number[i] = kept;
    }
    s.may_tremble = true; // allows, and changes no number
    dig_scene_canonical(&s, after);
    assert_string_equal(before, after);
}
