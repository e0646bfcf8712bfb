// The points of a grid as a plan.

#ifndef DIG_TOOLS_DIGTABLE_PLAN_H
#define DIG_TOOLS_DIGTABLE_PLAN_H

#include "offline_dem/sweep/sweep.h"
#include "tables/queue.h"

/// Reads a scene and a grid into a plan in one part; plan->point is *point, which the caller frees:
/// every gravel of the axes and every single point, plain and in every approach, or with each
/// effect at each magnitude. packings overrides the grid's numbers unless it is 0. Refuses what
/// dig_scene_read() and dig_grid_read() refuse, a trajectory the scene lacks, and one that leaves
/// the box. All three are written on success only.
DIG_MUST_CHECK enum dig_status dig_plan_read(const char *scene_path, const char *grid_path,
                                             size_t packings, struct dig_scene *scene,
                                             struct dig_plan *plan, struct dig_plan_point **point,
                                             struct dig_error *error);

/// The SHA-256 of all that the runs of the plan follow from: scene, engine with its version, points
/// in their order, trajectories. Not of its shards.
void dig_plan_hash(const struct dig_plan *plan, const struct dig_scene *scene,
                   const struct dig_engine *engine, char hex[65]);

/// Refuses a point whose effect cannot be put into the scene at that magnitude, and one whose
/// approach takes a trajectory of the plan out of the box or starts it in the ground.
DIG_MUST_CHECK enum dig_status
dig_plan_check(const struct dig_plan *plan, const struct dig_scene *scene, struct dig_error *error);

#endif // DIG_TOOLS_DIGTABLE_PLAN_H
