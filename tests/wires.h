// The rings and latest values between the daemon's threads, with their memory: for tests that stand
// at the other ends of the tick or of the matcher.

#ifndef DIG_TESTS_WIRES_H
#define DIG_TESTS_WIRES_H

#include "core/units.h"
#include "firmware_host/handoff_memory.h"

#include <math.h>

#define WIRES_LAMBDA 10.0 // the machine is so much larger than the rig

struct wires {
    struct dig_handoffs       handoffs;
    struct dig_handoff_memory memory;
    atomic_llong              tick_generation, publisher_generation; // of the table in use there
};

/// All of them empty, the first table in use. They stay where they are.
static inline void wires_init(struct wires *const w)
{
    dig_handoffs_init(&w->handoffs, &w->memory);
    atomic_store(&w->tick_generation, 1);
    atomic_store(&w->publisher_generation, 1);
}

/// A matcher's settings: as by default, but for fewer evaluations.
static inline struct dig_config wires_config(void)
{
    return (struct dig_config){
        .estimator         = dig_estimator_settings_default(),
        .match_evaluations = 300,
        .match_least_path  = 0.6,
        .match_early_path  = 0.3,
        .match_expires_s   = 3600.0,
        .drift_floors      = 3.0,
    };
}

/// What a tick of 5 ms is set to that takes its readings from one source.
static inline struct dig_loop_settings wires_loop_settings(const struct dig_curve_set *const set)
{
    return (struct dig_loop_settings){
        .assembler    = { .time_scale = 1.0,
                          .coherent_s = 1.0,
                          .optional_s = 1.0,
                          .groups     = 1,
                          .needed     = { true } },
        .tick_s       = 0.005,
        .stale_s      = 0.1,
        .prediction_s = 0.05,
        .next_dig_s   = 0.5,
        .set          = set,
    };
}

/// A matcher between them, at the first table; no dig goes on yet.
static inline void wires_init_fit(struct wires *const w, const struct dig_config *const config,
                                  struct dig_curve_set *const   set,
                                  struct dig_early_match *const early, struct dig_fit *const fit)
{
    *fit = (struct dig_fit){
        .config         = config,
        .track_settings = { .expires_s = 3600.0, .drift_floors = 3.0 },
        .handoffs       = &w->handoffs,
        .matcher        = { .tick_generation      = &w->tick_generation,
                            .publisher_generation = &w->publisher_generation },
        .early          = early,
    };
    early->estimates = &w->handoffs.estimates;
    dig_early_match_clear(early, set);
    dig_matcher_exchange(&fit->matcher, set, WIRES_LAMBDA);
}

/// What a tick tells of the bucket at a pose of the rig and of its moment there, with the noise of
/// a machine.
static inline struct dig_estimate wires_estimate(const int64_t time_ns, const struct dig_pose pose,
                                                 const double             moment_Nm,
                                                 const enum dig_dig_phase phase)
{
    const double lambda4 = WIRES_LAMBDA * WIRES_LAMBDA * WIRES_LAMBDA * WIRES_LAMBDA;
    return (struct dig_estimate){
        .time_ns    = time_ns,
        .wrench     = { .My_Nm            = lambda4 * moment_Nm,
                        .sigma_My_Nm      = 100.0,
                        .slow_sigma_My_Nm = 50.0,
                        .moment_valid     = true },
        .pin_X_m    = -WIRES_LAMBDA * pose.x_m,
        .pin_Z_m    = WIRES_LAMBDA * pose.z_m,
        .phi_rad    = -0.5 * DIG_PI - pose.theta_rad,
        .phase      = phase,
        .trajectory = -1,
        .progress   = (double)NAN,
    };
}

#endif // DIG_TESTS_WIRES_H
