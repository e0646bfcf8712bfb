// Insertion of grains, and what is left of them once they lie.

#include "tests/dem_fixture.h"

#include "offline_dem/dig/dig.h"
#include "offline_dem/dig/packing.h"

#include <math.h>

static const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };

static struct dig_bed insert(const struct dig_scene *const scene, const uint64_t seed)
{
    struct dig_bed bed;
    assert_int_equal(dig_packing_insert(scene, seed, &bed, NULL), DIG_OK);
    return bed;
}

TEST(inserted_grains_are_inside_and_apart)
{
    const struct dig_scene scene = dem_small_scene();
    struct dig_bed         bed   = insert(&scene, 1);
    const double *const x = bed.x_m, *const y = bed.y_m, *const z = bed.z_m;
    // The volume poured is what fill_factor says, to a grain.
    assert_close((double)bed.grains * GRAIN_kg / DENSITY, 0.694 * 0.06 * 0.045 * 0.03,
                 GRAIN_kg / DENSITY);
    double top_m = 0.0;
    for (size_t i = 0; i < bed.grains; i++) {
        assert_true(x[i] >= GRAIN_m && x[i] <= 0.06 - GRAIN_m);
        assert_true(fabs(y[i]) <= 0.0225 - GRAIN_m);
        assert_true(z[i] >= GRAIN_m);
        top_m = fmax(top_m, z[i] + GRAIN_m);
        for (size_t j = 0; j < i; j++) {
            assert_true(hypot(hypot(x[i] - x[j], y[i] - y[j]), z[i] - z[j]) >= 2.0 * GRAIN_m);
        }
    }
    assert_true(top_m <= 0.03 * 0.694 / 0.3);
    dig_bed_finish(&bed);
}

TEST(a_seed_names_a_packing)
{
    const struct dig_scene scene = dem_small_scene();
    struct dig_bed         bed[] = { insert(&scene, 7), insert(&scene, 7), insert(&scene, 8) };
    assert_memory_equal(bed[0].x_m, bed[1].x_m, bed[0].grains * sizeof *bed[0].x_m);
    assert_true(fabs(bed[0].x_m[0] - bed[2].x_m[0]) > 0.0);
    for (size_t k = 0; k < 3; k++) {
        dig_bed_finish(&bed[k]);
    }
}

TEST(a_column_that_is_full_grows)
{
    struct dig_scene scene       = dem_small_scene();
    scene.packing.solid_fraction = 0.45; // above what random insertion reaches
    struct dig_bed bed           = insert(&scene, 1);
    double         top_m         = 0.0;
    for (size_t i = 0; i < bed.grains; i++) {
        top_m = fmax(top_m, bed.z_m[i]);
    }
    assert_true(top_m > 0.03 * 0.694 / 0.45 && top_m < 2.0 * 0.03 * 0.694 / 0.45);
    dig_bed_finish(&bed);
}

TEST(what_cannot_fit_is_refused_and_nothing_written)
{
    struct dig_bed   bed   = { .grains = 77 };
    struct dig_scene scene = dem_small_scene();
    scene.box.y_max_m      = scene.box.y_min_m + 1.9 * GRAIN_m;
    assert_int_equal(dig_packing_insert(&scene, 1, &bed, NULL), DIG_EUNREACHABLE);
    scene                        = dem_small_scene();
    scene.packing.solid_fraction = 0.9; // 0.45 once the column is twice as tall
    assert_int_equal(dig_packing_insert(&scene, 1, &bed, NULL), DIG_EUNREACHABLE);
    scene                 = dem_small_scene();
    scene.bed.obstacles   = 1; // as wide as the box
    scene.bed.obstacle[0] = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_BOX,
                                                   .centre_m = { 0.03, 0.0, 0.1 },
                                                   .size_m   = { 0.06, 0.045, 0.4 } };
    assert_int_equal(dig_packing_insert(&scene, 1, &bed, NULL), DIG_EUNREACHABLE);
    assert_int_equal(bed.grains, 77);
}

