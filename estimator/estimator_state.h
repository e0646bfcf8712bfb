// The estimator's state and what its sources share. For estimator/, and for placing one statically.

#ifndef DIG_ESTIMATOR_ESTIMATOR_STATE_H
#define DIG_ESTIMATOR_ESTIMATOR_STATE_H

#include "estimator/estimator.h"
#include "estimator/track/motion.h"
#include "estimator/track/phase.h"
#include "estimator/track/recorded_dig.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/statics.h"

/// The causal filter of the rates: angles of a joint over a quarter second, as friction and inertia
/// ask for (docs/numerics/estimator.md); a rig's pose over a tenth, as its path is measured better.
#define DIG_JOINT_RATES_s  0.25
#define DIG_SENSED_RATES_s 0.1

struct dig_estimator {
    // fixed at start
    const struct dig_machine     *machine;
    const struct dig_curve_set   *set;
    struct dig_estimator_settings settings;
    double                        lambda;
    struct dig_corrected_machine  corrected; // the machine as a model corrects it

    struct dig_rates_filter rates; // of the joints; of a rig's pose
    double inertia_Nm;             // what the masses may add to My, 1 sigma; 0 by a force sensor

    // of the sample before
    bool    started;
    int64_t last_ns;

    // of the dig in progress
    struct dig_phase_state   phase;
    struct dig_motion_state  motion;
    struct dig_recorded_dig *recording; // its samples and path
    // Routes and tracks: as the table has them, and in the world's frame, of a machine pitched at
    // contact, as its own has them. The first routes are fixed at start.
    struct {
        struct dig_route    route[DIG_TRAJECTORY_MAX];
        struct dig_follower follower[DIG_TRAJECTORY_MAX];
    } frame[2];
    size_t            frames;        // 2: pitched
    size_t            next_follower; // the one to be refined next
    struct dig_choice choice;        // the trajectory
    double            progress;
    double            off_path_m;

    // of finished digs
    uint32_t                   digs;
    struct dig_recorded_dig   *spare;    // for the next dig; NULL: none
    struct dig_recorded_dig   *finished; // to be taken; NULL: none
    uint32_t                   lost;
    const struct dig_forecast *forecast; // NULL: none

    struct dig_recorded_dig own[2]; // the first to record in
};

/// Drops the dig in progress and waits for contact.
void dig_estimator_clear_dig(struct dig_estimator *estimator);

/// The frame in which the dig so far lies nearer a trajectory.
size_t dig_estimator_frame(const struct dig_estimator *estimator, size_t trajectory);

/// Solves the wrench of a sample and places the front. Steps the filter of the rates. DIG_ESTALE,
/// DIG_EINVAL as dig_estimator_step().
DIG_MUST_CHECK enum dig_status dig_estimator_solve(struct dig_estimator    *estimator,
                                                   const struct dig_sample *sample,
                                                   struct dig_wrench       *wrench,
                                                   struct dig_front        *front);

#endif // DIG_ESTIMATOR_ESTIMATOR_STATE_H
