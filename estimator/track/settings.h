// Settings of the estimator: a plain struct with defaults and a check.

#ifndef DIG_ESTIMATOR_TRACK_SETTINGS_H
#define DIG_ESTIMATOR_TRACK_SETTINGS_H

#include "core/status.h"

struct dig_estimator_settings {
    // fixed at start
    double tick_s;         // nominal time between samples
    double contact_sigmas; // My above this many sigma, sustained, is contact (phase.h)
    double contact_hold_s; // how long it must last
    double exit_hold_s;    // how long it must be gone
    double air_bias_s;     // time constant of the bias of My learnt in free air; 0: off
    double path_limit_m;   // rig scale: farther than this off every trajectory: not known
    double outside_floors; // distance > this many noise floors: gravel outside the table
};

struct dig_estimator_settings dig_estimator_settings_default(void);
DIG_MUST_CHECK enum dig_status
dig_estimator_settings_check(const struct dig_estimator_settings *settings, const char **reason);

#endif // DIG_ESTIMATOR_TRACK_SETTINGS_H
