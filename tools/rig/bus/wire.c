#include "tools/rig/bus/wire.h"

#include "core/chance.h"

#include <assert.h>
#include <string.h>

// Where a frame goes once it is past the faults.
struct sink {
    void (*send)(void *context, const struct dig_rig_can_frame *frame);
    void *context;
};

static void release(struct dig_rig_wire *const wire, const struct sink *const sink)
{
    for (size_t i = 0; i < wire->held; i++) {
        sink->send(sink->context, &wire->frame[i]);
    }
    wire->held = 0;
}

// Holds the frame back, or sends all there are when the oldest waited long enough.
static void hold(struct dig_rig_wire *const wire, const double delay_s, const double time_s,
                 const struct dig_rig_can_frame *const frame, const struct sink *const sink)
{
    if (wire->held == 0) {
        wire->held_s = time_s;
    }
    wire->frame[wire->held++] = *frame;
    if (wire->held == DIG_RIG_WIRE_MAX || time_s - wire->held_s >= delay_s) {
        release(wire, sink);
    }
}

// One of a kind is held until the next of its kind has passed.
static bool is_overtaken(struct dig_rig_wire *const wire, const double share,
                         const struct dig_rig_can_frame *const frame, const struct sink *const sink)
{
    if (wire->waits && wire->waiting.id == frame->id) {
        sink->send(sink->context, frame);
        sink->send(sink->context, &wire->waiting);
        wire->waits = false;
        wire->overtaken++;
        return true;
    }
    if (!wire->waits && dig_chance_uniform(&wire->random) < share) {
        wire->waits   = true;
        wire->waiting = *frame;
        return true;
    }
    return false;
}

void dig_rig_wire_put(struct dig_rig_wire *const wire, const struct dig_rig_faults *const faults,
                      const double time_s, const struct dig_rig_can_frame *const frame,
                      void (*const send)(void *context, const struct dig_rig_can_frame *frame),
                      void *const context)
{
    assert(wire != NULL && frame != NULL && send != NULL);
    const struct sink sink    = { send, context };
    const double      drop    = dig_rig_fault_amount(faults, DIG_RIG_FAULT_DROP, time_s);
    const double      twice   = dig_rig_fault_amount(faults, DIG_RIG_FAULT_DUPLICATE, time_s);
    const double      corrupt = dig_rig_fault_amount(faults, DIG_RIG_FAULT_CORRUPT, time_s);
    const double      delay_s = dig_rig_fault_amount(faults, DIG_RIG_FAULT_DELAY, time_s);
    const double      reorder = dig_rig_fault_amount(faults, DIG_RIG_FAULT_REORDER, time_s);

    struct dig_rig_can_frame out = *frame;
    if (drop > 0.0 && dig_chance_uniform(&wire->random) < drop) {
        wire->dropped++;
        return;
    }
    if (corrupt > 0.0 && dig_chance_uniform(&wire->random) < corrupt) {
        const unsigned bit = (unsigned)(64.0 * dig_chance_uniform(&wire->random));
        out.data[bit / 8] ^= (uint8_t)(1U << (bit % 8));
        wire->damaged++;
    }
    if (delay_s > 0.0 || wire->held > 0) {
        hold(wire, delay_s, time_s, &out, &sink);
        return;
    }
    if ((reorder > 0.0 || wire->waits) && is_overtaken(wire, reorder, &out, &sink)) {
        return;
    }
    send(context, &out);
    if (twice > 0.0 && dig_chance_uniform(&wire->random) < twice) {
        send(context, &out);
        wire->doubled++;
    }
}
