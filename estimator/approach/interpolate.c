#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>

static const double edge = 1e-9;

double dig_curve_at(const float y[const DIG_CURVE_POINTS], const double place)
{
    assert(y != NULL);
    const double last = DIG_CURVE_POINTS - 1;
    const double at   = !(place > 0.0) ? 0.0 : place < last ? place : last;
    const size_t k    = at < last ? (size_t)at : DIG_CURVE_POINTS - 2;
    const double f    = at - (double)k;
    return (1.0 - f) * (double)y[k] + f * (double)y[k + 1];
}

static double coordinate(const enum dig_axis axis, const double value)
{
    return axis == DIG_AXIS_DENSITY_kgpm3 ? log(value) : value;
}

double dig_axis_position(const struct dig_curve_set *const set, const enum dig_axis axis,
                         const double value)
{
    const size_t count = set->axis_count[axis];
    if (count < 2) {
        return 0.0;
    }
    const double first = coordinate(axis, set->axis[axis][0]);
    const double last  = coordinate(axis, set->axis[axis][count - 1]);
    return (coordinate(axis, value) - first) / (last - first);
}

double dig_axis_value(const struct dig_curve_set *const set, const enum dig_axis axis,
                      const double position)
{
    const size_t count = set->axis_count[axis];
    if (count < 2) {
        return set->axis[axis][0];
    }
    const double first = coordinate(axis, set->axis[axis][0]);
    const double last  = coordinate(axis, set->axis[axis][count - 1]);
    const double at    = first + position * (last - first);
    return axis == DIG_AXIS_DENSITY_kgpm3 ? exp(at) : at;
}

enum dig_status dig_axis_locate(const struct dig_curve_set *const set, const enum dig_axis axis,
                                const double value, struct dig_axis_interval *const place)
{
    assert(set != NULL && place != NULL);
    const size_t count = set->axis_count[axis];
    if (count == 0) {
        return DIG_ENOMATCH;
    }
    const double *const at       = set->axis[axis];
    const double        position = dig_axis_position(set, axis, value);
    const double        off_only = fabs(value - at[0]); // of an axis with one point
    if (!isfinite(value) || !(position >= -edge && position <= 1.0 + edge) ||
        (count < 2 && off_only > edge * fmax(1.0, fabs(at[0])))) {
        return DIG_ENOMATCH;
    }

    size_t i = 0;
    while (i + 2 < count && at[i + 1] <= value) {
        i++;
    }
    double f = 0.0;
    if (count > 1) {
        const double low  = coordinate(axis, at[i]);
        const double high = coordinate(axis, at[i + 1]);
        f                 = (coordinate(axis, value) - low) / (high - low);
        f                 = f < edge ? 0.0 : f;
        f                 = f > 1.0 - edge ? 1.0 : f;
    }
    *place = (struct dig_axis_interval){ .index = i, .fraction = f };
    return DIG_OK;
}

enum dig_status dig_cell_at(const struct dig_curve_set *const set,
                            const struct dig_axis_interval    place[const DIG_AXES],
                            const size_t trajectory, struct dig_cell *const cell)
{
    assert(set != NULL && place != NULL && cell != NULL && trajectory < set->trajectories);
    struct dig_cell found = { .corners = 0 };
    for (unsigned corner = 0; corner < DIG_CELL_CORNERS; corner++) {
        double weight = 1.0;
        size_t at     = 0;
        for (unsigned a = 0; a < DIG_AXES; a++) {
            const bool upper = ((corner >> a) & 1U) != 0;
            weight *= upper ? place[a].fraction : 1.0 - place[a].fraction;
            at = at * set->axis_count[a] + place[a].index + (upper ? 1 : 0);
        }
        if (!(weight > 0.0)) {
            continue;
        }
        const int entry = set->cell[at];
        if (entry < 0) {
            return DIG_ENOMATCH;
        }
        const size_t slot = (size_t)entry * set->trajectories + trajectory;
        if (set->packings[slot] <= 0) {
            return DIG_ENOMATCH;
        }
        found.curve[found.corners]  = &set->curve[slot];
        found.weight[found.corners] = weight;
        found.inverse_packings += weight / (double)set->packings[slot];
        for (int c = 0; c < DIG_CHANNELS; c++) {
            const double error = (double)set->curve[slot].error[c];
            found.error2[c] += weight * error * error;
        }
        found.mean_variance += weight * weight / (double)set->packings[slot];
        found.corners++;
    }
    *cell = found;
    return DIG_OK;
}

enum dig_status dig_cell_find(const struct dig_curve_set *const set,
                              const struct dig_gravel *const gravel, const size_t trajectory,
                              struct dig_cell *const cell)
{
    assert(set != NULL && gravel != NULL && cell != NULL);
    struct dig_axis_interval place[DIG_AXES];
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_status status =
            dig_axis_locate(set, (enum dig_axis)a, gravel->value[a], &place[a]);
        if (status != DIG_OK) {
            return status;
        }
    }
    return dig_cell_at(set, place, trajectory, cell);
}

struct dig_cell dig_cell_of_entry(const struct dig_curve_set *const set, const size_t slot)
{
    assert(set != NULL && set->packings[slot] > 0);
    struct dig_cell cell = { .corners          = 1,
                             .curve            = { &set->curve[slot] },
                             .weight           = { 1.0 },
                             .inverse_packings = 1.0 / (double)set->packings[slot],
                             .mean_variance    = 1.0 / (double)set->packings[slot] };
    for (int c = 0; c < DIG_CHANNELS; c++) {
        const double error = (double)set->curve[slot].error[c];
        cell.error2[c]     = error * error;
    }
    return cell;
}

void dig_cell_curve(const struct dig_cell *const cell, struct dig_curve *const curve)
{
    assert(cell != NULL && curve != NULL);
    for (int c = 0; c < DIG_CHANNELS; c++) {
        curve->error[c] = (float)sqrt(cell->error2[c]);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[c][k] = (float)dig_cell_mean(cell, (enum dig_channel)c, k);
            curve->sd[c][k]   = (float)dig_cell_sd(cell, (enum dig_channel)c, k);
        }
    }
}

void dig_cell_blend(const struct dig_cell *const cell, const enum dig_channel channel,
                    double mean[DIG_CURVE_POINTS], double sd[DIG_CURVE_POINTS])
{
    assert(cell != NULL && mean != NULL && sd != NULL);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        mean[k] = 0.0;
        sd[k]   = 0.0;
    }
    for (size_t c = 0; c < cell->corners; c++) {
        const float *const its_mean = cell->curve[c]->mean[channel];
        const float *const its_sd   = cell->curve[c]->sd[channel];
        const double       weight   = cell->weight[c];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            mean[k] += weight * (double)its_mean[k];
        }
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sd[k] += weight * (double)its_sd[k];
        }
    }
}
