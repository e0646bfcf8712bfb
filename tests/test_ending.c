// Tests for estimator/ending.c: a path of two legs, by hand. Digs driven through the estimator and
// given up: test_recognition.c, test_estimator_digs.c.

#include "estimator/ending.h"

#include "tests/testlib.h"

static const double limit_m = 0.016;

// 100 mm along, then 100 mm up.
static struct dig_route legs(void)
{
    return (
        struct dig_route){ .corners = 3,
                           .corner  = { { 0.0, 0.0, 0.0 }, { 0.1, 0.0, 0.0 }, { 0.1, 0.1, 0.0 } },
                           .at_m    = { 0.0, 0.1, 0.2 } };
}

// Where the ground lies and how the bucket stands is the track's.
static enum dig_ending ending(const double reached, const double x_m, const double z_m,
                              const double turn_m)
{
    const struct dig_route      route = legs();
    const struct dig_track      track = { .dx_m = 0.5, .dz_m = -0.3, .turn_m = 0.02 };
    const struct dig_path_point last  = { 0.5 + x_m, -0.3 + z_m, 0.02 + turn_m };
    return dig_ending_of(&route, &track, reached, &last, limit_m);
}

static void a_dig_to_the_end_is_whole_wherever_the_bucket_goes_then(void **state)
{
    (void)state;
    assert_int_equal(ending(1.0, 0.1, 0.1, 0.0), DIG_ENDING_WHOLE);
    assert_int_equal(ending(0.95, 0.3, 0.5, 0.1), DIG_ENDING_WHOLE);
    assert_int_equal(ending(0.949, 0.3, 0.5, 0.1), DIG_ENDING_ABORTED);
}

static void what_leaves_the_path_before_its_end_is_aborted(void **state)
{
    (void)state;
    assert_int_equal(ending(0.3, 0.06, 0.017, 0.0), DIG_ENDING_ABORTED);  // lifted out
    assert_int_equal(ending(0.3, 0.06, 0.0, 0.017), DIG_ENDING_ABORTED);  // curled where it stood
    assert_int_equal(ending(0.3, 0.06, 0.0, -0.017), DIG_ENDING_ABORTED); // opened
    assert_int_equal(ending(0.5, 0.1, -0.017, 0.0), DIG_ENDING_ABORTED);  // pushed in further
}

// Back along what was dug is away from what was left to dig.
static void what_goes_back_the_way_it_came_is_aborted(void **state)
{
    (void)state;
    assert_int_equal(ending(0.4, 0.08 - 0.017, 0.0, 0.0), DIG_ENDING_ABORTED);
    assert_int_equal(ending(0.4, 0.08 - 0.015, 0.0, 0.0), DIG_ENDING_OPEN);
}

// Light gravel is no longer felt while the bucket still goes its way: no one knows whether the
// trajectory was dug to its end.
static void what_is_still_on_its_way_is_left_open(void **state)
{
    (void)state;
    assert_int_equal(ending(0.3, 0.06, 0.0, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.3, 0.06, 0.015, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.6, 0.1, 0.09, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.45, 0.09, 0.05, 0.0), DIG_ENDING_OPEN); // cut the corner
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dig_to_the_end_is_whole_wherever_the_bucket_goes_then),
        cmocka_unit_test(what_leaves_the_path_before_its_end_is_aborted),
        cmocka_unit_test(what_goes_back_the_way_it_came_is_aborted),
        cmocka_unit_test(what_is_still_on_its_way_is_left_open),
    };
    return cmocka_run_group_tests_name("ending", tests, NULL, NULL);
}
