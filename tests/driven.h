// Digs driven through an estimator: a machine of the tests' own moves its bucket along a trajectory
// of the made table, the soil resists as the table's family of curves has it, and the estimator
// sees nothing but pressures and angles.

#ifndef DIG_TESTS_DRIVEN_H
#define DIG_TESTS_DRIVEN_H

#include "estimator/approach/live_recording.h"
#include "estimator/estimator.h"
#include "tests/made_table.h"

static const double driven_lambda = 10.0; // machine over rig

/// How often, and at what progress, a dig is looked at while it goes on.
#define DRIVEN_LOOKS 4
extern const double driven_look_at[DRIVEN_LOOKS];

/// How a dig is driven.
struct drive {
    enum made_trajectory which;
    double               stretch; // 2: half as fast as Froude has it
    double               pause_s; // machine time stood still at 45 % of the way
    double   back_s;   // rig time driven backwards at 60 % of the way, then again forwards
    double   until;    // progress at which the bucket is lifted out
    double   carry_Nm; // moment of the load afterwards
    double   drop;     // share of samples that arrive incomplete
    bool     sensors;  // the ZX200's steps and noise
    uint64_t seed;
};

/// One machine, one table, one estimator, and the digs driven through it.
struct driven {
    struct dig_machine            machine;
    struct dig_curve_set         *set;
    struct dig_estimator         *estimator;
    bool                          keeps; // does not give a finished dig back
    double                        time_s;
    const volatile unsigned long *allocations; // of this thread; NULL: nobody counts
    size_t                        observations, steps_with_allocation;
    struct dig_live_recording    *live; // NULL: none follows
    struct dig_observation        observation;
    bool                gave_up;    // of the raw dig taken last, when nothing was told of it:
    int                 gave_up_of; // the trajectory, and where
    double              gave_up_at;
    struct dig_estimate estimate;
    // of the dig driven last
    struct dig_observation early[DRIVEN_LOOKS]; // what the live saw; trajectory -1: nothing
    int                    earlies;
    int                    known_at_end;   // trajectory as it was told just before the end
    double                 known_from;     // true progress from which on it was told, and rightly
    double                 worst_progress; // largest error of progress from then on
    size_t                 predictions;
    double                 worst_prediction; // largest relative error ahead of the bucket
};

/// sensors: those of the ZX200 in steps and noise, or perfect ones. Free with driven_destroy().
struct driven *driven_create(bool sensors);
void           driven_destroy(struct driven *driven);

/// The moment of the soil at machine scale: a gravel between the points of the table.
double driven_moment_Nm(enum made_trajectory which, double progress);

/// One tick with the bucket at a rig pose, shifted up out of the ground, with the soil's moment at
/// machine scale; drop is the chance that the sample comes incomplete, which must be refused.
void driven_tick(struct driven *driven, struct dig_pose pose, double up_m, double moment_Nm,
                 double drop, uint64_t *seed);

/// A whole dig: down through the air, along the trajectory, up, and the load dropped. Notes how the
/// trajectory, the progress and the prediction of each tick compare with what was driven.
void driven_dig(struct driven *driven, struct drive drive);

/// Relative distance of the observation from the moment driven, as the paper smooths it, over the
/// points measured, up to until. The pace of the dig plays no part.
double driven_error(const struct driven *driven, double until);

#endif // DIG_TESTS_DRIVEN_H
