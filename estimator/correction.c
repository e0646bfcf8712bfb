#include "estimator/correction.h"

#include "estimator/linkage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// The struct holds nothing but doubles: it is read as an array of them.
enum { NUMBERS = sizeof(struct dig_correction) / sizeof(double) };
_Static_assert(sizeof(struct dig_correction) % sizeof(double) == 0, "doubles only");

bool dig_correction_is_none(const struct dig_correction *const correction)
{
    assert(correction != NULL);
    const double *const number = (const double *)(const void *)correction;
    bool                none   = true;
    for (size_t i = 0; i < NUMBERS; i++) {
        none = none && fpclassify(number[i]) == FP_ZERO;
    }
    return none;
}

static void add(struct dig_vec2 *const to, const struct dig_vec2 more)
{
    *to = dig_vec2_add_scaled(*to, 1.0, more);
}

// The centre of mass moves; the inertia about it is the file's and what the burden says.
static void add_burden(struct dig_link *const link, const struct dig_burden *const burden)
{
    const double mass_kg = link->mass_kg + burden->mass_kg;
    link->com_m          = dig_vec2_add_scaled(link->com_m, 1.0 / mass_kg, burden->moment_kgm);
    link->mass_kg        = mass_kg;
    link->inertia_kgm2 += burden->inertia_kgm2;
}

struct dig_machine dig_correction_machine(const struct dig_machine *const    machine,
                                          const struct dig_correction *const correction)
{
    assert(machine != NULL && correction != NULL);
    struct dig_machine made = *machine;
    add_burden(&made.link[DIG_JOINT_BUCKET], &correction->bucket);
    add_burden(&made.link[DIG_JOINT_BUCKET], &correction->payload);

    made.four_bar.rocker_m += correction->rocker_m;
    made.four_bar.link_m += correction->link_m;
    add(&made.four_bar.rocker_pin_m, correction->rocker_pin_m);
    add(&made.four_bar.ear_m, correction->ear_m);
    for (int j = 0; j < DIG_JOINTS; j++) {
        add(&made.cylinder[j].base_m, correction->base_m[j]);
        add(&made.cylinder[j].eye_m, correction->eye_m[j]);
    }
    return made;
}

enum dig_status dig_correction_check(const struct dig_machine *const    machine,
                                     const struct dig_correction *const correction)
{
    assert(machine != NULL && correction != NULL);
    const double *const number = (const double *)(const void *)correction;
    for (size_t i = 0; i < NUMBERS; i++) {
        if (!isfinite(number[i])) {
            return DIG_EINVAL;
        }
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int c = 0; c < DIG_CHAMBERS; c++) {
            if (!(correction->gain[j][c] > -1.0)) {
                return DIG_EINVAL;
            }
        }
        if (!(correction->friction[j].stribeck_mps >= 0.0)) {
            return DIG_EINVAL;
        }
    }
    const struct dig_machine made   = dig_correction_machine(machine, correction);
    enum dig_status          status = dig_machine_check(&made, NULL);
    if (status == DIG_OK) {
        status = dig_linkage_check(&made, NULL);
    }
    return status;
}
