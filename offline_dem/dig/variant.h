// A plain scene with one effect of the soil put into it at a magnitude: what a table of effects is
// computed of.
//
//   effect          magnitude                                     absent at
//   cohesion        J/m3   SJKR between grains, and between       0
//                          grains and bucket
//   adhesion        J/m3   SJKR between grains and bucket         0
//   polydispersity  1      largest / smallest diameter; three     1
//                          classes, 30, 40 and 30 % by mass,
//                          the middle one the plain diameter:
//                          5/3 is .8, 1 and 4/3 of it
//   grain_shape     1      length / width of a clump of two       1
//                          spheres, volume as before; at most 2
//   ground_slope    deg    the ground rises in +x                 0
//   layering        m      top of a layer from the floor up:      0
//                          hard, .9/.9/4000; below 0 a loose
//                          one, .3/.3/1500, minus its top
//   obstacle        m      diameter of a fixed sphere, its        0
//                          centre at the ground's height, in the
//                          middle of the first trajectory's drag;
//                          the bucket goes through it, the
//                          grains do not
//   compaction      digs   made before in the same bed, the       0
//                          ground raked level after each
//   bucket_friction 1      how much smoother the bucket is than     0
//                          the scene's: the share of friction and
//                          rolling friction that grains lack
//                          there; .4 leaves .3 of .5
//
// A slope keeps its height where the teeth start: the ground is the highest plane of that slope
// above which every trajectory's tooth starts. A time step that is given is shortened with the
// smallest sphere.

#ifndef DIG_OFFLINE_DEM_DIG_VARIANT_H
#define DIG_OFFLINE_DEM_DIG_VARIANT_H

#include "core/effect.h"
#include "core/error.h"
#include "core/scene.h"

/// "J/m3", "deg", …: the unit of the effect's magnitude; NULL for an effect no DEM of ours holds.
const char *dig_variant_unit(enum dig_effect_id effect);

/// Writes the plain scene with the effect at this magnitude. DIG_EINVAL: an effect without a bed,
/// or a magnitude out of range
/// (*error names both); then *varied is untouched. varied may not be scene.
DIG_MUST_CHECK enum dig_status dig_variant_make(const struct dig_scene *scene,
                                                enum dig_effect_id effect, double magnitude,
                                                struct dig_scene *varied, struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_VARIANT_H
