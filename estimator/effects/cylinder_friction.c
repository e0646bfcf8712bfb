// Friction of the seals: the rod pushes less than the pressures, against its motion. Each drive has
// a dry part, one that grows with its speed and one that grows with its push; at a crawl the dry
// part is larger by a share common to all (Stribeck; Armstrong-Helouvry 1994). Plain names are the
// bucket's.

#include "estimator/effects/list.h"

enum { COULOMB, VISCOUS, SHARE, STRIBECK, OF_A_DRIVE, STRIBECK_SPEED = 3 * OF_A_DRIVE, PARAMETERS };

static void correct(const double value[], struct dig_correction *const correction)
{
    static const int first[DIG_JOINTS] = {
        [DIG_JOINT_BUCKET] = 0, [DIG_JOINT_ARM] = OF_A_DRIVE, [DIG_JOINT_BOOM] = 2 * OF_A_DRIVE
    };
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double *const of  = &value[first[j]];
        correction->friction[j] = (struct dig_friction){
            .coulomb_N    = of[COULOMB],
            .viscous_Nspm = of[VISCOUS],
            .load_share   = of[SHARE],
            .stribeck_N   = of[STRIBECK],
            .stribeck_mps = value[STRIBECK_SPEED],
        };
    }
}

const struct dig_effect dig_effect_cylinder_friction = {
    .id         = DIG_EFFECT_CYLINDER_FRICTION,
    .summary    = "friction of the cylinders' seals, against the rod's motion",
    .parameters = PARAMETERS,
    .parameter  = {
        { "coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        { "viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        { "load_share", 0.0, -0.5, 0.5, 0.05 },
        { "stribeck_N", 0.0, -1e5, 1e5, 1000.0 },
        { "arm_coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        { "arm_viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        { "arm_load_share", 0.0, -0.5, 0.5, 0.05 },
        { "arm_stribeck_N", 0.0, -1e5, 1e5, 1000.0 },
        { "boom_coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        { "boom_viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        { "boom_load_share", 0.0, -0.5, 0.5, 0.05 },
        { "boom_stribeck_N", 0.0, -1e5, 1e5, 1000.0 },
        { "stribeck_mps", 0.02, 0.001, 0.5, 0.02, .bent = true },
    },
    .wrong_share = 0.08, .wrong_step = 0.35,
    .correct = correct,
};
