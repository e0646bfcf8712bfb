// Tests for estimator/track/path.c, route.c and track.c

#include "estimator/track/track.h"

#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

static const double tooth_m = 0.09;
static const double limit_m = 0.008;

// How a dig is driven: where it starts, how late contact is noticed, what spoils it.
struct drive {
    double   dx_m, dz_m; // of the ground, unknown to the code
    double   late;       // progress at which contact is noticed
    double   until;      // progress at which the dig stops
    double   noise_m;    // of every pose
    uint64_t seed;
};

static struct dig_path_point point_at(const struct dig_trajectory *const t, const double progress,
                                      struct drive *const drive)
{
    const struct dig_pose pose =
        dig_trajectory_pose(t, dig_trajectory_time_s(t, tooth_m, progress));
    return (struct dig_path_point){
        .x_m    = pose.x_m + drive->dx_m + drive->noise_m * model_normal(&drive->seed),
        .z_m    = pose.z_m + drive->dz_m + drive->noise_m * model_normal(&drive->seed),
        .turn_m = tooth_m * pose.theta_rad + drive->noise_m * model_normal(&drive->seed),
    };
}

static struct dig_path drive_along(const enum made_trajectory which, struct drive drive)
{
    const struct dig_trajectory t    = made_trajectory(which);
    struct dig_path             path = { .spacing_m = 0.00225 };

    // From above, along another line and turning, then into the soil.
    struct dig_path_point p = point_at(&t, 0.0, &drive);
    for (int i = 40; i > 0; i--) {
        const struct dig_path_point air = { p.x_m + 0.001 * i, p.z_m + 0.002 * i,
                                            p.turn_m - 0.0005 * i };
        (void)dig_path_add(&path, &air, false);
    }
    bool touched = false;
    for (double progress = 0.0; progress <= drive.until; progress += 5e-4) {
        p = point_at(&t, progress, &drive);
        if (!touched && progress >= drive.late) {
            touched = true;
            dig_path_add_contact(&path, &p);
        }
        (void)dig_path_add(&path, &p, touched);
    }
    return path;
}

static int choose(const struct dig_path *const path, struct dig_track fitted[MADE_TRAJECTORIES])
{
    const struct dig_track *track_of[MADE_TRAJECTORIES];
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        const struct dig_trajectory trajectory = made_trajectory((enum made_trajectory)t);
        const struct dig_route      route      = dig_route_make(&trajectory, tooth_m);
        fitted[t]                              = dig_track_fit(&route, path, limit_m);
        track_of[t]                            = &fitted[t];
    }
    return dig_track_choose(MADE_TRAJECTORIES, track_of, limit_m, -1);
}

// Wherever the ground lies, however late contact was noticed (up to the whole first leg), with ten
// times the noise of a bus: the confusion matrix is diagonal and the shift is found.
TEST(every_trajectory_is_told_from_the_others)
{
    int      confusion[MADE_TRAJECTORIES][MADE_TRAJECTORIES + 1] = { { 0 } };
    uint64_t seed                                                = 17;
    for (int trial = 0; trial < 90; trial++) {
        const enum made_trajectory which       = (enum made_trajectory)(trial % MADE_TRAJECTORIES);
        const double               first_leg[] = { 0.19, 0.36, 0.13 };
        const struct drive         drive       = {
                          .dx_m    = 0.4 * (model_uniform(&seed) - 0.5),
                          .dz_m    = 0.4 * (model_uniform(&seed) - 0.5),
                          .late    = first_leg[which] * model_uniform(&seed),
                          .until   = 1.0,
                          .noise_m = 0.0003,
                          .seed    = seed,
        };
        const struct dig_path path = drive_along(which, drive);
        struct dig_track      fitted[MADE_TRAJECTORIES];
        const int             chosen = choose(&path, fitted);
        confusion[which][chosen + 1]++;

        // Two legs that are not parallel fix the shift; simpleB turns about its last pin.
        if (chosen == (int)which) {
            assert_close(fitted[which].dx_m, drive.dx_m, 0.0006);
            assert_close(fitted[which].dz_m, drive.dz_m, 0.0006);
            assert_close(fitted[which].rms_m, 0.0003 * sqrt(2.0), 0.0003);
        }
    }
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        print_message("%d: unknown %d, simpleA %d, simpleB %d, actual %d\n", t, confusion[t][0],
                      confusion[t][1], confusion[t][2], confusion[t][3]);
        assert_int_equal(confusion[t][t + 1], 30);
    }
}

// In weak gravel contact is felt only in the drag. The first leg lies before it, among vertices
// that may all have been air, and has to be found there.
TEST(contact_felt_after_the_first_leg_still_finds_it)
{
    const struct drive drive = {
        .dx_m = -0.2, .dz_m = 0.1, .late = 0.28, .until = 0.75, .noise_m = 0.0001, .seed = 12
    };
    const struct dig_path path = drive_along(MADE_SIMPLE_A, drive);
    struct dig_track      fitted[MADE_TRAJECTORIES];
    assert_int_equal(choose(&path, fitted), MADE_SIMPLE_A);
    assert_close(fitted[MADE_SIMPLE_A].dx_m, drive.dx_m, 0.001);
    assert_close(fitted[MADE_SIMPLE_A].dz_m, drive.dz_m, 0.001);
}

