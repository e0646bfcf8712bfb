// A table of the tests' own: a smooth family of curves over the rig's three trajectories, known in
// closed form, so that every answer of the matcher can be checked.

#ifndef DIG_TESTS_MADE_TABLE_H
#define DIG_TESTS_MADE_TABLE_H

#include "core/curve.h"
#include "core/observation.h"
#include "estimator/estimator.h"

enum made_trajectory { MADE_SIMPLE_A, MADE_SIMPLE_B, MADE_ACTUAL, MADE_TRAJECTORIES };

/// The rig's trajectory, numbers of the reference scene; tooth 0.09 m.
struct dig_trajectory made_trajectory(enum made_trajectory which);

/// Moment of one gravel at one progress. Friction sets the height, rolling friction a hump late in
/// the dig, density scales all; with family > 0 friction and rolling friction act as one.
double made_moment_Nm(const struct dig_gravel *gravel, enum made_trajectory which, double progress,
                      double family);

struct made_options {
    double family;      // 0: all axes can be told apart; 1: friction and rolling cannot
    double relative_sd; // of one dig
    int    packings;
    bool   hole;        // the entry at friction index 1, rolling 1, density 1 is missing
    bool   one_density; // a single point on the density axis
};

/// 4 x 4 x 3 points (or x 1). Owned by the caller; free with made_table_destroy().
struct dig_curve_set *made_table(const struct made_options *options);
void                  made_table_destroy(struct dig_curve_set *set);

/// What would be observed of a gravel without any error.
struct dig_observation made_observation(const struct dig_gravel *gravel, enum made_trajectory which,
                                        double family);

/// Observes the dig that ended in the estimator's last step; false: none did, or none of the set's.
bool made_observed(struct dig_estimator *estimator, const struct dig_curve_set *set,
                   struct dig_observation *seen);

/// Adds a random error of relative_sd of the moment, correlated over a quarter of a bucket length.
void made_disturb(struct dig_observation *observation, double relative_sd, uint64_t *seed);

#endif // DIG_TESTS_MADE_TABLE_H
