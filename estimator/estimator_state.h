// Inside of the estimator: for estimator/ and for who places one statically. Fixed size.

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

struct dig_estimator {
    // fixed at start
    const struct dig_machine     *machine;
    const struct dig_curve_set   *set;
    struct dig_estimator_settings settings;
    double                        lambda;
    struct dig_route              route[DIG_TRAJECTORY_MAX];
    struct dig_corrected_machine  corrected; // the machine as a model corrects it

    // of the last quarter second, while it corrects; of a tenth where a force sensor tells
    struct dig_rates_filter rates;

    // of the sample before
    bool    started;
    int64_t last_ns;

    // of the dig going on
    struct dig_phase_state   phase;
    struct dig_motion_state  motion;
    struct dig_recorded_dig *recording; // its samples and path
    struct dig_follower      follower[DIG_TRAJECTORY_MAX];
    size_t                   next_follower; // the one whose turn it is to be refined
    struct dig_choice        choice;        // the trajectory
    double                   progress;
    double                   off_path_m;

    // of digs before
    uint32_t                   digs;
    bool                       has_observation;
    struct dig_observation     observation;
    bool                       lends;    // digs are handed out raw
    struct dig_recorded_dig   *spare;    // for the next dig; NULL: none
    struct dig_recorded_dig   *finished; // to be taken; NULL: none
    uint32_t                   lost;
    const struct dig_forecast *forecast; // NULL: none

    // where raw and forecast point unless others were lent
    struct dig_recorded_dig own_recording;
    struct dig_forecast     own_forecast;
};

#endif // DIG_ESTIMATOR_ESTIMATOR_STATE_H
