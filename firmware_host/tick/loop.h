// The tick: what happens at every beat of the real-time thread. Takes the readings that came,
// assembles samples, steps the estimator, hands on what came out. Everything it touches is a plain
// struct or a lock-free handoff: no allocation, lock, log or system call but the sleep between
// ticks (reading the clock is a vDSO call, and the thread's CPU time one call more).
//
// What takes long is the matcher's: a finished dig leaves as it was recorded, in memory the matcher
// lends; what a gravel will resist with comes back computed. A table, and with it the machine's
// correction, is exchanged between two digs.

#ifndef DIG_FIRMWARE_HOST_TICK_LOOP_H
#define DIG_FIRMWARE_HOST_TICK_LOOP_H

#include "estimator/estimator.h"
#include "estimator/wrench/correction.h"
#include "firmware_host/threads/handoff.h"
#include "firmware_host/tick/assemble.h"

#include <stdatomic.h>

/// A sample, and what was made of it.
struct dig_record {
    struct dig_sample   sample;
    int64_t             arrived_ns; // CLOCK_MONOTONIC stamp of the reading that made it whole
    int64_t             expires_ns; // CLOCK_MONOTONIC
    bool                has_estimate;
    struct dig_estimate estimate;
};

/// Why there is no prediction.
enum dig_why_not {
    DIG_WHY_NOT_VALID,      // there is one
    DIG_WHY_NOT_KNOWN,      // no gravel is known
    DIG_WHY_NOT_EXPIRED,    // it was known once
    DIG_WHY_NOT_STALE,      // no fresh samples
    DIG_WHY_NOT_TRAJECTORY, // which dig it is cannot be told yet
    DIG_WHY_NOT_ON_TABLE,   // it is none of the table's digs
    DIG_WHY_NOT_OVER,       // the dig is over
    DIG_WHY_NOTS
};

/// In words: "no gravel known", "off the table", …; "" for DIG_WHY_NOT_VALID.
const char *dig_why_not_str(enum dig_why_not why);

/// A prediction, and how far it is good.
struct dig_outlook {
    struct dig_prediction prediction;
    enum dig_why_not      why_not;
    bool                  outside;    // the gravel is none of the table's
    int64_t               generation; // of the table
    int64_t               time_ns;    // of the estimate it was made from
    int64_t               expires_ns; // CLOCK_MONOTONIC
    uint32_t              dig_count;  // of the dig whose gravel it assumes
};

/// What the matcher tells the tick: the table that digs are told by, the gravel they are predicted
/// for; with another table, how the machine is taken to be from then on.
struct dig_offer {
    const struct dig_curve_set *set;
    struct dig_taken            machine;
    int64_t                     generation; // of the table, counted from 1
    bool                        known;      // a gravel is
    bool                        outside;    // it is none of the table's
    uint32_t                    dig_count;
    int64_t                     expires_ns; // CLOCK_MONOTONIC after which it is known no longer
    struct dig_forecast         forecast;
};

/// What the tick knows of itself, for HEALTH.
struct dig_pulse {
    int64_t          time_ns; // CLOCK_MONOTONIC
    int64_t          ticks, overruns, missing;
    double           worst_tick_us, worst_tick_cpu_us;
    struct dig_drops drops;
    int64_t          lost, lost_digs; // records and digs for which there was no room
    int64_t          generation;      // of the table in use
    uint32_t         digs;
    bool             fresh; // a sample that tells the moment came within stale_s
};

/// Where the tick's input comes from and its output goes to; the rings' other ends are other
/// threads'.
struct dig_loop_ports {
    struct dig_ring   *readings; // in:  struct dig_reading
    struct dig_latest *offer;    // in:  struct dig_offer of the table in use
    struct dig_latest *table;    // in:  struct dig_offer of another table
    struct dig_ring   *spares;   // in:  struct dig_recorded_dig *, memory for digs
    struct dig_ring   *records;  // out: struct dig_record
    struct dig_ring   *digs;     // out: struct dig_recorded_dig *, finished digs
    struct dig_latest *outlook;  // out: struct dig_outlook
    struct dig_latest *pulse;    // out: struct dig_pulse
    // out: struct dig_estimate, each one, for who looks at the dig going on; what does not fit is
    // dropped, as less is seen then and nothing wrong. NULL: no one does
    struct dig_ring *estimates;
};

struct dig_loop_settings {
    struct dig_assembler_settings assembler;
    double                        tick_s;
    double                        stale_s;      // wall time
    double                        prediction_s; // between predictions, wall time
    double                        ahead_s;      // between whole predictions in the air, wall time
    const struct dig_curve_set   *set;          // each of its digs is predicted ahead in turn
};

struct dig_loop {
    struct dig_loop_settings    settings;
    struct dig_loop_ports       ports;
    struct dig_estimator       *estimator;
    struct dig_assembler        assembler;
    struct dig_pulse            pulse;
    struct dig_estimate         estimate; // the last one
    struct dig_outlook          outlook;
    const struct dig_curve_set *set;
    const struct dig_offer     *offer;        // NULL: none came yet
    int64_t                     sampled_ns;   // when the last complete sample was taken; 0: never
    int64_t                     predicted_ns; // when the last prediction was made
    enum dig_why_not            said;         // of the last one handed on
    int64_t                     ahead_ns;     // when the last whole prediction was made
    int                         ahead;        // the trajectory it was for
    atomic_llong                generation;   // of the table in use, for other threads
};

/// The estimator must be initialised and outlive the loop.
void dig_loop_init(struct dig_loop *loop, const struct dig_loop_settings *settings,
                   const struct dig_loop_ports *ports, struct dig_estimator *estimator);

/// One tick at now_ns (CLOCK_MONOTONIC). At most DIG_READINGS_PER_TICK readings are taken.
#define DIG_READINGS_PER_TICK 256
void dig_loop_tick(struct dig_loop *loop, int64_t now_ns);

/// Ticks at absolute deadlines until *stop. A tick that begins a whole period late is an overrun:
/// it is counted, and the beats missed are skipped, not made up for. Readings wait in their ring
/// meanwhile and keep their own time; the next tick takes them.
void dig_loop_run(struct dig_loop *loop, const atomic_bool *stop);

#endif // DIG_FIRMWARE_HOST_TICK_LOOP_H