TEST(more_grains_or_cells_than_memory_holds_are_refused)
{
    // The last two make a product of cells, or of their bytes, that a size_t wraps to little.
    static const struct {
        double x_m, y_m, diameter_m, solid_fraction, fill_factor;
    } huge[] = {
        { 1e25, 0.6, 0.06, 0.3, 0.7 },
        { 1e300, 1e300, 0.06, 0.3, 0.7 },
        { 1210.7919818456367, 1210.7919818456367, 0.001, 1.6223802512809142e-18,
          1.9643652339260583e-15 },
        { 2097152.0, 2097152.0, 0.001, 0.3, 0.3 },
    };
    for (size_t i = 0; i < sizeof huge / sizeof huge[0]; i++) {
        struct dig_scene scene       = dem_small_scene();
        struct dig_bed   bed         = { .grains = 77 };
        struct dig_error error       = { "" };
        scene.box.x_max_m            = huge[i].x_m;
        scene.box.y_min_m            = -0.5 * huge[i].y_m;
        scene.box.y_max_m            = 0.5 * huge[i].y_m;
        scene.material.diameter_m    = huge[i].diameter_m;
        scene.packing.solid_fraction = huge[i].solid_fraction;
        scene.packing.fill_factor    = huge[i].fill_factor;
        assert_int_equal(dig_packing_insert(&scene, 1, &bed, &error), DIG_EINVAL);
        assert_non_null(strstr(error.text, "box_m"));
        assert_non_null(strstr(error.text, "material.diameter_m"));
        assert_int_equal(bed.grains, 77);
    }
}

TEST(a_poured_bed_is_level_and_lies_on_its_floor)
{
    const struct dig_scene scene = dem_small_scene();
    struct dig_bed         bed;
    assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, 3, NULL, &bed, NULL), DIG_OK);
    struct dig_bed inserted = insert(&scene, 3);
    assert_in_range(bed.grains, 100, inserted.grains);
    dig_bed_finish(&inserted);
    double *const at = calloc(3 * bed.grains, sizeof *at);
    assert_non_null(at);
    double(*const x)[3] = (double(*)[3])at;
    for (size_t i = 0; i < bed.grains; i++) {
        x[i][0] = bed.x_m[i];
        x[i][1] = bed.y_m[i];
        x[i][2] = bed.z_m[i];
        // Levelling lets the bed give by much less than a grain.
        assert_true(bed.z_m[i] < 0.03 - 0.9 * GRAIN_m);
        assert_true(bed.z_m[i] > 0.9 * GRAIN_m);
        assert_true(bed.x_m[i] > 0.9 * GRAIN_m && bed.x_m[i] < 0.06 - 0.9 * GRAIN_m);
        assert_true(fabs(bed.y_m[i]) < 0.0225 - 0.9 * GRAIN_m);
    }
    // Left alone, the floor and the walls carry it, and it does not warm up.
    struct dig_world world = dem_world(bed.grains, (const double(*)[3])x, dem_material(0.5, 0.5));
    world.gravity_mps2[2]  = -GRAVITY;
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    dem_add_wall(&world, -1.0, 0.0, 0.0, -0.06);
    dem_add_wall(&world, 0.0, 1.0, 0.0, -0.0225);
    dem_add_wall(&world, 0.0, -1.0, 0.0, -0.0225);
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    dem_run(&world, 4000);
    double early_J = 0.0, late_J = 0.0, weight_N = 0.0;
    for (int k = 0; k < 2000; k++) {
        dem_run(&world, 1);
        early_J += dig_grains_kinetic_J(&world.grains);
        weight_N -= world.on_walls.f_N[2] / 2000.0;
    }
    dem_run(&world, test_is_quick() ? 2000 : 16000);
    for (int k = 0; k < 2000; k++) {
        dem_run(&world, 1);
        late_J += dig_grains_kinetic_J(&world.grains);
    }
    const double all_N = (double)bed.grains * GRAIN_kg * GRAVITY;
    assert_close(weight_N, all_N, 0.005 * all_N);
    assert_true(late_J <= 2.0 * early_J);
    // Ten thousandths of what the bed would gain by sinking a grain.
    assert_true(late_J / 2000.0 < 1e-4 * all_N * GRAIN_m);
    dig_world_finish(&world);
    free(at);
    dig_bed_finish(&bed);
    dig_bed_finish(&bed);
    dig_bed_finish(NULL);
}
