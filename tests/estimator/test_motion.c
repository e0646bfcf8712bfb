// Tests for estimator/track/motion.c

#include "estimator/track/motion.h"

#include "core/units.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

static const double tooth_m = 0.09;
static const double step_m  = 0.0002; // of the way, a tick

// A bucket moved by hand.
struct hand {
    struct dig_motion_state state;
    struct dig_pose         pose;
    double                  noise_m;
    uint64_t                seed;
    enum dig_motion         told;
};

static struct hand start(const double theta_rad)
{
    return (struct hand){ .pose = { 1.0, 2.0, theta_rad }, .seed = 5 };
}

static void tick(struct hand *const h, const enum dig_dig_phase phase)
{
    const struct dig_path_point point = {
        h->pose.x_m + h->noise_m * model_normal(&h->seed),
        h->pose.z_m + h->noise_m * model_normal(&h->seed),
        tooth_m * h->pose.theta_rad + h->noise_m * model_normal(&h->seed),
    };
    h->told = dig_motion_step(&h->state, tooth_m, 0.005, phase, &point);
}

// Moves the pin by so much, and turns.
static void go(struct hand *const h, const double x_m, const double z_m, const double turn_rad)
{
    const int ticks = 1 + (int)((hypot(x_m, z_m) + tooth_m * fabs(turn_rad)) / step_m);
    for (int i = 0; i < ticks; i++) {
        h->pose.x_m += x_m / ticks;
        h->pose.z_m += z_m / ticks;
        h->pose.theta_rad += turn_rad / ticks;
        tick(h, DIG_PHASE_DIG);
    }
}

static void stand(struct hand *const h, const int ticks)
{
    for (int i = 0; i < ticks; i++) {
        tick(h, DIG_PHASE_DIG);
    }
}

// Each leg of the rig's trajectories by its name, and by its end.
TEST(legs_are_told_by_how_the_tooth_moves)
{
    const enum dig_motion legs[MADE_TRAJECTORIES][5] = {
        { DIG_MOTION_PENETRATION, DIG_MOTION_DRAG, DIG_MOTION_LIFT },
        { DIG_MOTION_PENETRATION, DIG_MOTION_CURL },
        { DIG_MOTION_PENETRATION, DIG_MOTION_CURL, DIG_MOTION_DRAG, DIG_MOTION_CURL,
          DIG_MOTION_LIFT },
    };
    for (int which = 0; which < MADE_TRAJECTORIES; which++) {
        const struct dig_trajectory t = made_trajectory((enum made_trajectory)which);
        struct hand                 h = start(t.theta0_rad);
        for (size_t leg = 0; leg < t.phases; leg++) {
            const struct dig_phase *const p = &t.phase[leg];
            go(&h, p->vx_mps * p->duration_s, p->vz_mps * p->duration_s,
               p->omega_radps * p->duration_s);
            assert_int_equal(h.told, legs[which][leg]);
        }
    }
}

// A pin that goes along while the bucket turns by three quarters of that: with its tooth ahead it
// lifts, with its tooth below it drags.
TEST(it_is_the_tooth_that_counts)
{
    struct hand ahead = start(80.0 * DIG_RAD_PER_DEG);
    go(&ahead, 0.02, 0.0, 0.015 / tooth_m);
    assert_int_equal(ahead.told, DIG_MOTION_LIFT);
    struct hand below = start(-5.0 * DIG_RAD_PER_DEG);
    go(&below, 0.02, 0.0, 0.015 / tooth_m);
    assert_int_equal(below.told, DIG_MOTION_DRAG);
}

TEST(a_pause_keeps_what_it_was)
{
    struct hand h = start(0.0);
    h.noise_m     = 0.0005; // 5 mm on a machine ten times the rig
    go(&h, 0.02, 0.0, 0.0);
    assert_int_equal(h.told, DIG_MOTION_DRAG);
    for (int i = 0; i < 100; i++) {
        stand(&h, 1000);
        assert_int_equal(h.told, DIG_MOTION_DRAG);
    }
    go(&h, 0.0, 0.02, 0.0);
    assert_int_equal(h.told, DIG_MOTION_LIFT);
    stand(&h, 1000);
    assert_int_equal(h.told, DIG_MOTION_LIFT);
}

