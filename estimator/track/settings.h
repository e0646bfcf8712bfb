// Settings of the estimator: a plain struct with defaults and a check.

#ifndef DIG_ESTIMATOR_TRACK_SETTINGS_H
#define DIG_ESTIMATOR_TRACK_SETTINGS_H

#include <stdbool.h>

#define DIG_TICK_MOST_s 0.1

struct dig_estimator_settings {
    // fixed at start
    double tick_s;         // nominal time between samples, at most DIG_TICK_MOST_s
    double contact_sigmas; // My above this many sigma, sustained, is contact (phase.h)
    double contact_hold_s; // how long it must last
    double exit_hold_s;    // how long it must be gone
    double air_bias_s;     // time constant of the bias of My learnt in free air; 0: off
    double path_limit_m;   // rig scale: farther than this off every trajectory: not known
    double outside_floors; // distance > this many noise floors: gravel outside the table
};

struct dig_estimator_settings dig_estimator_settings_default(void);

/// False where a number is none or out of its range.
bool dig_estimator_settings_ok(const struct dig_estimator_settings *settings);

#endif // DIG_ESTIMATOR_TRACK_SETTINGS_H
