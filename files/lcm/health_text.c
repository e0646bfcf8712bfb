#include "files/lcm/health_text.h"

#include <assert.h>
#include <string.h>

enum {
    BUS_OFFS,
    TIMEOUTS,
    CHECKSUM,
    MALFORMED,
    ERROR_FRAMES,
    MISSED,
    REPEATED,
    FROZEN,
    STUCK,
    NOT_AVAILABLE,
    OUT_OF_RANGE,
    JUMP,
    NAN_VALUES,
    WITHOUT_FORCE,
    RECONNECTS,
    LOST,
    UNSENT,
    RELOADS_REFUSED,
    OVERRUNS,
};

_Static_assert(OVERRUNS + 1 == DIG_HEALTH_COUNTERS, "each counter has its text");

const struct dig_health_text *dig_health_counter_text(const size_t i)
{
    static const struct dig_health_text text[DIG_HEALTH_COUNTERS] = {
        [BUS_OFFS]        = { "bus_offs", "the CAN controller went off the bus",
                              "check bit rate and wiring; `ip link set can0 type can restart-ms 100` "
                                     "brings "
                                     "it back" },
        [TIMEOUTS]        = { "timeouts", "Modbus requests had no answer",
                              "check the device's power, address and unit number; poll less often" },
        [CHECKSUM]        = { "dropped_checksum", "frames had a wrong checksum",
                              "the bus is disturbed, or the signal map names the wrong checksum" },
        [MALFORMED]       = { "dropped_malformed", "frames or answers were damaged",
                              "check wiring and termination, and that DBC or register map fit the "
                                    "machine" },
        [ERROR_FRAMES]    = { "error_frames", "the CAN controller sees errors",
                              "check bit rate, termination (60 ohm between the wires) and plugs" },
        [MISSED]          = { "missed", "frames that were due did not come",
                              "check plugs and the load of the bus; the map's cycle_ms may be wrong" },
        [REPEATED]        = { "dropped_repeated", "frames came twice or out of order",
                              "look for a gateway or a second sender on the bus" },
        [FROZEN]          = { "dropped_frozen", "the alive counter stands still",
                              "the sender hangs: restart its controller" },
        [STUCK]           = { "dropped_stuck", "angles or pressures stand still while others move",
                              "check the supply and the plug of those sensors" },
        [NOT_AVAILABLE]   = { "dropped_not_available", "sensors say that they have no value",
                              "check the sensor and its plug" },
        [OUT_OF_RANGE]    = { "dropped_out_of_range", "values lie beyond the signal map's limits",
                              "check the sensor, and sign, scale and offset in the map" },
        [JUMP]            = { "dropped_jump", "values change faster than the machine can",
                              "look for a loose contact of that sensor; the map's max_rate may be low" },
        [NAN_VALUES]      = { "dropped_nan", "values are no numbers",
                              "the sender fails: restart its controller" },
        [WITHOUT_FORCE]   = { "without_force", "pressures of boom or arm do not come",
                              "check their message or block; the moment is known, the force is not" },
        [RECONNECTS]      = { "reconnects", "the source was lost and opened again",
                              "check the cable and the power of the interface" },
        [LOST]            = { "lost", "the computer did not keep up: readings were lost",
                              "stop other programs; publish less (publish.estimate_every)" },
        [UNSENT]          = { "unsent", "LCM could not send messages",
                              "the network or its route is gone: `ip route add 239.255.76.67 dev lo`" },
        [RELOADS_REFUSED] = { "reloads_refused", "a new table or model was refused",
                              "the log of digsightd says why; the old one stays in use" },
        [OVERRUNS]        = { "overruns", "the real-time loop came late",
                              "stop other programs; grant real-time priority (the systemd unit does)" },
    };
    assert(i < DIG_HEALTH_COUNTERS);
    return &text[i];
}

void dig_health_counts(const digsight_health_t *const h, int64_t count[DIG_HEALTH_COUNTERS])
{
    assert(h != NULL && count != NULL);
    const int64_t counts[DIG_HEALTH_COUNTERS] = {
        [BUS_OFFS]        = h->bus_offs,
        [TIMEOUTS]        = h->timeouts,
        [CHECKSUM]        = h->dropped_checksum,
        [MALFORMED]       = h->dropped_malformed,
        [ERROR_FRAMES]    = h->error_frames,
        [MISSED]          = h->missed,
        [REPEATED]        = h->dropped_repeated,
        [FROZEN]          = h->dropped_frozen,
        [STUCK]           = h->dropped_stuck,
        [NOT_AVAILABLE]   = h->dropped_not_available,
        [OUT_OF_RANGE]    = h->dropped_out_of_range,
        [JUMP]            = h->dropped_jump,
        [NAN_VALUES]      = h->dropped_nan,
        [WITHOUT_FORCE]   = h->without_force,
        [RECONNECTS]      = h->reconnects,
        [LOST]            = h->lost,
        [UNSENT]          = h->unsent,
        [RELOADS_REFUSED] = h->reloads_refused,
        [OVERRUNS]        = h->overruns,
    };
    memcpy(count, counts, sizeof counts);
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