TEST(a_step_back_or_an_opened_bucket_keeps_what_it_was)
{
    struct hand h = start(0.0);
    go(&h, 0.02, 0.0, 0.0);
    go(&h, -0.02, 0.0, 0.0);
    assert_int_equal(h.told, DIG_MOTION_DRAG);
    go(&h, 0.0, 0.0, -0.3);
    assert_int_equal(h.told, DIG_MOTION_DRAG);
    go(&h, 0.0, 0.0, 0.3);
    assert_int_equal(h.told, DIG_MOTION_CURL);
    go(&h, 0.0, 0.0, -0.3);
    assert_int_equal(h.told, DIG_MOTION_CURL);
    go(&h, 0.0, -0.02, 0.0);
    go(&h, -0.02, 0.0, 0.0);
    assert_int_equal(h.told, DIG_MOTION_PENETRATION);
}

// A way along the border does not go to and fro: it is told what it was before.
TEST(at_a_border_it_stays_what_it_was)
{
    const double slope[] = { 28.0, 32.0 };
    for (int i = 0; i < 2; i++) {
        const double rad     = slope[i] * DIG_RAD_PER_DEG;
        struct hand  dragged = start(0.0);
        struct hand  sunk    = start(0.0);
        go(&dragged, 0.03, 0.0, 0.0);
        go(&sunk, 0.0, -0.03, 0.0);
        go(&dragged, 0.1 * cos(rad), -0.1 * sin(rad), 0.0);
        go(&sunk, 0.1 * cos(rad), -0.1 * sin(rad), 0.0);
        assert_int_equal(dragged.told, DIG_MOTION_DRAG);
        assert_int_equal(sunk.told, DIG_MOTION_PENETRATION);
    }
    const double share[] = { 0.9, 1.1 };
    for (int i = 0; i < 2; i++) {
        struct hand dragged = start(0.0);
        struct hand curled  = start(0.0);
        go(&dragged, 0.03, 0.0, 0.0);
        go(&curled, 0.0, 0.0, 0.3);
        go(&dragged, 0.03, 0.0, share[i] * 0.03 / tooth_m);
        go(&curled, 0.03, 0.0, share[i] * 0.03 / tooth_m);
        assert_int_equal(dragged.told, DIG_MOTION_DRAG);
        assert_int_equal(curled.told, DIG_MOTION_CURL);
    }
}

// Nothing is told in the air, and nothing of the dig before; what is done meanwhile counts at once.
TEST(only_what_is_in_the_soil_is_told)
{
    struct hand h = start(0.0);
    tick(&h, DIG_PHASE_DIG);
    assert_int_equal(h.told, DIG_MOTION_NONE); // it has not moved yet
    go(&h, 0.03, 0.0, 0.0);
    tick(&h, DIG_PHASE_EXIT);
    assert_int_equal(h.told, DIG_MOTION_NONE);
    tick(&h, DIG_PHASE_DIG); // a hesitation
    assert_int_equal(h.told, DIG_MOTION_DRAG);
    for (int i = 0; i < 1000; i++) { // until no bit moves any more
        tick(&h, DIG_PHASE_AIR);
        assert_int_equal(h.told, DIG_MOTION_NONE);
    }
    tick(&h, DIG_PHASE_CONTACT);
    assert_int_equal(h.told, DIG_MOTION_NONE); // stands where the last one ended

    for (int i = 0; i < 100; i++) {
        h.pose.z_m -= step_m;
        tick(&h, DIG_PHASE_AIR);
        assert_int_equal(h.told, DIG_MOTION_NONE);
    }
    h.pose.z_m -= step_m;
    tick(&h, DIG_PHASE_CONTACT);
    assert_int_equal(h.told, DIG_MOTION_PENETRATION);
}

// tan(a/2) falls by e a rope's length behind a corner; the rope is a thirtieth of the tooth.
TEST(a_corner_is_noticed_within_a_rope_or_so)
{
    struct hand h = start(0.0);
    go(&h, 0.03, 0.0, 0.0);
    double way_m = 0.0;
    while (h.told == DIG_MOTION_DRAG) {
        go(&h, 0.0, 1e-5, 0.0);
        way_m += 1e-5;
        assert_true(way_m < 0.01);
    }
    assert_int_equal(h.told, DIG_MOTION_LIFT);
    // Until it lies 35 degrees up, 55 off its new way.
    const double rope_m   = tooth_m / 30.0;
    const double expected = -rope_m * log(tan(0.5 * 55.0 * DIG_RAD_PER_DEG));
    assert_close(way_m, expected, 0.1 * expected);
}
