// Tests for tools/rig/motion/mechanism.c

#include "tools/rig/motion/mechanism.h"

#include "core/units.h"
#include "tests/read.h"

#include <complex.h>

#define J CMPLX(0.0, 1.0) // I of <complex.h> is a float

static const char *const shipped[] = {
    "zx200", "zx200_trench", "zx120", "mini_2t8", "mini_1t8", "crawler_14t", "crawler_36t",
};
#define SHIPPED (sizeof shipped / sizeof shipped[0])

// Boom 4 m and arm 3 m at right angles reach 5 m: the pin at (5, 0), everything known by hand.
static struct dig_machine right_angle(void)
{
    return (struct dig_machine){
        .link = { { .length_m = 4.0 }, { .length_m = 3.0 }, { .length_m = 1.0 } },
        .cylinder = {
            [DIG_JOINT_ARM] = { .base_m = { 1.0, 1.0 }, .eye_m = { -0.5, 0.0 } },
        },
    };
}

TEST(golden_pose_has_the_angles_worked_by_hand)
{
    const struct dig_machine machine = right_angle();
    // theta = -20 deg in the rig is phi = -90 + 20 = -70 deg here.
    const struct dig_rig_pose pose = { .X_m = 5.0, .phi_rad = -70.0 * DIG_RAD_PER_DEG };
    struct dig_rig_joints     joints;
    assert_int_equal(dig_rig_inverse(&machine, &pose, &joints), DIG_OK);

    // The 3-4-5 triangle: the boom rises by atan(3 / 4), the arm hangs square to it.
    const double boom_rad = 36.86989764584402 * DIG_RAD_PER_DEG;
    assert_close(joints.rad[DIG_JOINT_BOOM], boom_rad, 1e-12);
    assert_close(joints.rad[DIG_JOINT_ARM], -90.0 * DIG_RAD_PER_DEG, 1e-12);
    assert_close(joints.rad[DIG_JOINT_BUCKET], -16.86989764584402 * DIG_RAD_PER_DEG, 1e-12);
}

// The arm cylinder of the same pose: the eye stands at (4, 0.5) of the boom frame, 3 along and half
// a metre below the base; half a metre of tail moves it backwards as the arm opens.
TEST(golden_cylinder_has_the_length_and_lever_worked_by_hand)
{
    const struct dig_machine machine = right_angle();
    double                   length_m;
    double                   lever_m;
    assert_int_equal(dig_rig_cylinder_m(&machine, DIG_JOINT_ARM, -0.5 * DIG_PI, &length_m), DIG_OK);
    assert_int_equal(dig_rig_lever_m(&machine, DIG_JOINT_ARM, -0.5 * DIG_PI, &lever_m), DIG_OK);
    assert_close(length_m, 3.0413812651491097, 1e-12);
    assert_close(lever_m, -0.5 * 3.0 / 3.0413812651491097, 1e-9);
}

// The chain as complex numbers, which shares nothing with the code under test.
static double complex turn(const double rad)
{
    return cexp(J * rad);
}

TEST(inverse_undoes_an_independent_forward_chain)
{
    const struct dig_machine machine = read_machine(shipped[0]);
    for (int b = -4; b <= 6; b += 2) {
        for (int a = -14; a <= -4; a += 2) {
            for (int k = -12; k <= 3; k += 3) {
                const double         q[3] = { 0.17 * b, 0.17 * a, 0.17 * k };
                const double complex pin  = machine.link[0].length_m * turn(q[0]) +
                                           machine.link[1].length_m * turn(q[0] + q[1]);
                const struct dig_rig_pose pose = { creal(pin), cimag(pin), q[0] + q[1] + q[2] };
                struct dig_rig_joints     joints;
                assert_int_equal(dig_rig_inverse(&machine, &pose, &joints), DIG_OK);
                for (int j = 0; j < DIG_JOINTS; j++) {
                    assert_close(joints.rad[j], q[j], 1e-10);
                }
                const struct dig_rig_pose back = dig_rig_front_at(&machine, &joints).bucket;
                assert_close(back.X_m, pose.X_m, 1e-12);
                assert_close(back.Z_m, pose.Z_m, 1e-12);
                assert_close(back.phi_rad, pose.phi_rad, 1e-12);

                const double complex com =
                    pin +
                    (machine.link[2].com_m.x + J * machine.link[2].com_m.y) * turn(pose.phi_rad);
                const struct dig_vec2 found =
                    dig_rig_front_at(&machine, &joints).com_m[DIG_JOINT_BUCKET];
                assert_close(found.x, creal(com), 1e-12);
                assert_close(found.y, cimag(com), 1e-12);
            }
        }
    }
}

TEST(every_shipped_machine_closes_over_its_whole_range_within_its_strokes)
{
    for (size_t m = 0; m < SHIPPED; m++) {
        const struct dig_machine machine = read_machine(shipped[m]);
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_link *const     link     = &machine.link[j];
            const struct dig_cylinder *const cylinder = &machine.cylinder[j];
            for (int i = 0; i <= 200; i++) {
                const double q_rad =
                    link->min_rad + (link->max_rad - link->min_rad) * (double)i / 200.0;
                double length_m = 0.0;
                double lever_m  = 0.0;
                assert_int_equal(dig_rig_cylinder_m(&machine, (enum dig_joint)j, q_rad, &length_m),
                                 DIG_OK);
                assert_int_equal(dig_rig_lever_m(&machine, (enum dig_joint)j, q_rad, &lever_m),
                                 DIG_OK);
                assert_true(length_m > cylinder->min_length_m);
                assert_true(length_m < cylinder->max_length_m);
                // Extending raises the boom, crowds the arm and curls the bucket, everywhere.
                assert_true(j == DIG_JOINT_BOOM ? lever_m > 0.0 : lever_m < 0.0);
                assert_true(fabs(lever_m) > 0.05);
            }
            // A cylinder cannot be longer than twice what it is retracted, less its own ends.
            assert_true(cylinder->max_length_m < 1.75 * cylinder->min_length_m);
        }
    }
}

