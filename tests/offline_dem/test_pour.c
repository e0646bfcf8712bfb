// Beds of more than one kind of equal spheres: what is poured is what lies there afterwards.

#include "tests/dem_fixture.h"

#include "core/ground.h"
#include "offline_dem/dig/dig.h"
#include "offline_dem/dig/packing.h"
#include "offline_dem/shapes/clump.h"

#include <math.h>

static struct dig_scene small_scene(void)
{
    struct dig_scene scene = dem_small_scene();
    scene.packing.settle_s = 0.3;
    scene.packing.relax_s  = 0.1;
    scene.time_step_s      = 5e-5;

    struct dig_trajectory *const t = &scene.trajectory[0];
    t->start_z_m                   = 0.07;
    t->phases                      = 2;
    t->phase[0]                    = (struct dig_phase){ "down", 0.1, 0.0, -0.15, 0.0 };
    t->phase[1]                    = (struct dig_phase){ "drag", 0.2, 0.05, 0.0, 0.0 };
    return scene;
}

static const struct dig_gravel gravel = { { 0.5, 0.5, DENSITY } };

static struct dig_bed pour(const struct dig_scene *const scene)
{
    struct dig_bed   bed;
    struct dig_error error = { "" };
    assert_ok(dig_bed_pour(NULL, scene, &gravel, 1, NULL, &bed, &error), error);
    return bed;
}

static double apart_m(const struct dig_bed *const bed, const size_t i, const size_t j)
{
    return hypot(hypot(bed->x_m[i] - bed->x_m[j], bed->y_m[i] - bed->y_m[j]),
                 bed->z_m[i] - bed->z_m[j]);
}

// Deepest overlap of two grains not of one clump, in the smaller one's radius.
static double deepest_overlap(const struct dig_bed *const bed)
{
    double most = 0.0;
    for (size_t i = 0; i < bed->grains; i++) {
        for (size_t j = 0; j < i; j++) {
            if (bed->clump == NULL || bed->clump[i] != bed->clump[j]) {
                const double gap_m = apart_m(bed, i, j) - bed->radius_m[i] - bed->radius_m[j];
                most               = fmax(most, -gap_m / fmin(bed->radius_m[i], bed->radius_m[j]));
            }
        }
    }
    return most;
}

static double mass_of(const struct dig_bed *const bed, const double radius_m)
{
    double sum_m3 = 0.0;
    for (size_t i = 0; i < bed->grains; i++) {
        if (fabs(bed->radius_m[i] - radius_m) < 1e-9) {
            sum_m3 += pow(bed->radius_m[i], 3.0);
        }
    }
    return sum_m3;
}

TEST(three_sizes_are_poured_by_mass)
{
    struct dig_scene scene = small_scene();
    scene.bed.sizes        = 3;
    scene.bed.size[0]      = (struct dig_size){ 0.006, 0.3 };
    scene.bed.size[1]      = (struct dig_size){ 0.0075, 0.4 };
    scene.bed.size[2]      = (struct dig_size){ 0.010, 0.3 };
    struct dig_bed poured  = { 0 };
    assert_int_equal(dig_packing_insert(&scene, 1, &poured, NULL), DIG_OK);
    assert_close(deepest_overlap(&poured), 0.0, 0.0);
    const double all =
        mass_of(&poured, 0.003) + mass_of(&poured, 0.00375) + mass_of(&poured, 0.005);
    assert_close(mass_of(&poured, 0.003) / all, 0.3, 0.01);
    assert_close(mass_of(&poured, 0.005) / all, 0.3, 0.02);
    // As much as fill_factor says, to a grain of each size.
    assert_close(all * 4.0 / 3.0 * DIG_PI, 0.694 * 0.06 * 0.045 * 0.03, 1e-6);
    dig_bed_finish(&poured);

    struct dig_bed bed = pour(&scene);
    assert_in_range(bed.grains, 100, 400);
    assert_true(deepest_overlap(&bed) < 0.05);
    for (size_t i = 0; i < bed.grains; i++) {
        assert_true(bed.z_m[i] + bed.radius_m[i] < 0.03 + 0.1 * GRAIN_m);
    }
    dig_bed_finish(&bed);
}

