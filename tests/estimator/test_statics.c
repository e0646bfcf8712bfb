// Tests for estimator/wrench/statics.c

#include "estimator/wrench/statics.h"

#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

// The transform of docs/numerics.md by hand: boom 30 deg, arm -90 deg against it, bucket -30 deg
// against the arm, on links of 5.65, 2.89 and 0.9 m.
TEST(a_pose_worked_by_hand_is_placed_there)
{
    const struct dig_machine machine     = model_machine();
    const double             joint_rad[] = { 30 * DIG_RAD_PER_DEG, -90 * DIG_RAD_PER_DEG,
                                             -30 * DIG_RAD_PER_DEG };
    const struct dig_front   front       = dig_front_place(&machine, joint_rad);
    assert_close(front.pin_m[DIG_JOINT_ARM].x, 4.893044, 1e-6);
    assert_close(front.pin_m[DIG_JOINT_ARM].y, 2.825000, 1e-6);
    assert_close(front.pin_m[DIG_JOINT_BUCKET].x, 4.893044 + 1.445000, 1e-6);
    assert_close(front.pin_m[DIG_JOINT_BUCKET].y, 2.825000 - 2.502813, 1e-6);
    assert_close(front.attitude_rad[DIG_JOINT_BUCKET], -0.5 * DIG_PI, 1e-12);

    // The tooth hangs straight down, so the bucket's +y is +X: 0.17 m forward, 0.4 m down.
    assert_close(front.com_m[DIG_JOINT_BUCKET].x, 6.338044 + 0.17, 1e-6);
    assert_close(front.com_m[DIG_JOINT_BUCKET].y, 0.322187 - 0.40, 1e-6);
    double moment_Nm[DIG_JOINTS];
    dig_statics_weight_Nm(&machine, &front, 0.0, moment_Nm);
    assert_close(moment_Nm[DIG_JOINT_BUCKET], -330 * 9.81 * 0.17, 1e-9);
}

// Weight does work along every joint: its moment is the slope of potential energy.
TEST(weights_moment_is_the_slope_of_potential_energy)
{
    const struct dig_machine machine = model_machine();
    uint64_t                 seed    = 3;
    for (int trial = 0; trial < 200; trial++) {
        double joint_rad[DIG_JOINTS];
        for (int j = 0; j < DIG_JOINTS; j++) {
            joint_rad[j] = 6.0 * (model_uniform(&seed) - 0.5);
        }
        const double           pitch_rad = 0.6 * (model_uniform(&seed) - 0.5);
        const struct dig_front front     = dig_front_place(&machine, joint_rad);
        double                 moment_Nm[DIG_JOINTS];
        dig_statics_weight_Nm(&machine, &front, pitch_rad, moment_Nm);
        for (int j = 0; j < DIG_JOINTS; j++) {
            double height_J[2];
            for (int side = 0; side < 2; side++) {
                double moved[DIG_JOINTS];
                for (int k = 0; k < DIG_JOINTS; k++) {
                    moved[k] = joint_rad[k] + (k == j ? (side == 0 ? -1e-5 : 1e-5) : 0.0);
                }
                const struct dig_front f = dig_front_place(&machine, moved);
                height_J[side]           = 0.0;
                for (int k = 0; k < DIG_JOINTS; k++) {
                    height_J[side] +=
                        machine.link[k].mass_kg * 9.81 *
                        (f.com_m[k].x * sin(pitch_rad) + f.com_m[k].y * cos(pitch_rad));
                }
            }
            assert_close(moment_Nm[j], -(height_J[1] - height_J[0]) / 2e-5, 1e-3);
        }
    }
}