// simpleB and actual begin alike: until they part, the honest answer is that it is not known.
TEST(what_two_trajectories_share_is_not_known)
{
    struct dig_track      fitted[MADE_TRAJECTORIES];
    const struct drive    shared = { .until = 0.12, .noise_m = 0.0001, .seed = 3 };
    const struct dig_path path   = drive_along(MADE_ACTUAL, shared);
    assert_int_equal(choose(&path, fitted), -1);

    // Who sits already keeps his seat while it is tied.
    const struct dig_track *track_of[] = { &fitted[0], &fitted[1], &fitted[2] };
    assert_int_equal(dig_track_choose(3, track_of, limit_m, MADE_ACTUAL), MADE_ACTUAL);
    assert_int_equal(dig_track_choose(3, track_of, limit_m, MADE_SIMPLE_B), MADE_SIMPLE_B);
    assert_int_equal(dig_track_choose(3, track_of, limit_m, MADE_SIMPLE_A), -1);
}

TEST(a_path_that_is_none_of_them_is_not_known)
{
    struct dig_path path = { .spacing_m = 0.00225 };
    for (int i = 0; i < 60; i++) { // a level drag with the bucket curled in
        const struct dig_path_point p = { 0.002 * i, 0.1, tooth_m * 0.9 };
        (void)dig_path_add(&path, &p, true);
    }
    struct dig_track fitted[MADE_TRAJECTORIES];
    assert_int_equal(choose(&path, fitted), -1);
}

TEST(a_follower_finds_its_way_while_the_dig_goes_on)
{
    const struct dig_trajectory t     = made_trajectory(MADE_SIMPLE_A);
    const struct dig_route      route = dig_route_make(&t, tooth_m);
    struct drive    drive = { .dx_m = 0.1, .dz_m = -0.05, .noise_m = 0.0001, .seed = 2 };
    struct dig_path path  = { .spacing_m = 0.00225 };

    // Contact is noticed nearly at the end of the first leg: the first guess is 27 mm off.
    struct dig_path_point p = point_at(&t, 0.17, &drive);
    dig_path_add_contact(&path, &p);
    struct dig_follower follower = dig_follower_start(&route, &path, limit_m);
    for (double progress = 0.17; progress < 1.0; progress += 2e-3) {
        p = point_at(&t, progress, &drive);
        (void)dig_path_add(&path, &p, true);
        for (int tick = 0; tick < 4; tick++) {
            dig_follower_step(&route, &path, limit_m, &follower);
        }
        if (progress > 0.4) {
            assert_true(follower.track.rms_m < 0.001);
            assert_close(follower.track.dz_m, drive.dz_m, 0.001);
        }
    }
    assert_close(follower.track.dx_m, drive.dx_m, 0.001);
    assert_close(follower.track.progress, 1.0, 0.02);
}

// Brute force over a fine sampling of the polyline.
TEST(the_nearest_place_is_the_nearest)
{
    const struct dig_trajectory t     = made_trajectory(MADE_ACTUAL);
    const struct dig_route      route = dig_route_make(&t, tooth_m);
    uint64_t                    seed  = 6;
    for (int trial = 0; trial < 200; trial++) {
        struct drive                drive = { .noise_m = 0.004, .seed = seed };
        const struct dig_path_point p = point_at(&t, 0.05 + 0.95 * model_uniform(&seed), &drive);
        const struct dig_projection place  = dig_route_project(&route, 0.0, 0.0, &p, 0.0, 1.0);
        double                      best_m = INFINITY;
        for (int k = 0; k <= 20000; k++) {
            const struct dig_pose pose =
                dig_trajectory_pose(&t, dig_trajectory_time_s(&t, tooth_m, k / 20000.0));
            const double flat_m = hypot(p.x_m - pose.x_m, p.z_m - pose.z_m);
            best_m              = fmin(best_m, hypot(flat_m, p.turn_m - tooth_m * pose.theta_rad));
        }
        if (place.progress > 0.0) { // before the start the first leg goes on
            assert_close(place.distance_m, best_m, 1e-5);
        }
    }
}

// Coming down along the first leg's own line is no distance from the route, and no progress.
TEST(the_way_to_the_start_is_on_the_route)
{
    const struct dig_trajectory t     = made_trajectory(MADE_SIMPLE_A);
    const struct dig_route      route = dig_route_make(&t, tooth_m);
    for (int i = 0; i < 50; i++) {
        const struct dig_path_point p     = { t.start_x_m - 0.001 * i * 0.5 - 0.3,
                                              t.start_z_m + 0.001 * i * 0.8660254 + 0.2,
                                              tooth_m * t.theta0_rad };
        const struct dig_projection place = dig_route_project(&route, -0.3, 0.2, &p, -0.1, 1.0);
        assert_close(place.progress, 0.0, 0.0);
        assert_close(place.distance_m, 0.0, 1e-5);
    }
}

TEST(a_full_path_is_thinned_and_keeps_its_contact)
{
    struct dig_path path = { .spacing_m = 0.001 };
    for (int i = 0; i < 3 * DIG_PATH_MAX; i++) {
        const struct dig_path_point p = { 0.0011 * i, 0.0, 0.0 };
        if (dig_path_add(&path, &p, true) && i == 100) {
            path.contact = path.vertices - 1;
        }
    }
    assert_true(path.vertices <= DIG_PATH_MAX && path.vertices > DIG_PATH_MAX / 4);
    assert_close(path.vertex[path.contact].x_m, 0.11, 0.004);
    const struct dig_path_point same = path.vertex[path.vertices - 1];
    assert_false(dig_path_add(&path, &same, true));
    assert_int_equal(path.end, path.vertices);
}

TEST(a_choice_is_told_once_it_has_held)
{
    struct dig_choice choice = { .current = -1, .candidate = -1 };
    for (int i = 0; i < 1000; i++) { // flickering between two is no choice
        assert_int_equal(dig_choice_step(&choice, 3, i / 40 % 2 == 0 ? 1 : 2), -1);
    }
    int ticks = 0;
    while (dig_choice_step(&choice, 3, 2) != 2) {
        ticks++;
    }
    assert_true(ticks < 100);
    assert_int_equal(dig_choice_step(&choice, 3, 0), 2);
}