TEST(clumps_stay_whole_and_are_cut_whole)
{
    struct dig_scene scene = small_scene();
    scene.bed.clump =
        (struct dig_clump){ 3, { -1.0, 1.0, 0.3 }, { 0.0, 0.0, 0.8 }, { 0 }, { 1.0, 1.0, 0.7 } };
    struct dig_clump_shape shape;
    assert_int_equal(dig_clump_shape_make(&scene.bed.clump, &shape), DIG_OK);
    struct dig_bed bed = pour(&scene);
    assert_in_range(bed.grains, 150, 900);
    assert_int_equal(bed.grains % 3, 0);
    assert_non_null(bed.clump);
    for (size_t i = 0; i < bed.grains; i++) {
        const size_t first = i / 3 * 3;
        assert_int_equal(bed.clump[i], bed.clump[first]);
        assert_true(bed.z_m[i] + bed.radius_m[i] < 0.03 + 0.1 * GRAIN_m);
        const double *const a = shape.at[0];
        const double *const b = shape.at[i - first];
        const double        d = 2.0 * GRAIN_m * hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        assert_close(apart_m(&bed, first, i), d, 1e-10);
    }
    assert_true(deepest_overlap(&bed) < 0.05);
    // The bed can be dug, and its clumps must be those of the scene.
    struct dig_recording r = { 0 };
    assert_int_equal(
        dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], NULL, NULL, &r, NULL),
        DIG_OK);
    double Fx_N = 0.0;
    for (size_t k = r.rows / 2; k < r.rows; k++) {
        Fx_N += r.row[k].Fx_N;
    }
    assert_true(Fx_N < 0.0);
    dig_recording_finish(&r);
    struct dig_error error  = { "" };
    scene.bed.clump.spheres = 2;
    assert_refused(
        dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], NULL, NULL, &r, &error),
        error, DIG_EINVAL, "clumps");
    dig_bed_finish(&bed);
}

TEST(no_grain_is_poured_into_a_rock_or_through_it)
{
    struct dig_scene scene = small_scene();
    scene.bed.obstacles    = 2;
    scene.bed.obstacle[0]  = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_SPHERE,
                                                    .centre_m = { 0.02, 0.0, 0.01 },
                                                    .size_m   = { 0.024 } };
    scene.bed.obstacle[1]  = (struct dig_obstacle){ .shape    = DIG_OBSTACLE_BOX,
                                                    .centre_m = { 0.048, 0.0, 0.012 },
                                                    .size_m   = { 0.012, 0.03, 0.024 } };
    struct dig_bed bed     = pour(&scene);
    assert_in_range(bed.grains, 60, 300);
    size_t at_sphere = 0, at_box = 0;
    for (size_t i = 0; i < bed.grains; i++) {
        const double r = bed.radius_m[i];
        const double d = hypot(hypot(bed.x_m[i] - 0.02, bed.y_m[i]), bed.z_m[i] - 0.01) - 0.012 - r;
        assert_true(d > -0.05 * r);
        at_sphere += d < 0.0;
        const double ox = fmax(fabs(bed.x_m[i] - 0.048) - 0.006, 0.0);
        const double oy = fmax(fabs(bed.y_m[i]) - 0.015, 0.0);
        const double oz = fmax(fabs(bed.z_m[i] - 0.012) - 0.012, 0.0);
        const double b  = hypot(hypot(ox, oy), oz) - r;
        assert_true(b > -0.05 * r);
        at_box += b < 0.0;
    }
    // They carry some of the bed.
    assert_true(at_sphere > 5 && at_box > 5);
    dig_bed_finish(&bed);
}

TEST(layers_lie_where_they_are_wanted_and_weigh_what_they_should)
{
    struct dig_scene scene = small_scene();
    scene.bed.materials    = 1;
    scene.bed.material[0]  = (struct dig_other_material){ "ore", 0.9, 0.9, 4000.0, 0.2 };
    scene.bed.layers       = 1;
    scene.bed.layer[0]     = (struct dig_layer){ 1, 0.0, 0.012 };
    struct dig_bed bed     = pour(&scene);
    size_t         ore     = 0;
    assert_non_null(bed.material);
    for (size_t i = 0; i < bed.grains; i++) {
        ore += bed.material[i];
        // Little moves after the layers are told apart.
        assert_int_equal(bed.material[i], bed.z_m[i] < 0.012 + (bed.material[i] ? 1e-3 : -1e-3));
    }
    assert_in_range(ore, 50, bed.grains - 50);
    dig_bed_finish(&bed);
}

