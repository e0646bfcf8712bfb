// Checks a scene's bed beyond one kind of equal spheres, and writes it into the scene's identity.
// A plain scene's identity does not hold it.

#ifndef DIG_CORE_BED_PLAN_H
#define DIG_CORE_BED_PLAN_H

#include "core/error.h"
#include "core/scene.h"

/// A number of the scene, and the range it must be in.
struct dig_scene_range {
    const char *key;
    double      value, least, most;
    bool        above; // the least itself is refused, too
};

/// list: the list whose entry `at` they are of; NULL: of none.
void dig_scene_check_ranges(const char *list, size_t at, size_t n,
                            const struct dig_scene_range range[], struct dig_conditions *c);

/// Refuses laws and a bed that cannot be computed, with the key ("bed.sizes[1].diameter_m: -1,
/// expected …"). The rest of the scene has been checked.
void dig_bed_plan_check(const struct dig_scene *scene, struct dig_conditions *c);

/// Adds a line for every part of the laws and the bed that is not the plain one.
void dig_bed_plan_canonical(const struct dig_scene *scene, char text[DIG_SCENE_TEXT_SIZE]);

/// "gravel", a material's own name, "bucket" or "walls".
const char *dig_material_name(const struct dig_bed_plan *bed, size_t material);

#endif // DIG_CORE_BED_PLAN_H
