// The digs of a campaign as numbers of equal weight: features over the scatter's own size, so that
// one dig of a known gravel scatters by 1 in every direction, independently.
//
// Per trajectory: y = L^-1 (features / amplitude), L L' the scatter's covariance of the features
// that all digs of the trajectory have. An error that all digs of a trajectory share (of the
// table, of a template, of the DEM) is counted in multiples of the same covariance.

#ifndef DIG_CLOSED_LOOP_FIT_BATCH_H
#define DIG_CLOSED_LOOP_FIT_BATCH_H

#include "closed_loop/model/soil.h"

struct dig_steps; // what is open beside the soil: closed_loop/fit/steps.h

struct dig_group {
    size_t trajectory;
    size_t digs;
    size_t features;
    size_t feature[DIG_FEATURES];              // which, ascending
    double amplitude[DIG_FORCE_CHANNELS];      // of the mean dig, times sqrt(scatter's factor)
    double whiten[DIG_FEATURES][DIG_FEATURES]; // [k][i]: what a unit of feature[k] adds to y[i]
    double mean[DIG_FEATURES];                 // of the digs' y
    double about;                              // sum of squares of the digs' y about the mean
    double log_det;                            // of one dig's covariance relative to amplitude
    double sensor[DIG_FEATURES];               // 1 sigma of the sensors; that holds it
    // Correlated noise, which that covariance holds, too: covariance of a channel's bins per unit
    // variance, and 1 sigma.
    double lasting[DIG_FEATURE_BINS * DIG_FEATURE_BINS];
    double lasting_sigma[DIG_FORCE_CHANNELS];
    double
        repeats; // variance of the mean beyond 1 / digs, as digs repeat beds: dig_same_bed_count()
    // What other approaches add to the mean was subtracted. 1 sigma of its error, units of the
    // table; and variance of the mean, as the table has few beds of them.
    double added_error[DIG_FEATURES];
    double added_noise;
};

struct dig_batch_dig {
    size_t group;
    size_t measured;        // index into the campaign
    double y[DIG_FEATURES]; // [features]
};

struct dig_batch {
    const struct dig_soil     *soil;     // not owned
    const struct dig_scatter  *scatter;  // not owned
    const struct dig_measured *measured; // not owned
    const struct dig_steps    *steps;    // not owned; NULL: none
    size_t                     groups;
    struct dig_group           group[DIG_TRAJECTORY_MAX];
    size_t                     digs;
    struct dig_batch_dig       dig[DIG_MEASURED_MAX];
};

/// Takes the digs that take[] allows, machine effects off. place: about which gravel it is (NULL:
/// not known yet), for the scatter's factor. DIG_ENOMATCH: no dig, or a trajectory of which not
/// half a channel was measured by all digs.
DIG_MUST_CHECK enum dig_status dig_batch_make(const struct dig_soil    *soil,
                                              const struct dig_scatter *scatter, size_t digs,
                                              const struct dig_measured measured[],
                                              const bool take[], const double place[DIG_AXES],
                                              struct dig_batch *batch);

/// Features of a dig, machine effects off.
void dig_batch_features(const struct dig_measured *dig, double feature[DIG_FEATURES]);

/// Writes y of features (units of the table) in a group: the first group->features of it, then 0.
/// Half a microsecond.
void dig_batch_whiten(const struct dig_group *group, const double feature[DIG_FEATURES],
                      double y[DIG_FEATURES]);

/// One dig scatters so many times as much as was thought: every y, of digs and of models, shrinks
/// by it.
void dig_batch_spread(struct dig_batch *batch, double spread);

/// The first dig of a group.
const struct dig_measured *dig_batch_first(const struct dig_batch *batch, size_t group);

/// Recomputes the groups' mean and about after the digs' y were changed.
void dig_batch_summarise(struct dig_batch *batch);

/// The sum of squares of all digs' y about their groups' means.
double dig_batch_about(const struct dig_batch *batch);

/// -2 log likelihood of whitened squares of all digs, but for a constant: the table knows the size
/// of its scatter from so many packings only, so that it is integrated out (Student's
/// distribution); squares, where it is known.
double dig_batch_misfit(const struct dig_batch *batch, double squares);

/// What squares of the means add to that of the digs about them.
double dig_batch_misfit_of_means(const struct dig_batch *batch, double squares);

/// The batch without one of its two or more digs; without its trajectory where that was the only
/// one along it.
void dig_batch_leave_out(const struct dig_batch *batch, size_t dig, struct dig_batch *others);

/// Recordings of one dig in one bed, made anew by a simulation with other noise of the sensors or
/// by a rig that replays it, are one sample of what beds of a gravel do: their mean is no nearer to
/// the gravel's than each of them. How many beds a group's digs are of, 1 … digs. Two digs of
/// different beds are nearer to each other than those that count as one once in a million pairs.
size_t dig_same_bed_count(const struct dig_batch *batch, size_t group);

#endif // DIG_CLOSED_LOOP_FIT_BATCH_H
