// Reads a grid YAML: the values of friction, rolling friction and density a table is computed at,
// single points beside them, the effects to put into the beds, and how else the digs are made.

#ifndef DIG_FILES_GRID_YAML_H
#define DIG_FILES_GRID_YAML_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/effect.h"
#include "core/error.h"
#include "core/scene.h"

#define DIG_AXIS_VALUES_MAX     32
#define DIG_GRID_POINTS_MAX     256
#define DIG_GRID_EFFECTS_MAX    16
#define DIG_MAGNITUDES_MAX      16
#define DIG_APPROACH_VALUES_MAX 8
#define DIG_GRID_APPROACHES_MAX (DIG_APPROACH_VALUES_MAX * DIG_APPROACH_VALUES_MAX)

/// A gravel with its own number of packings: one of the grid's, or one more. Where the point states
/// an approach, it is this one dig alone; else the gravel is dug in all the grid's approaches.
struct dig_grid_point {
    struct dig_gravel   gravel;
    size_t              packings;
    bool                states;
    struct dig_approach approach;
};

struct dig_grid_effect {
    enum dig_effect_id effect; // of the soil
    size_t             magnitudes;
    double             magnitude[DIG_MAGNITUDES_MAX]; // all different, in the effect's unit
};

struct dig_grid {
    size_t                 count[DIG_AXES];                      // all 0: points alone
    double                 value[DIG_AXES][DIG_AXIS_VALUES_MAX]; // ascending
    size_t                 packings; // digs per point, each in its own bed
    size_t                 points;
    struct dig_grid_point  point[DIG_GRID_POINTS_MAX]; // all different
    size_t                 effects;                    // 0: plain beds; else beds with these alone
    struct dig_grid_effect effect[DIG_GRID_EFFECTS_MAX];
    size_t                 approaches; // beside the plain one; 0 with effects
    struct dig_approach    approach[DIG_GRID_APPROACHES_MAX]; // all different, none plain
    size_t                 varied_packings; // of digs that are not plain; 0: as the gravel's
    size_t                 trajectories;    // which of the scene's; 0: all
    char                   trajectory[DIG_TRAJECTORY_MAX][DIG_NAME_SIZE];
};

DIG_MUST_CHECK enum dig_status dig_grid_read(const char *path, struct dig_grid *grid,
                                             struct dig_error *error);

/// The grid's trajectories as indices in the scene, all of them when the grid names none. A name
/// the scene lacks is refused with the grid's file and line. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_grid_trajectories(const char *path, const struct dig_grid *grid,
                                                     const struct dig_scene *scene, size_t *count,
                                                     size_t trajectory[DIG_TRAJECTORY_MAX],
                                                     struct dig_error *error);

#endif // DIG_FILES_GRID_YAML_H
