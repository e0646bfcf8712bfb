// From readings as they arrive to samples a wrench can be computed from: one at a time, every
// needed signal fresh and from the same moment.
//
// A sample is due when every message that carries a needed signal has come since the last sample
// and they lie within coherent_s of each other. Message times are scaled to machine time first, so
// that a bench served at double speed looks like the machine. A sender's alive counter that stands
// still longer than frozen_s stops samples until it moves again; a Modbus poll that finds the
// counter where it was says nothing new and gives no sample.

#ifndef DIG_FIRMWARE_HOST_ASSEMBLE_H
#define DIG_FIRMWARE_HOST_ASSEMBLE_H

#include "core/sample.h"
#include "firmware_host/reading.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_assembler_settings {
    double   time_scale;             // machine seconds per second; 1 on a machine
    double   coherent_s, frozen_s;   // machine time
    double   optional_s;             // an optional signal older than this is missing; machine time
    bool     has_alive;              // a counter is expected
    bool     repeats;                // an unmoved counter in the only group is a repetition (polls)
    unsigned groups;                 // readings' groups are below this
    bool     needed[DIG_GROUPS_MAX]; // groups that carry needed signals
};

/// What was dropped, never reset. Counted are needed signals only.
struct dig_drops {
    int64_t nan, not_available, out_of_range, frozen;
};

struct dig_assembler {
    struct dig_assembler_settings settings;
    struct dig_drops              drops;
    struct dig_sample             now;
    int64_t                       value_ns[DIG_SIGNALS];    // machine time
    int64_t                       group_ns[DIG_GROUPS_MAX]; // machine time
    bool                          fresh[DIG_GROUPS_MAX];    // came since the last sample
    int64_t                       first_ns;                 // of the first reading, as it came
    int64_t                       last_ns;                  // of the last sample, machine time
    bool                          started, alive_known, frozen;
    uint64_t                      alive;
    int64_t                       alive_ns; // when the counter moved last, machine time
};

void dig_assembler_init(struct dig_assembler                *assembler,
                        const struct dig_assembler_settings *settings);

/// Takes one reading; true when a sample is due, which is written to *sample then. Signals that
/// were not available, out of range or NaN are missing from it. Constant time.
bool dig_assembler_take(struct dig_assembler *assembler, const struct dig_reading *reading,
                        struct dig_sample *sample);

#endif // DIG_FIRMWARE_HOST_ASSEMBLE_H
