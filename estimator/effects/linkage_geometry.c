// Pins and bars of the linkages are not where the file says: the levers are wrong, and so is every
// moment, in proportion to the push.

#include "estimator/effects/list.h"

enum {
    ROCKER,
    LINK,
    ROCKER_PIN_X,
    ROCKER_PIN_Y,
    EAR_X,
    EAR_Y,
    BASE_X,
    BASE_Y,
    ARM_BASE_X,
    ARM_BASE_Y,
    ARM_EYE_X,
    ARM_EYE_Y,
    BOOM_BASE_X,
    BOOM_BASE_Y,
    BOOM_EYE_X,
    BOOM_EYE_Y,
    PARAMETERS
};

static void add(const double value[], struct dig_vec2 *const to)
{
    to->x += value[0];
    to->y += value[1];
}

static void correct(const double value[], struct dig_correction *const correction)
{
    correction->rocker_m += value[ROCKER];
    correction->link_m += value[LINK];
    add(&value[ROCKER_PIN_X], &correction->rocker_pin_m);
    add(&value[EAR_X], &correction->ear_m);
    add(&value[BASE_X], &correction->base_m[DIG_JOINT_BUCKET]);
    add(&value[ARM_BASE_X], &correction->base_m[DIG_JOINT_ARM]);
    add(&value[ARM_EYE_X], &correction->eye_m[DIG_JOINT_ARM]);
    add(&value[BOOM_BASE_X], &correction->base_m[DIG_JOINT_BOOM]);
    add(&value[BOOM_EYE_X], &correction->eye_m[DIG_JOINT_BOOM]);
}

#define SHIFT(name)                                                                                \
    {                                                                                              \
        name, 0.0, -0.5, 0.5, 0.02                                                                 \
    }

const struct dig_effect dig_effect_linkage_geometry = {
    .id         = DIG_EFFECT_LINKAGE_GEOMETRY,
    .summary    = "pins or bars of the linkages that are not where the file says",
    .parameters = PARAMETERS,
    .parameter  = {
        [ROCKER]       = SHIFT("rocker_m"),
        [LINK]         = SHIFT("link_m"),
        [ROCKER_PIN_X] = SHIFT("rocker_pin_x_m"),
        [ROCKER_PIN_Y] = SHIFT("rocker_pin_y_m"),
        [EAR_X]        = SHIFT("ear_x_m"),
        [EAR_Y]        = SHIFT("ear_y_m"),
        [BASE_X]       = SHIFT("bucket_base_x_m"),
        [BASE_Y]       = SHIFT("bucket_base_y_m"),
        [ARM_BASE_X]   = SHIFT("arm_base_x_m"),
        [ARM_BASE_Y]   = SHIFT("arm_base_y_m"),
        [ARM_EYE_X]    = SHIFT("arm_eye_x_m"),
        [ARM_EYE_Y]    = SHIFT("arm_eye_y_m"),
        [BOOM_BASE_X]  = SHIFT("boom_base_x_m"),
        [BOOM_BASE_Y]  = SHIFT("boom_base_y_m"),
        [BOOM_EYE_X]   = SHIFT("boom_eye_x_m"),
        [BOOM_EYE_Y]   = SHIFT("boom_eye_y_m"),
    },
    .wrong_share = 0.08, .wrong_step = 0.35,
    .correct = correct,
};
