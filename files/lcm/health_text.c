#include "files/lcm/health_text.h"

#include <assert.h>
#include <string.h>

// A counter of the message, and what it says.
struct counter {
    struct dig_health_text text;
    size_t                 at; // its place in the message
};

// Compiles for a field of 64 bits alone.
#define COUNTER(field, what, todo)                                                                 \
    {                                                                                              \
        { #field, what, todo }, _Generic(((digsight_health_t *)NULL)->field, int64_t               \
                                         : offsetof(digsight_health_t, field))                     \
    }

static const struct counter counters[] = {
    COUNTER(bus_offs, "the CAN controller went off the bus",
            "check bit rate and wiring; `ip link set can0 type can restart-ms 100` brings it back"),
    COUNTER(timeouts, "Modbus requests had no answer",
            "check the device's power, address and unit number; poll less often"),
    COUNTER(dropped_checksum, "frames had a wrong checksum",
            "the bus is disturbed, or the signal map names the wrong checksum"),
    COUNTER(dropped_malformed, "frames or answers were damaged",
            "check wiring and termination, and that DBC or register map fit the machine"),
    COUNTER(error_frames, "the CAN controller sees errors",
            "check bit rate, termination (60 ohm between the wires) and plugs"),
    COUNTER(missed, "frames that were due did not come",
            "check plugs and the load of the bus; the map's cycle_ms may be wrong"),
    COUNTER(dropped_repeated, "frames came twice or out of order",
            "look for a gateway or a second sender on the bus"),
    COUNTER(dropped_frozen, "the alive counter stands still",
            "the sender hangs: restart its controller"),
    COUNTER(dropped_stuck, "angles or pressures stand still while others move",
            "check the supply and the plug of those sensors"),
    COUNTER(dropped_not_available, "sensors say that they have no value",
            "check the sensor and its plug"),
    COUNTER(dropped_out_of_range, "values lie beyond the signal map's limits",
            "check the sensor, and sign, scale and offset in the map"),
    COUNTER(dropped_jump, "values change faster than the machine can",
            "look for a loose contact of that sensor; the map's max_rate may be low"),
    COUNTER(dropped_nan, "values are no numbers", "the sender fails: restart its controller"),
    COUNTER(without_force, "pressures of boom or arm do not come",
            "check their message or block; the moment is known, the force is not"),
    COUNTER(reconnects, "the source was lost and opened again",
            "check the cable and the power of the interface"),
    COUNTER(lost, "the computer did not keep up: readings were lost",
            "stop other programs; publish less (publish.estimate_every)"),
    COUNTER(unsent, "LCM could not send messages",
            "the network or its route is gone: `ip route add 239.255.76.67 dev lo`"),
    COUNTER(reloads_refused, "a new table or model was refused",
            "the log of digsightd says why; the old one stays in use"),
    COUNTER(overruns, "the real-time loop came late",
            "stop other programs; grant real-time priority (the systemd unit does)"),
};

_Static_assert(sizeof counters / sizeof counters[0] == DIG_HEALTH_COUNTERS, "all have their text");

const struct dig_health_text *dig_health_counter_text(const size_t i)
{
    assert(i < DIG_HEALTH_COUNTERS);
    return &counters[i].text;
}

void dig_health_counts(const digsight_health_t *const h, int64_t count[DIG_HEALTH_COUNTERS])
{
    assert(h != NULL && count != NULL);
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        memcpy(&count[i], (const char *)h + counters[i].at, sizeof count[i]);
    }
}

const struct dig_health_text *dig_health_state_text(const char *const state)
{
    assert(state != NULL);
    static const struct dig_health_text text[] = {
        { "starting", "digsightd is starting", "wait a moment" },
        { "waiting for bus", "no fresh sample comes from the machine",
          "switch the machine on; check the cable, and interface or address in the configuration" },
        { "stopping", "digsightd is ending", "start it again: `systemctl start digsightd`" },
    };
    for (size_t i = 0; i < sizeof text / sizeof text[0]; i++) {
        if (strcmp(state, text[i].name) == 0) {
            return &text[i];
        }
    }
    return NULL;
}
