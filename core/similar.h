// Compares two scenes up to their size: digs in one can be matched with a table of the other where
// they are similar. Froude similarity: lengths, grains and Young's modulus in proportion to the
// bucket, gravity the same.

#ifndef DIG_CORE_SIMILAR_H
#define DIG_CORE_SIMILAR_H

#include "core/curve.h"
#include "core/machine.h"
#include "core/scene.h"

/// Shapes farther apart than this after scaling are two.
#define DIG_SIMILAR 0.05

/// Bucket of the scene over bucket of the other, pin to tooth.
double dig_scene_scale(const struct dig_scene *scene, const struct dig_scene *other);

/// DIG_EINVAL unless the scene is similar to the other; *error names the key, what it is and what
/// it would be after scaling. Compared within DIG_SIMILAR: the bucket's width and outline, the box
/// and whether it has sides, the size of the grains, gravity, and of trajectories of one name the
/// start above the ground and behind the wall and the way from there (of bucket and tooth, whatever
/// the pace). The stiffness of contacts may differ by a factor of 1.75. That changes the moment by
/// some 5 %, as four times Young's modulus adds 13 % (docs/numerics/dem.md).
///
/// Not compared: what trajectories only one of them has, how the bed was poured, time step and
/// output, Poisson's ratio and restitution, and what laws and bed hold beyond equal spheres in a
/// level box: that is what a trace looks for.
DIG_MUST_CHECK enum dig_status dig_scene_similar(const struct dig_scene *scene,
                                                 const struct dig_scene *other,
                                                 struct dig_error       *error);

/// DIG_EINVAL unless the machine's bucket is as wide over its length as that of the set's scene,
/// within DIG_SIMILAR; *error names both.
DIG_MUST_CHECK enum dig_status dig_bucket_similar(const struct dig_machine   *machine,
                                                  const struct dig_curve_set *set,
                                                  struct dig_error           *error);

#endif // DIG_CORE_SIMILAR_H
