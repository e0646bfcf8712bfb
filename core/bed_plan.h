// Checks a scene's bed beyond one kind of equal spheres, and writes it into the scene's identity.
// A plain scene's identity does not hold it.

#ifndef DIG_CORE_BED_PLAN_H
#define DIG_CORE_BED_PLAN_H

#include "core/scene.h"

/// Refuses laws and a bed that cannot be computed; *error names the key ("bed.sizes[1].diameter_m:
/// -1, expected …"). The rest of the scene has been checked.
DIG_MUST_CHECK enum dig_status dig_bed_plan_check(const struct dig_scene *scene,
                                                  struct dig_error       *error);

/// Adds a line for every part of the laws and the bed that is not the plain one.
void dig_bed_plan_canonical(const struct dig_scene *scene, char text[DIG_SCENE_TEXT_SIZE]);

/// "gravel", a material's own name, "bucket" or "walls".
const char *dig_material_name(const struct dig_bed_plan *bed, size_t material);

#endif // DIG_CORE_BED_PLAN_H
