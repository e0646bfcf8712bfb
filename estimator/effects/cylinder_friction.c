// Seals rub: the pressures push harder than the rod does, against its motion. Each drive has a dry
// part, one that grows with its speed and one that grows with its push; at a crawl the dry part is
// larger by a share common to all (Stribeck; Armstrong-Helouvry 1994). Plain names are the
// bucket's.

#include "estimator/effects/list.h"

#include <math.h>

enum {
    COULOMB,
    VISCOUS,
    SHARE,
    ARM_COULOMB,
    ARM_VISCOUS,
    ARM_SHARE,
    BOOM_COULOMB,
    BOOM_VISCOUS,
    BOOM_SHARE,
    STRIBECK,
    STRIBECK_SPEED,
    PARAMETERS
};

static void correct(const double value[], struct dig_correction *const correction)
{
    static const int first[DIG_JOINTS] = {
        [DIG_JOINT_BOOM] = BOOM_COULOMB, [DIG_JOINT_ARM] = ARM_COULOMB, [DIG_JOINT_BUCKET] = COULOMB
    };
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double *const of  = &value[first[j]];
        correction->friction[j] = (struct dig_friction){
            .coulomb_N    = of[COULOMB],
            .viscous_Nspm = of[VISCOUS],
            .load_share   = of[SHARE],
            .stribeck_N   = value[STRIBECK] * fabs(of[COULOMB]),
            .stribeck_mps = value[STRIBECK_SPEED],
        };
    }
}

const struct dig_effect dig_effect_cylinder_friction = {
    .id         = DIG_EFFECT_CYLINDER_FRICTION,
    .summary    = "friction of the cylinders' seals, against the rod's motion",
    .parts      = DIG_IN_AIR | DIG_IN_SOIL | DIG_IN_LIFT,
    .parameters = PARAMETERS,
    .parameter  = {
        [COULOMB]        = { "coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        [VISCOUS]        = { "viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        [SHARE]          = { "load_share", 0.0, -0.5, 0.5, 0.05 },
        [ARM_COULOMB]    = { "arm_coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        [ARM_VISCOUS]    = { "arm_viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        [ARM_SHARE]      = { "arm_load_share", 0.0, -0.5, 0.5, 0.05 },
        [BOOM_COULOMB]   = { "boom_coulomb_N", 0.0, -1e5, 1e5, 2000.0 },
        [BOOM_VISCOUS]   = { "boom_viscous_Nspm", 0.0, -1e6, 1e6, 2e4 },
        [BOOM_SHARE]     = { "boom_load_share", 0.0, -0.5, 0.5, 0.05 },
        [STRIBECK]       = { "stribeck_share", 0.0, -5.0, 5.0, 0.5 },
        [STRIBECK_SPEED] = { "stribeck_mps", 0.02, 0.001, 0.5, 0.02 },
    },
    .correct = correct,
};
