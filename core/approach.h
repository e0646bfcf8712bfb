// The approach of a dig: along its trajectory as it stands, deeper, or with the bucket turned.
//
//   depth   factor on how far below the ground the tooth is at the end of the first phase. The
//           pin's velocity in that phase is scaled, so that its direction, its duration and its
//           turning stay; the phases behind it are the same, carried out where it ends
//   attack  angle the bucket is turned by about its tooth where the trajectory starts, all along
//           the dig; positive curls, as theta does
//
//      plain ___o______ground___      depth ___o__________      attack ___o__________
//                \_________                     \                          \_________
//                                                \_________        theta + attack all along

#ifndef DIG_CORE_APPROACH_H
#define DIG_CORE_APPROACH_H

#include "core/curve.h"
#include "core/error.h"
#include "core/scene.h"

#include <stdbool.h>

#define DIG_APPROACH_DEPTH_LEAST     0.2
#define DIG_APPROACH_DEPTH_MOST      3.0
#define DIG_APPROACH_ATTACK_MOST_rad 0.7853981633974483 // 45 deg

#define DIG_APPROACH_TEXT_SIZE 64

/// Zeroed it is the plain one: depth 0 counts as 1.
struct dig_approach {
    double depth;
    double attack_rad;
};

/// Depth 1, attack 0.
struct dig_approach dig_approach_plain(void);

/// For people and tables: depth 0, of a zeroed struct, becomes 1.
struct dig_approach dig_approach_normalized(const struct dig_approach *approach);

bool dig_approach_is_plain(const struct dig_approach *approach);
bool dig_approach_is_same(const struct dig_approach *a, const struct dig_approach *b);

/// "depth 1.15, attack -5 deg" behind a ", ", or "" of the plain one.
void dig_approach_text(const struct dig_approach *approach, char text[DIG_APPROACH_TEXT_SIZE]);

/// How far below the ground the tooth is at the end of the first phase, m; negative above it.
double dig_approach_depth_m(const struct dig_scene *scene, const struct dig_trajectory *trajectory);

/// The trajectory dug so; depth_m is what dig_approach_depth_m() says of the plain one. The plain
/// approach gives the same trajectory bit by bit. DIG_EINVAL, all named in *error: a depth or an
/// attack out of range, or another depth of a trajectory whose first phase does not go down below
/// the ground. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_approach_apply(const struct dig_trajectory *trajectory,
                                                  double tooth_m, double depth_m,
                                                  const struct dig_approach *approach,
                                                  struct dig_trajectory     *made,
                                                  struct dig_error          *error);

/// The same in a scene: refuses, too, a bucket that starts in the ground where the plain one does
/// not (by more than half a grain; what grains it cuts is for the dig itself to find).
DIG_MUST_CHECK enum dig_status dig_approach_make(const struct dig_scene      *scene,
                                                 const struct dig_trajectory *trajectory,
                                                 const struct dig_approach   *approach,
                                                 struct dig_trajectory       *made,
                                                 struct dig_error            *error);

#endif // DIG_CORE_APPROACH_H
