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
static void add_change(const struct dig_cell *const plain, const struct dig_cell at[SLOTS],
                       double sum[DIG_FEATURES])
{
    double of_plain[DIG_FEATURES];
    double shallow[DIG_FEATURES];
    double deep[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    features_in(plain, of_plain);
    features_in(&at[SHALLOWEST], shallow);
    features_in(&at[DEEPEST], deep);
    dig_features_amplitude(of_plain, NULL, amplitude);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        sum[f] += (deep[f] - shallow[f]) / amplitude[f / DIG_FEATURE_BINS];
    }
}

// The gravel, or the nearest to it within the grid.
static struct dig_gravel within_grid(const struct dig_curve_set *const set,
                                     const struct dig_gravel *const    gravel)
{
    struct dig_gravel within = *gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        within.value[a] =
            fmin(fmax(within.value[a], set->axis[a][0]), set->axis[a][set->axis_count[a] - 1]);
    }
    return within;
}

// The shallowest and the deepest dig of a trajectory; those that follow are as given.
static void set_ends(const size_t trajectory, const struct dig_depths *const depths,
                     const struct dig_cell *const only, struct dig_approached_slot slot[SLOTS])
{
    slot[SHALLOWEST] =
        (struct dig_approached_slot){ trajectory, { depths->least, 0.0 }, 1.0, only };
    slot[DEEPEST] = (struct dig_approached_slot){ trajectory, { depths->most, 0.0 }, 1.0, only };
}

// The same of the gravel's own cell; false where the table has none.
static bool add_change_of(const struct dig_curve_set *const set, const size_t trajectory,
                          const struct dig_depths *const depths,
                          const struct dig_gravel *const gravel, void *const memory,
                          double sum[DIG_FEATURES])
{
    const struct dig_gravel    within = within_grid(set, gravel);
    struct dig_approached_slot slot[SLOTS];
    struct dig_cell            plain;
    struct dig_cell            cell[SLOTS];
    if (dig_cell_find(set, &within, trajectory, &plain) != DIG_OK) {
        return false;
    }
    set_ends(trajectory, depths, &plain, slot);
    const struct dig_curve_set *const at = dig_approached_make(set, SLOTS, slot, no_error, memory);
    if (dig_cell_find(at, &within, SHALLOWEST, &cell[SHALLOWEST]) != DIG_OK ||
        dig_cell_find(at, &within, DEEPEST, &cell[DEEPEST]) != DIG_OK) {
        return false;
    }
    add_change(&plain, cell, sum);
    return true;
}

// Mean over the entries that have all three.
static void add_mean_change(const struct dig_curve_set *const set, const size_t trajectory,
                            const struct dig_depths *const depths, void *const memory,
                            double sum[DIG_FEATURES])
{
    struct dig_approached_slot ends[SLOTS];
    double                     entries = 0.0;
    set_ends(trajectory, depths, NULL, ends);
    const struct dig_curve_set *const at = dig_approached_make(set, SLOTS, ends, no_error, memory);
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * set->trajectories + trajectory;
        if (set->packings[slot] > 0 && at->packings[e * SLOTS + SHALLOWEST] > 0 &&
            at->packings[e * SLOTS + DEEPEST] > 0) {
            const struct dig_cell plain     = dig_cell_of_entry(set, slot);
            const struct dig_cell of[SLOTS] = { dig_cell_of_entry(at, e * SLOTS + SHALLOWEST),
                                                dig_cell_of_entry(at, e * SLOTS + DEEPEST) };
            add_change(&plain, of, sum);
            entries += 1.0;
        }
    }
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        sum[f] /= fmax(entries, 1.0);
    }
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
    void *const memory = malloc(dig_approached_size(set, SLOTS));
    if (memory == NULL) {
        return DIG_ENOMEM;
    }
    if (gravel == NULL || !add_change_of(set, trajectory, &depths, gravel, memory, change)) {
        add_mean_change(set, trajectory, &depths, memory, change);
    }
    free(memory);
    // 1 sigma of what is as likely everywhere between two ends.
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        change[f] /= sqrt(12.0);
    }
    return DIG_OK;
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
    enum { MADE = SLOTS };
    memset(added, 0, sizeof *added);
    if (!dig_approach_varies(set, trajectory)) {
        return DIG_OK;
    }
    const struct dig_gravel within = within_grid(set, gravel);
    struct dig_cell         plain;
    if (dig_cell_find(set, &within, trajectory, &plain) != DIG_OK) {
        return DIG_OK;
    }
    void *const memory = malloc(dig_approached_size(set, SLOTS + 1));
    if (memory == NULL) {
        return DIG_ENOMEM;
    }
    const struct dig_depths    depths = dig_approach_depths(set, trajectory);
    const double               range  = depths.most - depths.least;
    struct dig_approached_slot slot[SLOTS + 1];
    set_ends(trajectory, &depths, &plain, slot);
    slot[MADE] =
        (struct dig_approached_slot){ .trajectory = trajectory, .over_depth = 1.0, .only = &plain };
    (void)dig_approach_clamp(set, trajectory, approach, &slot[MADE].approach);
    const struct dig_curve_set *const at =
        dig_approached_make(set, SLOTS + 1, slot, no_error, memory);
    struct dig_cell cell[SLOTS + 1];
    enum dig_status status = DIG_OK;
    for (size_t i = 0; i <= SLOTS && status == DIG_OK; i++) {
        status = dig_cell_find(at, &within, i, &cell[i]);
    }
    if (status == DIG_OK) {
        added->noise = noise_of(set, trajectory, &slot[MADE].approach);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                added->value[c][k] = dig_cell_mean(&cell[MADE], (enum dig_channel)c, k) -
                                     dig_cell_mean(&plain, (enum dig_channel)c, k);
                added->error[c][k] = DIG_APPROACH_ERROR * added->value[c][k];
            }
        }
        if (deeper != NULL && range > 0.0) {
            add_deeper(cell, range, deeper, added);
            added->noise += mean_square(deeper) / (range * range) *
                            (noise_of(set, trajectory, &slot[SHALLOWEST].approach) +
                             noise_of(set, trajectory, &slot[DEEPEST].approach));
        }
    }
    free(memory);
    return DIG_OK;
}
