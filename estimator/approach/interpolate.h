// Interpolation between the points of a table: multilinear in friction, rolling friction and log
// density.

#ifndef DIG_ESTIMATOR_APPROACH_INTERPOLATE_H
#define DIG_ESTIMATOR_APPROACH_INTERPOLATE_H

#include "core/curve.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_CELL_CORNERS (1 << DIG_AXES)

/// Between the points of one channel, at a place 0 … DIG_CURVE_POINTS - 1; held at the ends.
double dig_curve_at(const float y[DIG_CURVE_POINTS], double place);

/// The entries around a gravel and their weights; corners without weight are left out.
struct dig_cell {
    size_t                  corners;
    const struct dig_curve *curve[DIG_CELL_CORNERS];
    double                  weight[DIG_CELL_CORNERS];
    double                  inverse_packings; // weighted mean of 1 / packings
    double error2[DIG_CHANNELS];              // weighted mean of the squares of the curves' errors
    double mean_variance; // of the mean, in variances of one dig: sum of weight^2 / packings
};

/// Position of a value on an axis of the set, 0 … 1 from its first to its last point, linear in the
/// value, of density in its logarithm; 0 on an axis of one point. And back.
double dig_axis_position(const struct dig_curve_set *set, enum dig_axis axis, double value);
double dig_axis_value(const struct dig_curve_set *set, enum dig_axis axis, double position);

/// A value on an axis of the set: the point before it, and the fraction of the way to the next.
struct dig_axis_interval {
    size_t index;
    double fraction; // 0 … 1
};

/// DIG_ENOMATCH when the value is outside the axis; one within 1e-9 of its end counts as on it.
DIG_MUST_CHECK enum dig_status dig_axis_locate(const struct dig_curve_set *set, enum dig_axis axis,
                                               double value, struct dig_axis_interval *place);

/// The cell of one entry's curve alone, [slot], which must be there.
struct dig_cell dig_cell_of_entry(const struct dig_curve_set *set, size_t slot);

/// The cell at a place on each axis, which must have points. DIG_ENOMATCH when a corner with weight
/// is missing or lacks the trajectory.
DIG_MUST_CHECK enum dig_status dig_cell_at(const struct dig_curve_set    *set,
                                           const struct dig_axis_interval place[DIG_AXES],
                                           size_t trajectory, struct dig_cell *cell);

/// The cell around a gravel. DIG_ENOMATCH when the gravel is outside the grid or a corner with
/// weight is missing or lacks the trajectory. A value within 1e-9 of the grid's end counts as on
/// it. Constant time but for the search along the axes.
DIG_MUST_CHECK enum dig_status dig_cell_find(const struct dig_curve_set *set,
                                             const struct dig_gravel *gravel, size_t trajectory,
                                             struct dig_cell *cell);

/// Mean and standard deviation of one channel at one point of the curve.
static inline double dig_cell_mean(const struct dig_cell *const cell,
                                   const enum dig_channel channel, const size_t point)
{
    double sum = 0.0;
    for (size_t c = 0; c < cell->corners; c++) {
        sum += cell->weight[c] * (double)cell->curve[c]->mean[channel][point];
    }
    return sum;
}

static inline double dig_cell_sd(const struct dig_cell *const cell, const enum dig_channel channel,
                                 const size_t point)
{
    double sum = 0.0;
    for (size_t c = 0; c < cell->corners; c++) {
        sum += cell->weight[c] * (double)cell->curve[c]->sd[channel][point];
    }
    return sum;
}

/// Both of all points and channels.
void dig_cell_curve(const struct dig_cell *cell, struct dig_curve *curve);

/// The same of all points at once, several times faster.
void dig_cell_blend(const struct dig_cell *cell, enum dig_channel channel,
                    double mean[DIG_CURVE_POINTS], double sd[DIG_CURVE_POINTS]);

#endif // DIG_ESTIMATOR_APPROACH_INTERPOLATE_H
