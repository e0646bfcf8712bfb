// Tests for estimator/track/ending.c: a path of two legs, by hand. Digs driven through the
// estimator and given up: test_recognition.c, test_estimator_digs.c.

#include "estimator/track/ending.h"

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

TEST(a_dig_to_the_end_is_whole_wherever_the_bucket_goes_then)
{
    assert_int_equal(ending(1.0, 0.1, 0.1, 0.0), DIG_ENDING_WHOLE);
    assert_int_equal(ending(0.95, 0.3, 0.5, 0.1), DIG_ENDING_WHOLE);
    assert_int_equal(ending(0.949, 0.3, 0.5, 0.1), DIG_ENDING_ABORTED);
}

TEST(what_leaves_the_path_before_its_end_is_aborted)
{
    assert_int_equal(ending(0.3, 0.06, 0.017, 0.0), DIG_ENDING_ABORTED);  // lifted out
    assert_int_equal(ending(0.3, 0.06, 0.0, 0.017), DIG_ENDING_ABORTED);  // curled where it stood
    assert_int_equal(ending(0.3, 0.06, 0.0, -0.017), DIG_ENDING_ABORTED); // opened
    assert_int_equal(ending(0.5, 0.1, -0.017, 0.0), DIG_ENDING_ABORTED);  // pushed in further
}

// Back along what was dug is away from what was left to dig.
TEST(what_goes_back_the_way_it_came_is_aborted)
{
    assert_int_equal(ending(0.4, 0.08 - 0.017, 0.0, 0.0), DIG_ENDING_ABORTED);
    assert_int_equal(ending(0.4, 0.08 - 0.015, 0.0, 0.0), DIG_ENDING_OPEN);
}

// Light gravel is no longer felt while the bucket still goes its way: no one knows whether the
// trajectory was dug to its end.
TEST(what_is_still_on_its_way_is_left_open)
{
    assert_int_equal(ending(0.3, 0.06, 0.0, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.3, 0.06, 0.015, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.6, 0.1, 0.09, 0.0), DIG_ENDING_OPEN);
    assert_int_equal(ending(0.45, 0.09, 0.05, 0.0), DIG_ENDING_OPEN); // cut the corner
}

// Dug from one progress to another; before that, in the air, from above.
static struct dig_path dug(const double from, const double to)
{
    struct dig_path path = { .spacing_m = 0.002 };
    for (double above_m = 0.04; above_m > 0.001; above_m -= 0.002) {
        const struct dig_path_point at = { 0.5 + fmin(0.2 * from, 0.1),
                                           -0.3 + fmax(0.2 * from - 0.1, 0.0) + above_m, 0.02 };
        (void)dig_path_add(&path, &at, false);
    }
    for (double p = from; p <= to; p += 0.01) {
        const struct dig_path_point at = { 0.5 + fmin(0.2 * p, 0.1),
                                           -0.3 + fmax(0.2 * p - 0.1, 0.0), 0.02 };
        if (p <= from) {
            dig_path_add_contact(&path, &at);
        }
        (void)dig_path_add(&path, &at, true);
    }
    return path;
}

static bool known(const double from, const double to, const double off_m)
{
    const struct dig_route route = legs();
    const struct dig_track track = { .dx_m = 0.5, .dz_m = -0.3 - off_m, .turn_m = 0.02 };
    const struct dig_path  path  = dug(from, to);
    return dig_ending_is_known(&route, &track, &path, limit_m);
}

// By hand: the corner is at 0.5, and 8 mm are 0.04 of the path.
TEST(only_a_piece_round_a_corner_is_known_to_be_where_it_is)
{
    assert_true(known(0.0, 0.3, 0.0));
    assert_true(known(0.2, 0.4, 0.0)); // contact tells where on the first leg it is
    assert_true(known(0.44, 0.56, 0.0));
    assert_false(known(0.48, 0.56, 0.0));
    assert_false(known(0.44, 0.52, 0.0));
    assert_false(known(0.6, 0.8, 0.0));
    assert_false(known(0.0, 0.3, 0.005)); // beside it
}
