// Tests for estimator/track/followed.c: two routes that part half way, by hand. Digs given up with
// a load, driven through the estimator: test_recognition.c.

#include "estimator/track/followed.h"

#include "tests/testlib.h"

static const double limit_m = 0.008;

// 100 mm along, then 100 mm up or down.
static struct dig_route legs(const double then_m)
{
    return (struct dig_route){
        .corners = 3,
        .corner  = { { 0.0, 0.0, 0.0 }, { 0.1, 0.0, 0.0 }, { 0.1, then_m, 0.0 } },
        .at_m    = { 0.0, 0.1, 0.2 },
    };
}

struct followed_dig {
    struct dig_followed followed;
    struct dig_path     path;
    int64_t             time_ns;
};

static void go(struct followed_dig *const dig, const double x_m, const double z_m,
               const double progress, const double off_path_m)
{
    const struct dig_path_point at = { x_m, z_m, 0.0 };
    if (dig->path.vertices == 0) {
        dig->path.spacing_m = 0.002;
        dig_path_add_contact(&dig->path, &at);
    }
    (void)dig_path_add(&dig->path, &at, true);
    dig->time_ns += 5000000;
    dig_followed_sample(&dig->followed, true, dig->time_ns, 0.1);
    dig_followed_on(&dig->followed, 0, progress, off_path_m, limit_m, &dig->path);
}

// Along the way up until a progress, then off the path with a load by away_m, which the path
// holds, too.
static struct followed_dig give_up(const double until, const double away_m)
{
    static struct followed_dig dig;
    dig = (struct followed_dig){ .time_ns = 0 };
    for (double p = 0.0; p <= until; p += 0.005) {
        go(&dig, fmin(0.2 * p, 0.1), fmax(0.2 * p - 0.1, 0.0), p, 0.0);
    }
    const struct dig_path_point last = dig.path.vertex[dig.path.vertices - 1];
    for (double off = 0.0; off <= away_m; off += 0.001) {
        go(&dig, last.x_m - off, last.z_m + off, until, off);
    }
    return dig;
}

static bool gave_up(const struct followed_dig *const dig)
{
    const struct dig_route routes[] = { legs(0.1), legs(-0.1) };
    return dig_followed_was_aborted(&dig->followed, 2, routes, &dig->path, limit_m);
}

TEST(what_left_the_path_it_was_on_gave_up)
{
    const struct followed_dig dig = give_up(0.8, 0.06);
    assert_true(gave_up(&dig));
    assert_int_equal(dig.followed.trajectory, 0);
    assert_close(dig.followed.progress, 0.8, 1e-9);
}

// What is told of nothing any more has left, too.
TEST(what_is_told_along_none_any_more_gave_up)
{
    struct followed_dig dig = give_up(0.8, 0.007);
    assert_false(gave_up(&dig)); // 7 mm off is still on it
    dig_followed_off(&dig.followed);
    assert_true(gave_up(&dig));
}

TEST(the_place_told_is_the_last_one_near_the_path)
{
    struct followed_dig dig = give_up(0.8, 0.0);
    go(&dig, 0.096, 0.064, 0.82, 0.0039);
    go(&dig, 0.095, 0.066, 0.83, 0.0041);
    go(&dig, 0.080, 0.080, 0.97, 0.0200);
    assert_close(dig.followed.progress, 0.82, 0.0);
    assert_true(dig.followed.left);
}

TEST(what_can_be_two_dug_to_the_end_or_hardly_begun_did_not)
{
    const struct followed_dig two   = give_up(0.45, 0.06); // the leg that both begin with
    const struct followed_dig whole = give_up(0.96, 0.06);
    struct followed_dig       begun = give_up(0.8, 0.06);
    const struct followed_dig none  = { .followed = { .left = true, .progress = 0.5 } };
    assert_false(gave_up(&two));
    assert_false(gave_up(&whole));
    begun.followed.progress = 0.19;
    assert_false(gave_up(&begun));
    assert_false(gave_up(&none));
}

// Told to be the other one, whatever its path is.
TEST(what_was_told_wrongly_did_not)
{
    struct followed_dig dig = give_up(0.8, 0.06);
    dig.followed.trajectory = 1;
    assert_false(gave_up(&dig));
}

TEST(where_it_was_while_samples_were_missing_no_one_knows)
{
    struct followed_dig dig = give_up(0.8, 0.06);
    dig_followed_sample(&dig.followed, true, dig.time_ns + 90000000, 0.1);
    assert_true(gave_up(&dig));
    dig_followed_sample(&dig.followed, true, dig.time_ns + 200000000, 0.1);
    assert_false(gave_up(&dig));

    // In the air before the dig it does not matter.
    struct followed_dig air = give_up(0.8, 0.06);
    dig_followed_sample(&air.followed, false, air.time_ns + 900000000, 0.1);
    assert_true(gave_up(&air));
}
