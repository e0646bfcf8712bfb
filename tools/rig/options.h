// The command line of digrig.

#ifndef DIG_TOOLS_RIG_OPTIONS_H
#define DIG_TOOLS_RIG_OPTIONS_H

#include "core/error.h"
#include "tools/rig/bus/fault.h"
#include "tools/rig/motion/track.h"

#include <stdbool.h>
#include <stdint.h>

#define DIG_RIG_INPUTS_MAX 32

enum dig_rig_command { DIG_RIG_COMMAND_RECORD, DIG_RIG_COMMAND_AIR, DIG_RIG_COMMAND_SERVE };

/// Strings point into argv.
struct dig_rig_options {
    enum dig_rig_command         command;
    size_t                       inputs;
    const char                  *input[DIG_RIG_INPUTS_MAX]; // recordings, or one campaign folder
    const char                  *machine;
    const char                  *scene; // NULL: none
    struct dig_rig_track_options track;
    uint64_t                     seed;
    bool                         noise;
    bool                         quiet; // no progress
    // record, air
    bool        quantise;
    const char *out;
    const char *truth; // NULL: none
    // serve; NULL: not on that bus
    const char           *can;
    bool                  can_sealed; // frames carry a counter and a checksum
    const char           *tcp;        // IPV4:PORT
    const char           *rtu;        // DEVICE[:BAUD]
    double                speed;
    bool                  loop;
    bool                  json;
    double                start_delay_s;
    struct dig_rig_faults faults;
};

/// Prints help or version and exits where asked to. DIG_EINVAL says which option and what was
/// expected.
DIG_MUST_CHECK enum dig_status dig_rig_options_parse(int argc, char *argv[],
                                                     struct dig_rig_options *options,
                                                     struct dig_error       *error);

/// What is wrong with the command line, whose first word is word, to stderr.
void dig_rig_options_refuse(const char *word, const struct dig_error *error);

#endif // DIG_TOOLS_RIG_OPTIONS_H
