// The daemon's messages with nothing in them: what LCM needs to encode one, and no more.

#ifndef DIG_TESTS_BLANK_MESSAGES_H
#define DIG_TESTS_BLANK_MESSAGES_H

#include "files/lcm/predicted_curve.h"
#include "messages/digsight_estimate_t.h"
#include "messages/digsight_health_t.h"
#include "messages/digsight_match_t.h"

static char no_text[] = "";

static inline digsight_estimate_t blank_estimate(void)
{
    return (digsight_estimate_t){ .trajectory = no_text, .missing = no_text, .advice = no_text };
}

static inline digsight_match_t blank_match(void)
{
    return (digsight_match_t){ .trajectory      = no_text,
                               .table           = no_text,
                               .wanted          = no_text,
                               .hint_trajectory = no_text,
                               .advice          = no_text,
                               .untold          = no_text };
}

static inline digsight_health_t blank_health(void)
{
    return (digsight_health_t){ .state           = no_text,
                                .input           = no_text,
                                .note            = no_text,
                                .missing_signals = no_text,
                                .table           = no_text,
                                .advice          = no_text };
}

/// A valid one of this trajectory from 0 to 1: moments go evenly from `from_Nm` to `to_Nm`, sigma
/// is the same throughout. moment and sigma must live as long.
static inline digsight_prediction_t blank_prediction(char *const trajectory, const double from_Nm,
                                                     const double to_Nm, const double sigma_Nm,
                                                     double moment[const DIG_PREDICTED_POINTS],
                                                     double sigma[const DIG_PREDICTED_POINTS])
{
    for (int i = 0; i < DIG_PREDICTED_POINTS; i++) {
        moment[i] = from_Nm + (to_Nm - from_Nm) * i / (DIG_PREDICTED_POINTS - 1);
        sigma[i]  = sigma_Nm;
    }
    return (digsight_prediction_t){ .valid           = 1,
                                    .trajectory      = trajectory,
                                    .to_progress     = 1.0,
                                    .points          = DIG_PREDICTED_POINTS,
                                    .moment_Nm       = moment,
                                    .sigma_Nm        = sigma,
                                    .force_x_N       = moment,
                                    .force_z_N       = moment,
                                    .sigma_force_x_N = sigma,
                                    .sigma_force_z_N = sigma,
                                    .reason          = no_text,
                                    .advice          = no_text };
}

#endif // DIG_TESTS_BLANK_MESSAGES_H
