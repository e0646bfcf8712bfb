#include "estimator/approach/approach_response.h"

#include "estimator/approach/approaches.h"
#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>

// Gravels nearer than this on axes from 0 to 1 count the same.
static const double near = 0.05;

struct dig_trajectory dig_response_trajectory(const struct dig_curve_set *const set,
                                              const size_t                      trajectory,
                                              const struct dig_approach *const  approach)
{
    struct dig_trajectory dug = set->trajectory[trajectory];
    if (set->approaches != NULL) {
        struct dig_trajectory made;
        if (dig_approach_apply(&set->trajectory[trajectory], set->tooth_m,
                               set->approaches->depth_m[trajectory], approach, &made,
                               NULL) == DIG_OK) {
            dug = made;
        }
    }
    return dug;
}

// The times of a curve over `dug` as places (0 … DIG_CURVE_POINTS - 1) of one over `other`.
static void warp(const struct dig_trajectory *const dug, const struct dig_trajectory *const other,
                 const double tooth_m, double place[const DIG_CURVE_POINTS])
{
    const double whole_m = dig_trajectory_path_m(other, tooth_m, dig_trajectory_duration_s(other));
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        const double time_s   = dig_trajectory_time_s(dug, tooth_m, progress);
        place[k] = dig_trajectory_path_m(other, tooth_m, time_s) / whole_m * (DIG_CURVE_POINTS - 1);
    }
}

// Adds weight times one node's curves, and the scatter of their mean.
static void add_node(const struct dig_curve *const curve, const double weight, const int packings,
                     const double               place[const DIG_CURVE_POINTS],
                     struct dig_response *const response)
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        double scatter2 = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double sd = dig_curve_at(curve->sd[c], place[k]);
            response->change[c][k] += weight * dig_curve_at(curve->mean[c], place[k]);
            scatter2 += sd * sd;
        }
        response->scatter2[c] += weight * weight * scatter2 / (DIG_CURVE_POINTS * (double)packings);
    }
}

bool dig_response_own(const struct dig_curve_set *const set, const size_t entry,
                      const size_t trajectory, const struct dig_approach *const approach,
                      const struct dig_approach *const along, struct dig_response *const response)
{
    assert(set != NULL && approach != NULL && response != NULL);
    struct dig_nodes nodes;
    double           weight[DIG_NODES_MAX];
    dig_nodes_of(set, entry, trajectory, &nodes);
    if (!dig_approach_weigh(&nodes, approach, weight)) {
        return false;
    }
    const struct dig_trajectory dug  = dig_response_trajectory(set, trajectory, along);
    struct dig_response         made = { .inverse_packings = 0.0 };
    double                      place[DIG_CURVE_POINTS];
    for (size_t i = 0; i < nodes.nodes; i++) {
        if (i > 0 && !(fabs(weight[i]) > 0.0)) {
            continue;
        }
        const struct dig_trajectory other =
            dig_response_trajectory(set, trajectory, &nodes.approach[i]);
        warp(&dug, &other, set->tooth_m, place);
        for (size_t k = 0; i == 0 && k < DIG_CURVE_POINTS; k++) {
            for (int c = 0; c < DIG_CHANNELS; c++) {
                made.plain[c][k] = dig_curve_at(nodes.curve[0]->mean[c], place[k]);
            }
        }
        // The change is against the plain curve, which is one of the nodes itself.
        add_node(nodes.curve[i], weight[i] - (i == 0 ? 1.0 : 0.0), nodes.packings[i], place, &made);
        made.inverse_packings += weight[i] * weight[i] / (double)nodes.packings[i];
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        made.rms[c]        = sqrt(dig_curve_mean_square(nodes.curve[0]->mean[c]));
        const double scale = made.rms[c] > 0.0 ? 1.0 / made.rms[c] : 0.0;
        made.scatter2[c] *= scale * scale;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            made.change[c][k] *= scale;
        }
    }
    *response = made;
    return true;
}

static double distance2(const struct dig_curve_set *const set, const size_t a, const size_t b)
{
    double sum = 0.0;
    for (int axis = 0; axis < DIG_AXES; axis++) {
        const enum dig_axis x   = (enum dig_axis)axis;
        const double        off = dig_axis_position(set, x, set->gravel[a].value[x]) -
                           dig_axis_position(set, x, set->gravel[b].value[x]);
        sum += off * off;
    }
    return sum;
}

bool dig_response_borrowed(const struct dig_curve_set *const set, const size_t entry,
                           const size_t trajectory, const struct dig_approach *const approach,
                           const struct dig_response *const own[],
                           struct dig_response *const       response)
{
    assert(set != NULL && approach != NULL && response != NULL);
    const size_t                  slot   = entry * set->trajectories + trajectory;
    const struct dig_curve *const itself = &set->curve[slot];
    struct dig_response           one;
    double                        whole = 0.0;
    if (set->packings[slot] <= 0) {
        return false;
    }
    // Its own plain curve, at the times of the trajectory dug so.
    struct dig_response         made = { .inverse_packings = 1.0 / (double)set->packings[slot] };
    const struct dig_trajectory dug  = dig_response_trajectory(set, trajectory, approach);
    double                      place[DIG_CURVE_POINTS];
    warp(&dug, &set->trajectory[trajectory], set->tooth_m, place);
    for (int c = 0; c < DIG_CHANNELS; c++) {
        made.rms[c] = sqrt(dig_curve_mean_square(itself->mean[c]));
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            made.plain[c][k] = dig_curve_at(itself->mean[c], place[k]);
        }
    }
    for (size_t e = 0; e < set->entries; e++) {
        const struct dig_response *lent = own != NULL ? own[e] : NULL;
        if (own == NULL && dig_response_own(set, e, trajectory, approach, approach, &one)) {
            lent = &one;
        }
        if (e == entry || lent == NULL) {
            continue;
        }
        const double weight = 1.0 / (distance2(set, entry, e) + near * near);
        whole += weight;
        for (int c = 0; c < DIG_CHANNELS; c++) {
            made.scatter2[c] += weight * weight * lent->scatter2[c];
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                made.change[c][k] += weight * lent->change[c][k];
            }
        }
    }
    if (!(whole > 0.0)) {
        return false;
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        made.scatter2[c] /= whole * whole;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            made.change[c][k] /= whole;
        }
    }
    *response = made;
    return true;
}
