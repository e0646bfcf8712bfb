#include "closed_loop/model/approach_change.h"

#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/approached.h"
#include "estimator/approach/approaches.h"
#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SHALLOWEST, DEEPEST, SLOTS };

// Only means are asked for, not what they err by.
static const struct dig_approach_error no_error[DIG_TRAJECTORY_MAX];

// A gravel's plain dig, and the shallowest, the deepest and one at an approach.
struct digs {
    void           *memory; // of the three
    struct dig_cell plain, at[SLOTS + 1];
};

// DIG_ENOMATCH: the table has none of that gravel, nor of the nearest to it within its grid.
static enum dig_status make(const struct dig_curve_set *const set, const size_t trajectory,
                            const struct dig_gravel *const   gravel,
                            const struct dig_approach *const approach, struct digs *const digs)
{
    const struct dig_depths          depths = dig_approach_depths(set, trajectory);
    struct dig_gravel                within = *gravel;
    const struct dig_approached_slot slot[] = {
        [SHALLOWEST] = { trajectory, { depths.least, 0.0 }, 1.0, &digs->plain },
        [DEEPEST]    = { trajectory, { depths.most, 0.0 }, 1.0, &digs->plain },
        [SLOTS]      = { trajectory, *approach, 1.0, &digs->plain }
    };
    digs->memory = NULL;
    for (int a = 0; a < DIG_AXES; a++) {
        within.value[a] =
            fmin(fmax(within.value[a], set->axis[a][0]), set->axis[a][set->axis_count[a] - 1]);
    }
    enum dig_status status = dig_cell_find(set, &within, trajectory, &digs->plain);
    if (status != DIG_OK) {
        return status;
    }
    digs->memory = malloc(dig_approached_size(set, SLOTS + 1));
    if (digs->memory == NULL) {
        return DIG_ENOMEM;
    }
    const struct dig_curve_set *const at =
        dig_approached_make(set, SLOTS + 1, slot, no_error, digs->memory);
    for (size_t i = 0; i <= SLOTS && status == DIG_OK; i++) {
        status = dig_cell_find(at, &within, i, &digs->at[i]);
    }
    return status;
}

// A cell's features.
static void features_in(const struct dig_cell *const cell, double feature[DIG_FEATURES])
{
    memset(feature, 0, DIG_FEATURES * sizeof feature[0]);
    for (size_t i = 0; i < cell->corners; i++) {
        double corner[DIG_FEATURES];
        dig_features_of_table(cell->curve[i]->mean, corner);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += cell->weight[i] * corner[f];
        }
    }
}

// Adds one gravel's change from the shallowest to the deepest, over its plain dig's size.
static enum dig_status add_change(const struct dig_curve_set *const set, const size_t trajectory,
                                  const struct dig_gravel *const gravel, double sum[DIG_FEATURES])
{
    const struct dig_approach level = dig_approach_plain();
    struct digs               digs;
    const enum dig_status     status = make(set, trajectory, gravel, &level, &digs);
    if (status == DIG_OK) {
        double plain[DIG_FEATURES];
        double shallow[DIG_FEATURES];
        double deep[DIG_FEATURES];
        double amplitude[DIG_FORCE_CHANNELS];
        features_in(&digs.plain, plain);
        features_in(&digs.at[SHALLOWEST], shallow);
        features_in(&digs.at[DEEPEST], deep);
        dig_features_amplitude(plain, NULL, amplitude);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            sum[f] += (deep[f] - shallow[f]) / amplitude[f / DIG_FEATURE_BINS];
        }
    }
    free(digs.memory);
    return status;
}