TEST(the_ground_has_the_profile_it_is_given)
{
    struct dig_scene scene   = small_scene();
    scene.bed.surface        = 2;
    scene.bed.surface_x_m[1] = 0.06;
    scene.bed.surface_z_m[0] = 0.022;
    scene.bed.surface_z_m[1] = 0.036;
    struct dig_bed bed       = pour(&scene);
    double         top_m[2]  = { 0.0, 0.0 };
    for (size_t i = 0; i < bed.grains; i++) {
        assert_true(bed.z_m[i] + bed.radius_m[i] <
                    dig_scene_ground_m(&scene, bed.x_m[i], bed.y_m[i]) + 0.3 * GRAIN_m);
        double *const t = &top_m[bed.x_m[i] > 0.03];
        *t              = fmax(*t, bed.z_m[i]);
    }
    assert_true(top_m[1] > top_m[0] + GRAIN_m);
    assert_true(top_m[1] > 0.028);
    dig_bed_finish(&bed);
}

// More grains lie below the same ground.
TEST(a_pressed_bed_is_denser)
{
    struct dig_scene scene      = small_scene();
    size_t           below[2]   = { 0, 0 };
    const double     press_Pa[] = { 0.0, 1e4 };
    for (uint64_t seed = 1; seed <= 3; seed++) {
        for (size_t k = 0; k < 2; k++) {
            struct dig_bed bed;
            scene.bed.preload_Pa = press_Pa[k];
            assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, seed, NULL, &bed, NULL), DIG_OK);
            below[k] += bed.grains;
            dig_bed_finish(&bed);
        }
    }
    assert_true(below[1] > below[0] + 6);

    struct dig_bed   bed   = { .grains = 77 };
    struct dig_error error = { "" };
    scene.bed.preload_Pa   = 1e6;
    assert_int_equal(dig_bed_pour(NULL, &scene, &gravel, 1, NULL, &bed, &error), DIG_EINVAL);
    assert_contains(error.text, "bed.preload_Pa: 1e+06");
    assert_int_equal(bed.grains, 77);
}

TEST(a_bed_that_was_dug_before_digs_differently_and_repeats)
{
    struct dig_scene     scene = small_scene();
    struct dig_bed       bed   = pour(&scene);
    struct dig_recording r[4]  = { { 0 } };
    for (size_t k = 0; k < 4; k++) {
        scene.bed.earlier_digs   = k == 0 ? 0 : 1;
        scene.bed.earlier_as_dug = k == 3;
        assert_int_equal(
            dig_dig_run(NULL, &scene, &gravel, &bed, &scene.trajectory[0], NULL, NULL, &r[k], NULL),
            DIG_OK);
        assert_int_equal(r[k].rows, r[0].rows);
    }
    const size_t bytes = r[0].rows * sizeof *r[0].row;
    assert_memory_equal(r[1].row, r[2].row, bytes);
    assert_memory_not_equal(r[0].row, r[1].row, bytes);
    assert_memory_not_equal(r[1].row, r[3].row, bytes);
    for (size_t k = 0; k < 4; k++) {
        dig_recording_finish(&r[k]);
    }
    dig_bed_finish(&bed);
}

TEST(the_ground_may_differ_across_the_bed)
{
    struct dig_scene scene = small_scene();
    scene.bed.profiles     = 2;
    scene.bed.profile[0] = (struct dig_ground_profile){ -0.02, 2, { 0.0, 0.06 }, { 0.036, 0.028 } };
    scene.bed.profile[1] = (struct dig_ground_profile){ 0.02, 2, { 0.0, 0.06 }, { 0.02, 0.028 } };
    struct dig_bed bed   = pour(&scene);
    double         top_m[2] = { 0.0, 0.0 };
    for (size_t i = 0; i < bed.grains; i++) {
        assert_true(bed.z_m[i] + bed.radius_m[i] <
                    dig_scene_ground_m(&scene, bed.x_m[i], bed.y_m[i]) + 0.3 * GRAIN_m);
        if (bed.x_m[i] < 0.02) {
            double *const t = &top_m[bed.y_m[i] > 0.0];
            *t              = fmax(*t, bed.z_m[i]);
        }
    }
    assert_true(top_m[0] > top_m[1] + GRAIN_m);
    assert_true(top_m[0] > 0.028);
    dig_bed_finish(&bed);
}
