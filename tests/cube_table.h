// A table of eight gravels at the corners of a cube, for tests to which a gravel is one that
// resists more than another. The curves are each test's own.

#ifndef DIG_TESTS_CUBE_TABLE_H
#define DIG_TESTS_CUBE_TABLE_H

#include "core/curve.h"
#include "core/outline.h"

#define CUBE_GRAVELS 8

struct cube_table {
    struct dig_curve_set set;
    double               axis[DIG_AXES][2];
    struct dig_gravel    gravel[CUBE_GRAVELS];
    int                  cell[CUBE_GRAVELS];
    int                  packings[CUBE_GRAVELS * DIG_TRAJECTORY_MAX];
    struct dig_curve     curve[CUBE_GRAVELS * DIG_TRAJECTORY_MAX];
    struct dig_outline   outline[DIG_FORCE_CHANNELS * CUBE_GRAVELS * DIG_TRAJECTORY_MAX];
};

/// Fills in axes and gravels, and hangs the arrays into the set. Of a gravel's number the first of
/// three bits is friction, the last density. Trajectories and scales of the set, packings and
/// curves are left as they are; dig_outlines_draw() once they are filled in.
static inline void cube_table_init(struct cube_table *const cube)
{
    struct dig_curve_set *const set = &cube->set;
    set->entries                    = CUBE_GRAVELS;
    set->gravel                     = cube->gravel;
    set->packings                   = cube->packings;
    set->curve                      = cube->curve;
    set->outline                    = cube->outline;
    set->cell                       = cube->cell;
    for (int axis = 0; axis < DIG_AXES; axis++) {
        cube->axis[axis][0]   = axis == DIG_AXIS_DENSITY_kgpm3 ? 1500.0 : 0.3;
        cube->axis[axis][1]   = axis == DIG_AXIS_DENSITY_kgpm3 ? 2500.0 : 0.9;
        set->axis_count[axis] = 2;
        set->axis[axis]       = cube->axis[axis];
    }
    for (int g = 0; g < CUBE_GRAVELS; g++) {
        cube->cell[g]   = g;
        cube->gravel[g] = (struct dig_gravel){ { cube->axis[0][g / 4], cube->axis[1][g / 2 % 2],
                                                 cube->axis[2][g % 2] } };
    }
}

#endif // DIG_TESTS_CUBE_TABLE_H
