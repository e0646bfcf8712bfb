// Tests for estimator/track/abort_detection.c: a route down, along and up, by hand, and paths that
// leave it. Digs driven through the estimator: test_recognition.c.

#include "estimator/track/abort_detection.h"

#include "tests/testlib.h"

static const double limit_m = 0.008;
static const double step_m  = 0.0005;

// 30 mm down, 90 mm along, 40 mm up, or the last 40 mm down.
static struct dig_route route_then(const double last_m)
{
    return (struct dig_route){
        .corners = 4,
        .corner  = { { 0.0, 0.0, 0.0 },
                     { 0.0, -0.03, 0.0 },
                     { 0.09, -0.03, 0.0 },
                     { 0.09, -0.03 + last_m, 0.0 } },
        .at_m    = { 0.0, 0.03, 0.12, 0.16 },
    };
}

// The bucket, and the way it went.
struct dug {
    struct dig_path_point at;
    struct dig_path       path;
};

static void go(struct dug *const dug, const double dx_m, const double dz_m)
{
    const struct dig_path_point from  = dug->at;
    const double                way_m = hypot(dx_m, dz_m);
    for (double s = step_m; s < way_m + 0.5 * step_m; s += step_m) {
        dug->at = (struct dig_path_point){ from.x_m + s / way_m * dx_m, from.z_m + s / way_m * dz_m,
                                           from.turn_m };
        (void)dig_path_add(&dug->path, &dug->at, true);
    }
}

// Felt after 10 of the 30 mm, somewhere else than the table's; then along.
static struct dug dig(const double along_m)
{
    struct dug dug = { .at = { 0.4, -0.2, 0.0 }, .path = { .spacing_m = 0.00225 } };
    (void)dig_path_add(&dug.path, &dug.at, false);
    dug.at.z_m -= 0.01;
    dig_path_add_contact(&dug.path, &dug.at);
    go(&dug, 0.0, -0.02);
    go(&dug, along_m, 0.0);
    return dug;
}

// Along which of two routes, or only of the one that goes up, it was when it left; -1: none.
static int left_of(const struct dug *const dug, const size_t routes,
                   struct dig_abort_detection *const departure)
{
    const struct dig_route route[] = { route_then(0.04), route_then(-0.04) };
    struct dig_track       whole[2];
    for (size_t r = 0; r < routes; r++) {
        whole[r] = dig_track_fit(&route[r], &dug->path, limit_m);
    }
    return dig_abort_detection_choose(routes, route, &dug->path, limit_m, whole, departure);
}

static bool left(const struct dug *const dug)
{
    struct dig_abort_detection departure;
    return left_of(dug, 1, &departure) == 0;
}

// At 40, 60 and 75 of 90 mm along: 15 mm from the last leg are still beside it.
TEST(a_load_lifted_short_of_the_last_leg_has_left)
{
    static const double along_m[] = { 0.04, 0.06, 0.075 };
    for (size_t i = 0; i < sizeof along_m / sizeof along_m[0]; i++) {
        struct dug                 dug = dig(along_m[i]);
        struct dig_abort_detection departure;
        go(&dug, 0.0, 0.05);
        assert_int_equal(left_of(&dug, 1, &departure), 0);
        assert_close(departure.progress, (0.03 + along_m[i]) / 0.16, 0.015);
        assert_close(departure.track.dx_m, 0.4, 0.0005);
        assert_close(departure.track.dz_m, -0.2, 0.0005);
        assert_true(departure.until > dug.path.contact && departure.until < dug.path.end);
    }
}

TEST(what_is_dug_to_its_end_or_not_on_has_not)
{
    struct dug whole = dig(0.09);
    go(&whole, 0.0, 0.04);
    assert_false(left(&whole));
    struct dug near = dig(0.085);
    go(&near, 0.0, 0.04);
    assert_false(left(&near)); // 5 mm short is within the limit
    const struct dug stopped = dig(0.06);
    assert_false(left(&stopped));
}

// Lifted over a stone by 12 mm, and down again.
TEST(who_swerves_and_comes_back_has_not)
{
    struct dug dug = dig(0.04);
    go(&dug, 0.01, 0.012);
    go(&dug, 0.01, -0.012);
    go(&dug, 0.03, 0.0);
    go(&dug, 0.0, 0.04);
    assert_false(left(&dug));
}

// 20 mm farther than the table's.
TEST(who_goes_on_beyond_a_corner_has_not)
{
    struct dug dug = dig(0.11);
    go(&dug, 0.0, 0.04);
    assert_false(left(&dug));
}

// Of a long first leg: how much of it was dug only contact tells.
TEST(on_the_first_leg_no_one_knows)
{
    const struct dig_route route = {
        .corners = 3,
        .corner  = { { 0.0, 0.0, 0.0 }, { 0.0, -0.06, 0.0 }, { 0.06, -0.06, 0.0 } },
        .at_m    = { 0.0, 0.06, 0.12 },
    };
    static const double down_m[] = { 0.045, 0.06 };
    for (int i = 0; i < 2; i++) {
        struct dug dug = { .path = { .spacing_m = 0.00225 } };
        dig_path_add_contact(&dug.path, &dug.at);
        go(&dug, 0.0, -down_m[i]);
        go(&dug, i == 0 ? 0.0 : 0.03, 0.0);
        go(&dug, -0.03, 0.03);
        const struct dig_track     whole = dig_track_fit(&route, &dug.path, limit_m);
        struct dig_abort_detection departure;
        assert_true(dig_abort_detection_find(&route, &dug.path, limit_m, &whole, &departure) ==
                    (i == 1));
    }
}

// Along, by steps of 3 mm from side to side.
static void sway(struct dug *const dug, const double along_m, const double side_m)
{
    const double z_m = dug->at.z_m;
    for (int i = 0; i < (int)(along_m / 0.003); i++) {
        go(dug, 0.003, z_m + (i % 2 == 0 ? side_m : -side_m) - dug->at.z_m);
    }
    go(dug, 0.001, z_m - dug->at.z_m);
}

// An unsteady hand is off its path by as much at any time; one that is far off it is on none.
TEST(what_fits_hardly_better_before_has_not)
{
    static const struct {
        double side_m, back_m, up_m;
        bool   left;
    } of[] = {
        { 0.0, 0.001, 0.0105, true },
        { 0.004, 0.001, 0.0105, false },
        { 0.004, 0.001, 0.03, true },
        { 0.006, 0.05, 0.05, false },
    };
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        struct dug dug = dig(0.001);
        sway(&dug, 0.06, of[i].side_m);
        go(&dug, -of[i].back_m, of[i].up_m);
        assert_int_equal(left(&dug), of[i].left);
    }
}

// Both routes go down and along; only one goes down in the end.
TEST(what_can_be_two_is_left_open)
{
    struct dig_abort_detection departure = { .progress = -1.0 };
    struct dug                 early     = dig(0.06);
    go(&early, 0.0, 0.05);
    assert_int_equal(left_of(&early, 2, &departure), -1);
    assert_close(departure.progress, -1.0, 0.0);

    struct dug late = dig(0.09);
    go(&late, 0.0, -0.02);
    go(&late, -0.03, 0.0);
    assert_int_equal(left_of(&late, 2, &departure), 1);
    assert_close(departure.progress, 0.14 / 0.16, 0.015);
}