// Force at the tooth when only the bucket cylinder works, at its best angle: what a class has.
TEST(breakout_forces_are_those_of_their_class)
{
    const double least_kN[SHIPPED] = { 130.0, 130.0, 90.0, 18.0, 13.0, 85.0, 190.0 };
    const double most_kN[SHIPPED]  = { 160.0, 260.0, 115.0, 26.0, 19.0, 115.0, 250.0 };
    for (size_t m = 0; m < SHIPPED; m++) {
        const struct dig_machine         machine  = read_machine(shipped[m]);
        const struct dig_link *const     link     = &machine.link[DIG_JOINT_BUCKET];
        const struct dig_cylinder *const cylinder = &machine.cylinder[DIG_JOINT_BUCKET];
        double                           best_m   = 0.0;
        for (double q = link->min_rad; q <= link->max_rad; q += 0.01) {
            double lever_m = 0.0;
            assert_int_equal(dig_rig_lever_m(&machine, DIG_JOINT_BUCKET, q, &lever_m), DIG_OK);
            best_m = fmax(best_m, fabs(lever_m));
        }
        const double push_N =
            cylinder->relief_Pa * 0.25 * DIG_PI * cylinder->bore_m * cylinder->bore_m;
        const double at_tooth_kN = 1e-3 * push_N * best_m / link->length_m;
        assert_true(at_tooth_kN > least_kN[m] && at_tooth_kN < most_kN[m]);
    }
}

TEST(four_bar_keeps_its_bars_and_stays_on_the_cylinder_s_side)
{
    for (size_t m = 0; m < SHIPPED; m++) {
        const struct dig_machine machine = read_machine(shipped[m]);
        const struct dig_link   *link    = &machine.link[DIG_JOINT_BUCKET];
        for (double q = link->min_rad; q <= link->max_rad; q += 0.02) {
            // M found by brute force: the point of the rocker's circle that the link reaches, of
            // the two the one on the same side of N-K as the cylinder's base.
            const double complex N =
                machine.four_bar.rocker_pin_m.x + J * machine.four_bar.rocker_pin_m.y;
            const double complex K =
                machine.link[DIG_JOINT_ARM].length_m +
                (machine.four_bar.ear_m.x + J * machine.four_bar.ear_m.y) * turn(q);
            const double complex G = machine.cylinder[DIG_JOINT_BUCKET].base_m.x +
                                     J * machine.cylinder[DIG_JOINT_BUCKET].base_m.y;
            const double side = cimag(conj(K - N) * (G - N));
            double       low  = 0.0;
            double       high = DIG_PI;
            for (int i = 0; i < 60; i++) {
                const double         mid = 0.5 * (low + high);
                const double complex M   = N + machine.four_bar.rocker_m * (K - N) / cabs(K - N) *
                                                 turn(side > 0.0 ? mid : -mid);
                if (cabs(M - K) < machine.four_bar.link_m) {
                    low = mid;
                } else {
                    high = mid;
                }
            }
            const double complex M = N + machine.four_bar.rocker_m * (K - N) / cabs(K - N) *
                                             turn(side > 0.0 ? low : -low);
            double length_m = 0.0;
            assert_int_equal(dig_rig_cylinder_m(&machine, DIG_JOINT_BUCKET, q, &length_m), DIG_OK);
            assert_close(length_m, cabs(M - G), 1e-9);
        }
    }
}

TEST(poses_out_of_reach_are_refused_and_write_nothing)
{
    const struct dig_machine  machine = right_angle();
    const struct dig_rig_pose bad[]   = {
          { 7.1, 0.0, 0.0 }, // farther than boom and arm
          { 0.9, 0.0, 0.0 }, // nearer than their difference
          { 0.0, 0.0, 0.0 }, // in the boom foot
          { NAN, 0.0, 0.0 }, { 5.0, 0.0, NAN },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_rig_joints joints = { .rad = { 42.0, 42.0, 42.0 } };
        assert_int_equal(dig_rig_inverse(&machine, &bad[i], &joints), DIG_EUNREACHABLE);
        assert_close(joints.rad[0], 42.0, 0.0);
    }

    struct dig_machine open = read_machine(shipped[0]);
    open.four_bar.link_m    = 0.005;
    double length_m         = 42.0;
    double lever_m          = 42.0;
    assert_int_equal(dig_rig_cylinder_m(&open, DIG_JOINT_BUCKET, 0.0, &length_m), DIG_EUNREACHABLE);
    assert_int_equal(dig_rig_lever_m(&open, DIG_JOINT_BUCKET, 0.0, &lever_m), DIG_EUNREACHABLE);
    assert_close(length_m, 42.0, 0.0);
    assert_close(lever_m, 42.0, 0.0);
}
