// The tick: what happens at every beat of the real-time thread. Takes the readings that came,
// assembles samples, steps the estimator, hands on what came out. Everything it touches is a plain
// struct or a lock-free handoff: no allocation, lock, log or system call but the sleep between
// ticks (reading the clock is a vDSO call).

#ifndef DIG_FIRMWARE_HOST_LOOP_H
#define DIG_FIRMWARE_HOST_LOOP_H

#include "estimator/estimator.h"
#include "firmware_host/assemble.h"
#include "firmware_host/handoff.h"

#include <stdatomic.h>

/// A sample, and what was made of it.
struct dig_record {
    struct dig_sample   sample;
    bool                has_estimate;
    struct dig_estimate estimate;
};

/// A prediction, and how far it is good.
struct dig_outlook {
    struct dig_prediction prediction;
    int64_t               time_ns;    // of the estimate it was made from
    int64_t               expires_ns; // CLOCK_MONOTONIC
    uint32_t              dig_count;  // of the dig whose gravel it assumes
};

/// What the tick knows of itself, for HEALTH.
struct dig_pulse {
    int64_t          time_ns; // CLOCK_MONOTONIC
    int64_t          ticks, overruns, missing;
    double           worst_tick_us;
    struct dig_drops drops;
    int64_t          lost; // records and digs for which a ring had no room
    uint32_t         digs;
    bool             fresh; // a complete sample came within stale_s
};

/// Where the tick's input comes from and its output goes to; the rings' other ends are other
/// threads'.
struct dig_loop_ports {
    struct dig_ring   *readings; // in:  struct dig_reading
    struct dig_latest *match;    // in:  struct dig_match
    struct dig_ring   *records;  // out: struct dig_record
    struct dig_ring   *digs;     // out: struct dig_observation
    struct dig_latest *outlook;  // out: struct dig_outlook
    struct dig_latest *pulse;    // out: struct dig_pulse
};

struct dig_loop_settings {
    struct dig_assembler_settings assembler;
    double                        tick_s;
    double                        stale_s;      // wall time
    double                        prediction_s; // between predictions, wall time
    double                        ahead_s;      // between whole predictions in the air, wall time
    int                           trajectories; // of the table: each is predicted ahead in turn
};

struct dig_loop {
    struct dig_loop_settings settings;
    struct dig_loop_ports    ports;
    struct dig_estimator    *estimator;
    struct dig_assembler     assembler;
    struct dig_pulse         pulse;
    struct dig_estimate      estimate; // the last one
    struct dig_observation   observation;
    struct dig_outlook       outlook;
    uint32_t                 match_dig;
    int64_t                  sampled_ns;   // when the last complete sample was taken; 0: never
    int64_t                  predicted_ns; // when the last prediction was made
    bool                     predicting;   // the last one handed on was valid
    int64_t                  ahead_ns;     // when the last whole prediction was made
    int                      ahead;        // the trajectory it was for
};

/// The estimator must be initialised and outlive the loop.
void dig_loop_init(struct dig_loop *loop, const struct dig_loop_settings *settings,
                   const struct dig_loop_ports *ports, struct dig_estimator *estimator);

/// One tick at now_ns (CLOCK_MONOTONIC). At most DIG_READINGS_PER_TICK readings are taken.
#define DIG_READINGS_PER_TICK 256
void dig_loop_tick(struct dig_loop *loop, int64_t now_ns);

/// Ticks at absolute deadlines until *stop. A tick that begins a whole period late is an overrun,
/// and the beats missed are skipped, not made up for.
void dig_loop_run(struct dig_loop *loop, const atomic_bool *stop);

#endif // DIG_FIRMWARE_HOST_LOOP_H
