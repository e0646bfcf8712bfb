// From readings as they arrive to samples a wrench can be computed from: one at a time, every
// needed signal fresh and of the same moment.
//
//   pressures   ----o---------o---------o----        a sample is due when every message that
//   carries angles      -o---------o---------o------o        a needed signal has come since the
//   last one; its
//                          ^ sample at the oldest    time is the oldest of their newest stamps, and
//                            of the newest           what is younger is read off between its frames
//
// So messages may come at different rates and phases; a sample is late by coherent_s at most, and
// messages farther apart than that give none. A message's own delay is taken off its stamp first.
// Times are scaled to machine time before anything else, so that a bench served at double speed
// looks like the machine.
//
// Signals that no message carries (a machine without pressures of the boom's) are missing from
// every sample. A message of the boom's or the arm's pressures alone that does not come is done
// without in the same way: the samples go on and tell the moment, until it is back.
//
// What is dropped, and counted:
//   * a needed value that is not available, out of range, NaN, or farther from the last one than
//     max_rate allows in the time between and 20 ms more;
//   * a frame whose own counter stood or went back (a duplicate, or out of order);
//   * everything while the sender's alive counter stands still longer than frozen_s, until it moves
//     (a Modbus poll that finds the counter where it was says nothing new and gives no sample);
//   * samples while all pressures stand to the bit although boom or arm turned by DIG_STUCK_rad, or
//     all angles stand to the bit for stuck_s although a pressure went by DIG_STUCK_Pa: for senders
//     without a counter, whose values freeze while their frames go on.
// Frames that did not come are told by their counter, or by the cycle they are due in.

#ifndef DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H
#define DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H

#include "core/sample.h"
#include "firmware_host/bus/frame_watch.h"
#include "firmware_host/bus/reading.h"
#include "firmware_host/bus/stuck.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_HISTORY 8 // readings of a message that are remembered

struct dig_assembler_settings {
    double   time_scale;             // machine seconds per second; 1 on a machine
    double   coherent_s, frozen_s;   // machine time
    double   optional_s;             // an optional signal older than this is missing; machine time
    double   stuck_s;                // machine time; 0: values may stand
    bool     has_alive;              // a counter is expected
    bool     repeats;                // an unmoved counter in the only group is a repetition (polls)
    unsigned groups;                 // readings' groups are below this
    bool     needed[DIG_GROUPS_MAX]; // groups that carry needed signals
    bool     spared[DIG_GROUPS_MAX]; // of them those without which the moment can still be told
    struct dig_frame_settings frame[DIG_GROUPS_MAX];
    double                    max_rate[DIG_SIGNALS]; // SI per second, machine time; 0: any
};

/// What was dropped, never reset. Of values those of needed signals are counted only.
struct dig_drops {
    int64_t nan, not_available, out_of_range, frozen, jump, stuck;
    int64_t repeated; // frames
    int64_t missed;   // frames
    // Not dropped: samples that were made without a spared group, which did not come.
    int64_t without_force;
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
    size_t                        came[DIG_GROUPS_MAX]; // readings of the group, ever
    struct dig_frame_watch        watch[DIG_GROUPS_MAX];
    unsigned                      group_of[DIG_SIGNALS]; // that carries it
    bool                          carried[DIG_SIGNALS];  // by any
    double                        good[DIG_SIGNALS];     // the last value within max_rate
    int64_t                       good_ns[DIG_SIGNALS];  // machine time; 0: none yet
    bool                          fresh[DIG_GROUPS_MAX]; // came since the last sample
    size_t                        beats; // readings of the first group that is not spared, ever
    size_t                        beat_of[DIG_GROUPS_MAX]; // how many when the group came last
    bool                          silent[DIG_GROUPS_MAX];  // done without
    struct dig_stuck              stuck;
    int64_t                       first_ns; // of the first reading, as it came
    int64_t                       last_ns;  // of the last sample, machine time
    bool                          started, alive_known, frozen;
    uint64_t                      alive;
    int64_t                       alive_ns; // when the counter moved last, machine time
};

void dig_assembler_init(struct dig_assembler                *assembler,
                        const struct dig_assembler_settings *settings);

/// Takes one reading; true when a sample is due, which is written to *sample then. Signals that
/// were not available, out of range, NaN or changed too fast are missing from it, and those of a
/// spared group that is silent: for DIG_SILENT_CYCLES of its own cycles and of the others', and
/// DIG_SILENT_s. Constant time.
#define DIG_SILENT_CYCLES 3
#define DIG_SILENT_s      0.1 // machine time
bool dig_assembler_take(struct dig_assembler *assembler, const struct dig_reading *reading,
                        struct dig_sample *sample);

#endif // DIG_FIRMWARE_HOST_TICK_ASSEMBLE_H
