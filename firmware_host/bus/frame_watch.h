// Detects frames of a cyclic message that did not come, or came twice.
//
// A message with a counter is watched by it. Another one in a fixed cycle is watched by the clock:
// a phase-locked prediction of the next stamp, so that jitter below half a cycle does not count.
// After a pause the frames due are owed; a burst pays them back, as they were only late. What is
// still owed after DIG_WATCH_FRAMES frames that pay nothing back, or DIG_WATCH_LONGEST in any case,
// counts as missed.

#ifndef DIG_FIRMWARE_HOST_BUS_FRAME_WATCH_H
#define DIG_FIRMWARE_HOST_BUS_FRAME_WATCH_H

#include <stdbool.h>
#include <stdint.h>

#define DIG_WATCH_FRAMES  20
#define DIG_WATCH_LONGEST 2000

struct dig_frame_settings {
    double   delay_s;     // how old a value is when its frame is stamped, machine time
    double   cycle_s;     // machine time; 0: not cyclic
    unsigned counter_mod; // the frame's own counter runs 0 … counter_mod - 1; 0: it has none
};

/// Zeroed: no frame came yet.
struct dig_frame_watch {
    bool     started;
    uint64_t counter;
    int64_t  due_ns; // machine time
    int64_t  owed;
    unsigned frames, total; // that paid nothing back in a row; since what is owed was settled
    int64_t  missed, repeated;
};

/// Steps by a frame's stamp (machine time) and counter. False: it repeats or is older than the last
/// one and must be dropped. Constant time.
bool dig_frame_watch_take(struct dig_frame_watch *watch, const struct dig_frame_settings *settings,
                          int64_t time_ns, uint64_t counter);

#endif // DIG_FIRMWARE_HOST_BUS_FRAME_WATCH_H
