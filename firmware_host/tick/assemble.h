// Assembles samples from readings: one sample at a time, every needed signal fresh and of the same
// instant.
//
//   pressures   ----o---------o---------o----        A sample is due when every message that
//   carries angles      -o---------o---------o------o        a needed signal has come since the
//   last one. Its
//                          ^ sample at the oldest    time is the oldest of their newest stamps;
//                          what
//                            of the newest           is younger is interpolated between its frames.
//
// Messages may come at different rates and phases. A sample is late by coherent_s at most; messages
// farther apart than that give none. A message's own delay is subtracted from its stamp first.
// Times are scaled to machine time before anything else, so that a bench at double speed looks like
// the machine.
//
// Signals without a message (a machine without pressures of the boom) are missing from every
// sample. Messages of the boom's or arm's pressures alone are dispensable: while one is silent,
// samples go on without it and give the moment.
//
// Dropped and counted are
//   * a needed value that is not available, out of range, NaN, or farther from the last one than
//     max_rate allows in the time between plus 20 ms;
//   * a frame whose own counter stood still or went back (a duplicate, or out of order);
//   * everything while the sender's alive counter stands still longer than frozen_s (a Modbus poll
//     that finds the counter unchanged is a repetition and gives no sample);
//   * samples while the sender's values are stuck (firmware_host/bus/stuck.h).
// Frames that did not come are detected by their counter, or by the cycle they are due in.

#ifndef DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H
#define DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H

#include "core/sample.h"
#include "firmware_host/bus/frame_watch.h"
#include "firmware_host/bus/reading.h"
#include "firmware_host/bus/stuck.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_HISTORY 8 // readings stored of each message

struct dig_assembler_settings {
    double   time_scale;             // machine seconds per second; 1 on a machine
    double   coherent_s, frozen_s;   // machine time
    double   optional_s;             // an optional signal older than this is missing; machine time
    double   stuck_s;                // machine time; 0: values may stand
    bool     has_alive;              // a counter is expected
    bool     repeats;                // an unmoved counter in the only group is a repetition (polls)
    unsigned groups;                 // readings' groups are below this
    bool     needed[DIG_GROUPS_MAX]; // groups that carry needed signals
    bool     dispensable[DIG_GROUPS_MAX]; // of them, those the moment does not need
    struct dig_frame_settings frame[DIG_GROUPS_MAX];
    double                    max_rate[DIG_SIGNALS]; // SI per second, machine time; 0: any
};

/// Counters of what was dropped, never reset. Of values, only those of needed signals count.
struct dig_drops {
    int64_t nan, not_available, out_of_range, frozen, jump, stuck;
    int64_t repeated;      // frames
    int64_t missed;        // frames
    int64_t without_force; // samples made without a silent group: not dropped
};

/// One message as it came, in machine time.
struct dig_past_reading {
    int64_t time_ns;
    double  value[DIG_SIGNALS];
    bool    valid[DIG_SIGNALS];
};

struct dig_assembler {
    struct dig_assembler_settings settings;
    struct dig_drops              drops;
    struct dig_past_reading       past[DIG_GROUPS_MAX][DIG_HISTORY];
    size_t                        received[DIG_GROUPS_MAX]; // readings of the group, ever
    struct dig_frame_watch        watch[DIG_GROUPS_MAX];
    unsigned                      group_of[DIG_SIGNALS];      // that carries it
    bool                          carried[DIG_SIGNALS];       // by any
    double                        last_valid[DIG_SIGNALS];    // the last value within max_rate
    int64_t                       last_valid_ns[DIG_SIGNALS]; // machine time; 0: none yet
    bool                          fresh[DIG_GROUPS_MAX];      // came since the last sample
    size_t                        lead_readings; // of the first group that is not dispensable, ever
    size_t                        lead_readings_at[DIG_GROUPS_MAX]; // when the group came last
    bool                          silent[DIG_GROUPS_MAX];           // samples go on without it
    struct dig_stuck              stuck;
    int64_t                       first_ns; // of the first reading, as it came
    int64_t                       last_ns;  // of the last sample, machine time
    bool                          started, alive_known, frozen;
    uint64_t                      alive;
    int64_t                       alive_ns; // when the counter moved last, machine time
};

void dig_assembler_init(struct dig_assembler                *assembler,
                        const struct dig_assembler_settings *settings);

/// A dispensable group is silent after this many of its own cycles and of the others', and at least
/// DIG_SILENT_s: one or two late frames are no silence.
#define DIG_SILENT_CYCLES 3
#define DIG_SILENT_s      0.1 // machine time

/// Takes one reading; true when a sample is due, which is then written to *sample. Missing from it
/// are signals without a valid value and those of a silent group. Constant time.
bool dig_assembler_take(struct dig_assembler *assembler, const struct dig_reading *reading,
                        struct dig_sample *sample);

#endif // DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H
