// Phase means of moment and force over beds: what digs of two codes are compared by, since single
// digs are chaotic.

#ifndef DIG_TESTS_PHASE_MEANS_H
#define DIG_TESTS_PHASE_MEANS_H

#include "core/curve.h"
#include "core/recording.h"
#include "tables/store.h"

#include <stdbool.h>

#define PHASE_CHANNELS 3 // My, Fx, Fz

extern const char *const phase_channel_name[PHASE_CHANNELS];

/// Sums over beds of a dig's phase means. Zero: no bed yet.
struct phase_means {
    int    beds;
    double sum[DIG_PHASES_MAX][PHASE_CHANNELS];
    double sum2[DIG_PHASES_MAX][PHASE_CHANNELS];
};

/// Adds a run of a table that followed this trajectory.
void phase_means_add_run(struct phase_means *means, const struct dig_trajectory *trajectory,
                         const struct dig_run *run);

/// Adds a dig of this trajectory.
void phase_means_add_recording(struct phase_means *means, const struct dig_trajectory *trajectory,
                               const struct dig_recording *recording);

/// Adds a force recording; false when there is no such file. Fails the test on a bad one.
bool phase_means_add_file(struct phase_means *means, const struct dig_trajectory *trajectory,
                          const char *path);

double phase_means_mean(const struct phase_means *means, size_t phase, int channel);

/// Standard deviation of one bed; needs two.
double phase_means_spread(const struct phase_means *means, size_t phase, int channel);

/// The largest of the trajectory's phase means, by amount.
double phase_means_largest(const struct phase_means *means, const struct dig_trajectory *trajectory,
                           int channel);

#endif // DIG_TESTS_PHASE_MEANS_H