enum dig_status dig_depth_change(const struct dig_curve_set *const set, const size_t trajectory,
                                 const struct dig_gravel *const gravel, double change[DIG_FEATURES])
{
    assert(set != NULL && trajectory < set->trajectories && change != NULL);
    memset(change, 0, DIG_FEATURES * sizeof change[0]);
    const struct dig_depths depths = dig_approach_depths(set, trajectory);
    if (!dig_approach_varies(set, trajectory) || !(depths.most > depths.least)) {
        return DIG_OK;
    }
    enum dig_status status =
        gravel != NULL ? add_change(set, trajectory, gravel, change) : DIG_ENOMATCH;
    double gravels = status == DIG_OK ? 1.0 : 0.0;
    for (size_t e = 0; e < set->entries && status == DIG_ENOMATCH; e++) {
        const enum dig_status other = add_change(set, trajectory, &set->gravel[e], change);
        gravels += other == DIG_OK ? 1.0 : 0.0;
        status = other == DIG_ENOMEM ? other : status;
    }
    // 1 sigma of what is as likely everywhere between two ends.
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        change[f] /= fmax(gravels, 1.0) * sqrt(12.0);
    }
    return status == DIG_ENOMEM ? status : DIG_OK;
}

// What the means of its few beds make the change uncertain by. Gravels that borrow it from several
// are taken for no better.
static double noise_of(const struct dig_curve_set *const set, const size_t trajectory,
                       const struct dig_approach *const approach)
{
    for (size_t e = 0; e < set->entries; e++) {
        struct dig_nodes nodes;
        double           weight[DIG_NODES_MAX];
        dig_nodes_of(set, e, trajectory, &nodes);
        if (nodes.nodes > 1 && dig_approach_weigh(&nodes, approach, weight)) {
            double noise = pow(1.0 - weight[0], 2.0) / nodes.packings[0];
            for (size_t n = 1; n < nodes.nodes; n++) {
                noise += weight[n] * weight[n] / nodes.packings[n];
            }
            return noise;
        }
    }
    return 0.0;
}

// By how much a dig grows with its depth, at each point: from the shallowest to the deepest that
// the table was dug at.
static void add_deeper(const struct dig_cell cell[SLOTS], const double range,
                       const double deeper[const DIG_CURVE_POINTS], struct dig_added *const added)
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double by = deeper[k] *
                              (dig_cell_mean(&cell[DEEPEST], (enum dig_channel)c, k) -
                               dig_cell_mean(&cell[SHALLOWEST], (enum dig_channel)c, k)) /
                              range;
            added->value[c][k] += by;
            added->error[c][k] += DIG_PATH_ERROR * by;
        }
    }
}

static double mean_square(const double deeper[const DIG_CURVE_POINTS])
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += deeper[k] * deeper[k] / DIG_CURVE_POINTS;
    }
    return sum;
}

enum dig_status dig_approach_added(const struct dig_curve_set *const set, const size_t trajectory,
                                   const struct dig_gravel *const   gravel,
                                   const struct dig_approach *const approach,
                                   const double                     deeper[const DIG_CURVE_POINTS],
                                   struct dig_added *const          added)
{
    assert(set != NULL && trajectory < set->trajectories && gravel != NULL && added != NULL);
    memset(added, 0, sizeof *added);
    if (!dig_approach_varies(set, trajectory)) {
        return DIG_OK;
    }
    const struct dig_depths depths = dig_approach_depths(set, trajectory);
    const double            range  = depths.most - depths.least;
    struct dig_approach     reached;
    struct digs             digs;
    (void)dig_approach_clamp(set, trajectory, approach, &reached);
    const enum dig_status status = make(set, trajectory, gravel, &reached, &digs);
    if (status == DIG_OK) {
        added->noise = noise_of(set, trajectory, &reached);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                added->value[c][k] = dig_cell_mean(&digs.at[SLOTS], (enum dig_channel)c, k) -
                                     dig_cell_mean(&digs.plain, (enum dig_channel)c, k);
                added->error[c][k] = DIG_APPROACH_ERROR * added->value[c][k];
            }
        }
        if (deeper != NULL && range > 0.0) {
            add_deeper(digs.at, range, deeper, added);
            added->noise +=
                mean_square(deeper) / (range * range) *
                (noise_of(set, trajectory, &(struct dig_approach){ depths.least, 0.0 }) +
                 noise_of(set, trajectory, &(struct dig_approach){ depths.most, 0.0 }));
        }
    }
    free(digs.memory);
    return status == DIG_ENOMEM ? status : DIG_OK;
}
