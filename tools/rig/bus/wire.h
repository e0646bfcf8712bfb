// The wire between a CAN sender and the bus. On request it loses, doubles, reorders or damages some
// frames, or holds them back and sends them in bursts; otherwise it passes every frame.

#ifndef DIG_TOOLS_RIG_BUS_WIRE_H
#define DIG_TOOLS_RIG_BUS_WIRE_H

#include "tools/rig/bus/can_layout.h"
#include "tools/rig/bus/fault.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_RIG_WIRE_MAX 64 // frames held back at once; more push the oldest out

/// Zeroed but for the seed: quiet.
struct dig_rig_wire {
    uint64_t                 random;
    size_t                   held;
    struct dig_rig_can_frame frame[DIG_RIG_WIRE_MAX];
    double                   held_s; // when the first was held back
    bool                     waits;  // one frame waits to be overtaken
    struct dig_rig_can_frame waiting;
    uint64_t                 dropped, doubled, overtaken, damaged;
};

/// Takes a frame at time_s; hands on to send(context, frame) what the faults let through.
void dig_rig_wire_put(struct dig_rig_wire *wire, const struct dig_rig_faults *faults, double time_s,
                      const struct dig_rig_can_frame *frame,
                      void (*send)(void *context, const struct dig_rig_can_frame *frame),
                      void *context);

#endif // DIG_TOOLS_RIG_BUS_WIRE_H
