// The tick of the real-time thread: takes readings, assembles samples, steps the estimator,
// publishes the results. All it touches are plain structs and lock-free queues: no allocation,
// lock, log or system call but the sleep between ticks (reading the monotonic clock is a vDSO call,
// the thread's CPU time one call).
//
// What takes long is left to the matching thread. A finished dig leaves as a recording, in memory
// that thread lends; a forecast comes back computed. A table, and with it the machine's correction,
// is exchanged between two digs.

#ifndef DIG_FIRMWARE_HOST_TICK_LOOP_H
#define DIG_FIRMWARE_HOST_TICK_LOOP_H

#include "estimator/estimator.h"
#include "estimator/wrench/correction.h"
#include "firmware_host/threads/handoff.h"
#include "firmware_host/tick/assemble.h"

#include <stdatomic.h>

/// A sample and its estimate.
struct dig_record {
    struct dig_sample   sample;
    int64_t             arrived_ns; // CLOCK_MONOTONIC stamp of the reading that completed it
    int64_t             expires_ns; // CLOCK_MONOTONIC
    bool                has_estimate;
    struct dig_estimate estimate;
};

/// Whether there is a prediction, and why not.
enum dig_prediction_state {
    DIG_PREDICTION_VALID,
    DIG_PREDICTION_NO_GRAVEL,     // no gravel was ever known
    DIG_PREDICTION_EXPIRED,       // none is known any more
    DIG_PREDICTION_STALE,         // no fresh samples
    DIG_PREDICTION_NO_TRAJECTORY, // the trajectory of the dig is not known yet
    DIG_PREDICTION_OFF_TABLE,     // the dig is along no trajectory of the table
    DIG_PREDICTION_DIG_OVER,
    DIG_PREDICTION_STATES
};

/// In words: "no gravel known", "off the table", …; "" for DIG_PREDICTION_VALID.
const char *dig_prediction_state_str(enum dig_prediction_state state);

/// A prediction as it is published.
struct dig_prediction_record {
    struct dig_prediction     prediction;
    enum dig_prediction_state state;
    bool                      outside;    // the gravel is outside the table
    int64_t                   generation; // of the table
    int64_t                   time_ns;    // of the estimate it was made from
    int64_t                   expires_ns; // CLOCK_MONOTONIC
    uint32_t                  dig_count;  // of the dig the gravel was matched from
};

/// What the tick predicts from: table, machine, gravel and forecast, from the matching thread.
struct dig_prediction_basis {
    const struct dig_curve_set  *set;
    struct dig_corrected_machine machine;
    int64_t                      generation; // of the table, counted from 1
    bool                         known;      // a gravel is known
    bool                         outside;    // and it is outside the table
    uint32_t                     dig_count;  // of the dig it was matched from
    int64_t                      expires_ns; // CLOCK_MONOTONIC, of the gravel
    struct dig_forecast          forecast;
};

/// State of the tick, for HEALTH. Counters are never reset.
struct dig_tick_status {
    int64_t          time_ns; // CLOCK_MONOTONIC
    int64_t          ticks, overruns, missing;
    double           worst_tick_us, worst_tick_cpu_us;
    double           worst_late_us; // after its time, the tick that began latest
    struct dig_drops drops;
    int64_t          lost, lost_digs; // records and digs for which there was no room
    int64_t          generation;      // of the table in use
    uint32_t         digs;
    bool             fresh; // a sample that gives the moment came within stale_s
};

struct dig_loop_settings {
    struct dig_assembler_settings assembler;
    double                        tick_s;
    double                        stale_s;      // wall time
    double                        prediction_s; // between predictions of a dig, wall time
    double                        next_dig_s;   // between predictions in the air, wall time
    const struct dig_curve_set   *set;
};

struct dig_loop {
    struct dig_loop_settings           settings;
    struct dig_handoffs               *handoffs;
    struct dig_estimator              *estimator;
    struct dig_assembler               assembler;
    struct dig_tick_status             tick_status;
    const struct dig_curve_set        *set;             // in use
    const struct dig_prediction_basis *basis;           // NULL: none came yet
    struct dig_estimate                estimate;        // the last one
    int64_t                            sampled_ns;      // when it was made; 0: never
    struct dig_prediction_record       published;       // the last one
    enum dig_prediction_state          published_state; // of the last one of a dig
    int64_t                            predicted_ns;    // when that was
    int64_t                            next_dig_ns;     // when a dig was last predicted in the air
    int                                next_dig_trajectory; // the one it was along
    atomic_llong                       generation; // of the table in use, for other threads
};

/// The estimator must be initialised; it and the handoffs outlive the loop.
void dig_loop_init(struct dig_loop *loop, const struct dig_loop_settings *settings,
                   struct dig_handoffs *handoffs, struct dig_estimator *estimator);

/// Readings taken in one tick: many times what a bus brings in one.
#define DIG_READINGS_PER_TICK 256

/// One tick at now_ns (CLOCK_MONOTONIC). At most DIG_READINGS_PER_TICK readings are taken.
void dig_loop_tick(struct dig_loop *loop, int64_t now_ns);

/// Ticks at absolute deadlines until *stop. A tick that begins a whole period late is counted as an
/// overrun; missed ticks are skipped. Readings wait in their ring with their own time stamps.
void dig_loop_run(struct dig_loop *loop, const atomic_bool *stop);

#endif // DIG_FIRMWARE_HOST_TICK_LOOP_H
