// Reads a grid YAML: the values of friction, rolling friction and density a table is computed at,
// single points beside them, and the effects to put into the beds.

#ifndef DIG_FILES_GRID_YAML_H
#define DIG_FILES_GRID_YAML_H

#include "core/curve.h"
#include "core/effect.h"
#include "core/error.h"
#include "core/scene.h"

#define DIG_AXIS_VALUES_MAX  32
#define DIG_GRID_POINTS_MAX  256
#define DIG_GRID_EFFECTS_MAX 16
#define DIG_MAGNITUDES_MAX   16

/// A gravel with its own number of packings: one of the grid's, or one more.
struct dig_grid_point {
    struct dig_gravel gravel;
    size_t            packings;
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
    size_t                 trajectories; // which of the scene's; 0: all
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
