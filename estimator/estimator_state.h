// Inside of the estimator: for estimator/ and for who places one statically. Fixed size.

#ifndef DIG_ESTIMATOR_ESTIMATOR_STATE_H
#define DIG_ESTIMATOR_ESTIMATOR_STATE_H

#include "estimator/estimator.h"
#include "estimator/path.h"
#include "estimator/phase.h"
#include "estimator/route.h"
#include "estimator/track.h"
#include "estimator/window.h"

/// What the gravel given last will resist along one trajectory.
struct dig_outlook {
    bool             valid;
    struct dig_curve curve;
    double           peak_Nm, energy_J; // machine scale
};

struct dig_estimator {
    // fixed at start
    const struct dig_machine     *machine;
    const struct dig_curve_set   *set;
    struct dig_estimator_settings settings;
    double                        lambda;
    struct dig_route              route[DIG_TRAJECTORY_MAX];

    // of the sample before
    bool    started;
    int64_t last_ns;

    // of the dig going on
    struct dig_phase_state phase;
    struct dig_path        path;
    struct dig_follower    follower[DIG_TRAJECTORY_MAX];
    size_t                 next_follower; // the one whose turn it is to be refined
    struct dig_choice      choice;        // the trajectory
    double                 progress;
    double                 off_path_m;
    struct dig_window      window;

    // of digs before
    uint32_t               digs;
    bool                   has_observation;
    struct dig_observation observation;
    struct dig_outlook     outlook[DIG_TRAJECTORY_MAX];
};

#endif // DIG_ESTIMATOR_ESTIMATOR_STATE_H
