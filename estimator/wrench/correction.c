#include "estimator/wrench/correction.h"

#include "core/linkage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// The struct holds nothing but doubles: it is read as an array of them.
enum { NUMBERS = sizeof(struct dig_correction) / sizeof(double) };
_Static_assert(sizeof(struct dig_correction) % sizeof(double) == 0, "doubles only");

static bool is_none(const struct dig_correction *const correction)
{
    const double *const number = (const double *)(const void *)correction;
    bool                none   = true;
    for (size_t i = 0; i < NUMBERS; i++) {
        none = none && fpclassify(number[i]) == FP_ZERO;
    }
    return none;
}

// Moves the centre of mass and adds to the inertia about it.
static void add_burden(struct dig_link *const link, const struct dig_added_mass *const burden)
{
    const double mass_kg = link->mass_kg + burden->mass_kg;
    link->com_m          = dig_vec2_add_scaled(link->com_m, 1.0 / mass_kg, burden->moment_kgm);
    link->mass_kg        = mass_kg;
    link->inertia_kgm2 += burden->inertia_kgm2;
}

// sign 1: applies the geometry; -1: removes it.
static void move_pins(struct dig_machine *const machine, const double sign,
                      const struct dig_correction *const by)
{
    struct dig_four_bar *const bar = &machine->four_bar;
    bar->rocker_m += sign * by->rocker_m;
    bar->link_m += sign * by->link_m;
    bar->rocker_pin_m = dig_vec2_add_scaled(bar->rocker_pin_m, sign, by->rocker_pin_m);
    bar->ear_m        = dig_vec2_add_scaled(bar->ear_m, sign, by->ear_m);
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_cylinder *const cylinder = &machine->cylinder[j];
        cylinder->base_m = dig_vec2_add_scaled(cylinder->base_m, sign, by->base_m[j]);
        cylinder->eye_m  = dig_vec2_add_scaled(cylinder->eye_m, sign, by->eye_m[j]);
    }
}

struct dig_machine dig_correction_machine(const struct dig_machine *const    machine,
                                          const struct dig_correction *const correction)
{
    assert(machine != NULL && correction != NULL);
    struct dig_machine made = *machine;
    for (int j = 0; j < DIG_JOINTS; j++) {
        add_burden(&made.link[j], &correction->link[j]);
    }
    add_burden(&made.link[DIG_JOINT_BUCKET], &correction->payload);
    move_pins(&made, 1.0, correction);
    return made;
}

bool dig_correction_is_geometric(const struct dig_correction *const correction)
{
    assert(correction != NULL);
    double moved_m = fabs(correction->rocker_m) + fabs(correction->link_m) +
                     dig_vec2_norm(correction->rocker_pin_m) + dig_vec2_norm(correction->ear_m);
    for (int j = 0; j < DIG_JOINTS; j++) {
        moved_m += dig_vec2_norm(correction->base_m[j]) + dig_vec2_norm(correction->eye_m[j]);
    }
    return moved_m > 0.0;
}

struct dig_machine dig_correction_drawn(const struct dig_machine *const    corrected,
                                        const struct dig_correction *const correction)
{
    assert(corrected != NULL && correction != NULL);
    struct dig_machine drawn = *corrected;
    move_pins(&drawn, -1.0, correction);
    return drawn;
}

static bool can_be(const struct dig_correction *const correction)
{
    const double *const number = (const double *)(const void *)correction;
    bool                can    = true;
    for (size_t i = 0; i < NUMBERS; i++) {
        can = can && isfinite(number[i]);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        can = can && correction->friction[j].stribeck_mps >= 0.0;
        for (int c = 0; c < DIG_CHAMBERS; c++) {
            can = can && correction->gain[j][c] > -1.0;
        }
    }
    return can;
}

enum dig_status dig_correction_apply(const struct dig_machine *const     machine,
                                     const struct dig_correction *const  correction,
                                     struct dig_corrected_machine *const corrected)
{
    assert(machine != NULL && correction != NULL && corrected != NULL);
    struct dig_corrected_machine made = { .corrects = !is_none(correction) };
    if (made.corrects) {
        if (machine->sensor.fitted || !can_be(correction)) {
            return DIG_EINVAL;
        }
        made.correction        = *correction;
        made.machine           = dig_correction_machine(machine, correction);
        enum dig_status status = dig_machine_check(&made.machine, NULL);
        status                 = status == DIG_OK ? dig_linkage_check(&made.machine) : status;
        if (status != DIG_OK) {
            return status;
        }
    }
    *corrected = made;
    return DIG_OK;
}
