// Tests for files/bed_csv.c

#include "files/bed_csv.h"

#include "tests/scratch.h"

TEST(a_bed_is_read_back_bit_by_bit)
{
    double x[] = { 0.1, 1.0 / 3 }, y[] = { -0.05, 1e-17 }, z[] = { 0.03, 2.0 / 7 },
           radius[]              = { 0.00375, 0.003 };
    const struct dig_bed written = {
        .grains = 2, .x_m = x, .y_m = y, .z_m = z, .radius_m = radius
    };
    struct dig_bed    read = { 0 };
    const char *const path = scratch_path("bed.csv");
    assert_int_equal(dig_bed_write(path, &written, NULL), DIG_OK);
    assert_int_equal(dig_bed_read(path, &read, NULL), DIG_OK);
    assert_int_equal(read.grains, 2);
    assert_memory_equal(read.x_m, x, sizeof x);
    assert_memory_equal(read.y_m, y, sizeof y);
    assert_memory_equal(read.z_m, z, sizeof z);
    assert_memory_equal(read.radius_m, radius, sizeof radius);
    assert_null(read.material);
    assert_null(read.clump);
    dig_bed_finish(&read);
}

TEST(materials_and_clumps_are_kept)
{
    double   x[3] = { 0.1, 0.2, 0.3 }, radius[3] = { 1.0, 1.0, 1.0 };
    uint8_t  material[] = { 0, 255, 3 };
    uint32_t clump[]    = { 1, UINT32_MAX, 7 };
    for (int which = 1; which <= 3; which++) {
        const struct dig_bed written = {
            .grains   = 3,
            .x_m      = x,
            .y_m      = x,
            .z_m      = x,
            .radius_m = radius,
            .material = (which & 1) != 0 ? material : NULL,
            .clump    = (which & 2) != 0 ? clump : NULL,
        };
        struct dig_bed    read = { 0 };
        const char *const path = scratch_path("bed.csv");
        assert_int_equal(dig_bed_write(path, &written, NULL), DIG_OK);
        assert_int_equal(dig_bed_read(path, &read, NULL), DIG_OK);
        assert_int_equal(read.material != NULL, (which & 1) != 0);
        assert_int_equal(read.clump != NULL, (which & 2) != 0);
        if (read.material != NULL) {
            assert_memory_equal(read.material, material, sizeof material);
        }
        if (read.clump != NULL) {
            assert_memory_equal(read.clump, clump, sizeof clump);
        }
        dig_bed_finish(&read);
    }
}

TEST(the_bed_of_the_formats_loads)
{
    struct dig_bed read = { 0 };
    assert_int_equal(dig_bed_read("tests/data/formats/bed.csv", &read, NULL), DIG_OK);
    assert_int_equal(read.grains, 3);
    dig_bed_finish(&read);
}

TEST(defects_are_told_and_nothing_is_written)
{
    static const char *const bad[][2] = {
        { "x_m,y_m,z_m\n0,0,0\n", ":1: column radius_m: missing" },
        { "x_m,y_m,z_m,radius_m\n0,0,0,0\n", ":2: column radius_m: 0, expected > 0" },
        { "x_m,y_m,z_m,radius_m,material\n0,0,0,1,0\n0,0,0,1,0.5\n",
          ":3: column material: 0.5, expected a whole number" },
        { "x_m,y_m,z_m,radius_m,material\n0,0,0,1,256\n", ":2: column material: 256" },
        { "x_m,y_m,z_m,radius_m,material\n0,0,0,1,-1\n", ":2: column material: -1" },
        { "x_m,y_m,z_m,radius_m,clump\n0,0,0,1,0\n", ":2: column clump: 0, expected" },
        { "x_m,y_m,z_m,radius_m,clump\n0,0,0,1,4294967296\n", ":2: column clump: 4.29497e+09" },
        { "x_m,y_m,z_m,radius_m,clump\n0,0,0,1,\n", ":2: column clump: \"\"" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_error error = { "" };
        struct dig_bed   read  = { .grains = 42 };
        assert_refused(dig_bed_read(scratch_write("bad.csv", bad[i][0]), &read, &error), error,
                       DIG_EINVAL, bad[i][1]);
        assert_int_equal(read.grains, 42);
        assert_null(read.x_m);
    }
    struct dig_error error = { "" };
    struct dig_bed   read  = { .grains = 42 };
    assert_int_equal(dig_bed_read(scratch_path("absent.csv"), &read, &error), DIG_EIO);
    assert_contains(error.text, "absent.csv: No such file");
    assert_int_equal(read.grains, 42);
}

TESTS_WITH(scratch_setup, scratch_teardown)
