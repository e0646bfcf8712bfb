// Tests for core/linkage.c

#include "core/linkage.h"

#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

static struct dig_lever solve(const struct dig_machine *const machine, const enum dig_joint joint,
                              const double at_rad)
{
    struct dig_lever lever;
    assert_int_equal(dig_lever_solve(machine, joint, at_rad, &lever), DIG_OK);
    return lever;
}

// Virtual work: what the rod does along its stroke, the joint does along its angle. The solver
// balances forces and never differentiates, so the two sides share no formula.
TEST(every_lever_is_the_slope_of_the_cylinders_length)
{
    const struct dig_machine machine = model_machine();
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_link *const link = &machine.link[j];
        for (int i = 1; i < 60; i++) {
            const double at_rad = link->min_rad + (link->max_rad - link->min_rad) * i / 60.0;
            const struct dig_lever lever = solve(&machine, (enum dig_joint)j, at_rad);
            assert_close(lever.arm_m, model_slope_m(&machine, (enum dig_joint)j, at_rad), 1e-8);
            assert_close(lever.length_m, model_cylinder_m(&machine, (enum dig_joint)j, at_rad),
                         1e-12);
        }
    }
}

TEST(every_bar_keeps_its_length_and_m_stays_on_its_side)
{
    const struct dig_machine machine = model_machine();
    const struct dig_vec2    q       = { machine.link[DIG_JOINT_ARM].length_m, 0.0 };
    for (int deg = -120; deg <= 30; deg++) {
        struct dig_linkage_pose p;
        assert_int_equal(dig_linkage_solve(&machine, deg * DIG_RAD_PER_DEG, &p), DIG_OK);
        const struct dig_vec2 rocker = dig_vec2_sub(p.rod_eye_m, machine.four_bar.rocker_pin_m);
        const struct dig_vec2 across = dig_vec2_sub(p.link_pin_m, machine.four_bar.rocker_pin_m);
        assert_close(dig_vec2_norm(rocker), machine.four_bar.rocker_m, 1e-12);
        assert_close(dig_vec2_norm(dig_vec2_sub(p.link_pin_m, p.rod_eye_m)),
                     machine.four_bar.link_m, 1e-12);
        assert_close(dig_vec2_norm(dig_vec2_sub(p.link_pin_m, q)),
                     dig_vec2_norm(machine.four_bar.ear_m), 1e-12);
        assert_true(dig_vec2_cross(across, rocker) > 0.0);
    }
}

// A parallelogram passes moment on unchanged, and here the rod stands square to the rocker.
// A push curls: clockwise, so negative.
TEST(parallelogram_gives_force_times_rocker)
{
    struct dig_machine machine                = model_machine();
    machine.link[DIG_JOINT_ARM].length_m      = 1.0;
    machine.cylinder[DIG_JOINT_BUCKET].base_m = (struct dig_vec2){ -2.0, 0.5 };
    machine.four_bar             = (struct dig_four_bar){ { 0.0, 0.0 }, 0.5, 1.0, { 0.5, 0.0 } };
    const struct dig_lever lever = solve(&machine, DIG_JOINT_BUCKET, 90 * DIG_RAD_PER_DEG);
    assert_close(lever.arm_m, -0.5, 1e-12);
    assert_close(lever.length_m, 2.0, 1e-12);
}

TEST(poses_that_cannot_be_are_refused_and_write_nothing)
{
    const struct dig_machine machine = model_machine();
    struct dig_machine       open = machine, toggled = machine, folded = machine, rodless = machine;
    struct dig_linkage_pose  at_0;
    assert_int_equal(dig_linkage_solve(&machine, 0.0, &at_0), DIG_OK);
    const double span_m =
        dig_vec2_norm(dig_vec2_sub(at_0.link_pin_m, machine.four_bar.rocker_pin_m));
    open.four_bar.link_m                      = 0.01;
    toggled.four_bar.link_m                   = span_m + machine.four_bar.rocker_m - 1e-6;
    folded.four_bar.rocker_pin_m              = at_0.link_pin_m;
    folded.four_bar.link_m                    = folded.four_bar.rocker_m;
    rodless.cylinder[DIG_JOINT_BUCKET].base_m = at_0.rod_eye_m;

    struct dig_linkage_pose pose  = { .lever = { .arm_m = 42.0 } };
    struct dig_lever        lever = { .arm_m = 42.0 };
    assert_int_equal(dig_linkage_solve(&open, 0.0, &pose), DIG_EUNREACHABLE);
    assert_int_equal(dig_linkage_solve(&toggled, 0.0, &pose), DIG_EUNREACHABLE);
    assert_int_equal(dig_linkage_solve(&folded, 0.0, &pose), DIG_EUNREACHABLE);
    assert_int_equal(dig_linkage_solve(&rodless, 0.0, &pose), DIG_EUNREACHABLE);
    assert_int_equal(dig_linkage_solve(&machine, NAN, &pose), DIG_EINVAL);
    assert_int_equal(dig_lever_solve(&machine, DIG_JOINT_BOOM, NAN, &lever), DIG_EINVAL);
    assert_int_equal(dig_lever_solve(&open, DIG_JOINT_BUCKET, 0.0, &lever), DIG_EUNREACHABLE);
    assert_close(pose.lever.arm_m, 42.0, 0.0);
    assert_close(lever.arm_m, 42.0, 0.0);
}

TEST(check_refuses_a_linkage_that_does_not_close_over_its_range)
{
    struct dig_machine machine = model_machine();
    assert_int_equal(dig_linkage_check(&machine), DIG_OK);
    machine.four_bar.link_m = 0.2; // too short where the ear points back
    assert_int_equal(dig_linkage_check(&machine), DIG_EUNREACHABLE);
}
