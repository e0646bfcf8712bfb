// Where springs go with the density, so do curves: twice the density doubles every force to the
// last bit, as a computer multiplies by two without rounding. The step is not touched.

#include "offline_dem/dig/dig.h"
#include "tests/dem_fixture.h"

static struct dig_scene scaling_scene(void)
{
    struct dig_scene scene        = dem_short_dig_scene(0.05);
    scene.time_step_s             = 0.0; // derived
    scene.material.young_at_kgpm3 = DENSITY;
    return scene;
}

static struct dig_recording dig(const struct dig_stepper *const stepper,
                                const struct dig_scene *const scene, const double density_kgpm3)
{
    const struct dig_gravel gravel = { { 0.5, 0.3, density_kgpm3 } };
    struct dig_bed          bed    = { 0 };
    struct dig_recording    r      = { 0 };
    struct dig_error        error  = { "" };
    assert_ok(dig_bed_pour(stepper, scene, &gravel, 3, NULL, &bed, &error), error);
    assert_ok(
        dig_dig_run(stepper, scene, &gravel, &bed, &scene->trajectory[0], NULL, NULL, &r, &error),
        error);
    dig_bed_finish(&bed);
    return r;
}

static void expect_double(const struct dig_recording *const once,
                          const struct dig_recording *const twice)
{
    double most_Nm = 0.0;
    assert_int_equal(once->rows, twice->rows);
    for (size_t i = 0; i < once->rows; i++) {
        const struct dig_force_row *const a = &once->row[i];
        const struct dig_force_row *const b = &twice->row[i];
        assert_close(b->t_s, a->t_s, 0.0);
        assert_close(b->My_Nm, 2.0 * a->My_Nm, 0.0);
        assert_close(b->Fx_N, 2.0 * a->Fx_N, 0.0);
        assert_close(b->Fz_N, 2.0 * a->Fz_N, 0.0);
        assert_close(b->carried_kg, 2.0 * a->carried_kg, 0.0);
        most_Nm = fmax(most_Nm, fabs(a->My_Nm));
    }
    assert_true(most_Nm > 1e-3);
}

TEST(twice_the_density_doubles_every_force)
{
    const struct dig_scene scene = scaling_scene();
    for (int single = 0; single < (test_is_quick() ? 1 : 2); single++) {
        const struct dig_stepper stepper = { .single_precision = single == 1 };
        struct dig_recording     once    = dig(&stepper, &scene, DENSITY);
        struct dig_recording     twice   = dig(&stepper, &scene, 2.0 * DENSITY);
        expect_double(&once, &twice);
        dig_recording_finish(&once);
        dig_recording_finish(&twice);
    }
}

// The test can fail: with springs that stay, heavy grains sink deeper into each other.
TEST(springs_that_stay_are_felt)
{
    struct dig_scene scene        = scaling_scene();
    scene.material.young_at_kgpm3 = 0.0;
    struct dig_recording once     = dig(NULL, &scene, DENSITY);
    struct dig_recording twice    = dig(NULL, &scene, 2.0 * DENSITY);
    double               off_Nm   = 0.0;
    for (size_t i = 0; i < once.rows && i < twice.rows; i++) {
        off_Nm = fmax(off_Nm, fabs(twice.row[i].My_Nm - 2.0 * once.row[i].My_Nm));
    }
    assert_true(off_Nm > 1e-4);
    dig_recording_finish(&once);
    dig_recording_finish(&twice);
}
