#include "core/table_step.h"

#include "core/contact.h"

#include <assert.h>
#include <stdio.h>

// Of the derived step: beds of the rig lie still at 1.30 times it, move at 1.60 and 1.67
// (docs/numerics/dem.md, "A step that heats").
#define TREMBLES 1.45

struct dig_table_step dig_table_step_of(const struct dig_material *const finest,
                                        const enum dig_normal_law        normal,
                                        const double lightest_kgpm3, const double taken_s)
{
    assert(finest != NULL);
    struct dig_scene scene  = { .material = *finest };
    scene.material.young_Pa = dig_scene_young_Pa(&scene, lightest_kgpm3);
    return (struct dig_table_step){
        .taken_s        = taken_s,
        .derived_s      = dig_contact_step_s(&scene.material, normal, lightest_kgpm3),
        .lightest_kgpm3 = lightest_kgpm3,
    };
}

void dig_table_step_text(const struct dig_table_step *const step,
                         char                               text[const DIG_TABLE_STEP_TEXT_SIZE])
{
    assert(step != NULL && text != NULL);
    text[0] = '\0';
    if (step->taken_s > TREMBLES * step->derived_s) {
        (void)snprintf(
            text, DIG_TABLE_STEP_TEXT_SIZE,
            "gravel of %.4g kg/m3 trembles at the time step it was dug at, %.3g us where "
            "%.3g is derived for it, and resists too little (docs/tables.md)",
            step->lightest_kgpm3, 1e6 * step->taken_s, 1e6 * step->derived_s);
    }
}
