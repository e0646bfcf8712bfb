// The CAN side of the signal map: entries found in a DBC, and what the map says of messages.

#include "core/units.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config_map_parts.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

// A DBC unit, and the unit of SI that signals of its quantity have behind their names.
struct unit {
    const char *name, *si;
    double      scale; // to that
};

// A scale farther off its unit is a slip, not a calibration.
static const double most_calibration = 0.1;

static const struct unit units[] = {
    { "Pa", "Pa", 1.0 },          { "kPa", "Pa", 1e3 },
    { "MPa", "Pa", 1e6 },         { "bar", "Pa", 1e5 },
    { "psi", "Pa", 6894.757293 }, { "rad", "rad", 1.0 },
    { "mrad", "rad", 1e-3 },      { "deg", "rad", DIG_RAD_PER_DEG },
    { "degC", "degC", 1.0 },      { "m", "m", 1.0 },
    { "mm", "m", 1e-3 },          { "N", "N", 1.0 },
    { "Nm", "Nm", 1.0 },
};

void dig_config_map_check_unit(const struct dig_config_map_work *const work, const char *const at,
                               const size_t signal, struct dig_map_entry *const entry,
                               const bool scale_given)
{
    const char *const name = dig_signal_name((enum dig_signal)signal);
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        const struct unit *const unit = &units[i];
        if (strcmp(unit->name, entry->can.unit) != 0) {
            continue;
        }
        entry->scale = scale_given ? entry->scale : unit->scale;
        dig_require(work->c, strcmp(unit->si, strrchr(name, '_') + 1) == 0,
                    "%s.signal: %s is in %s, expected a signal that can be %s", at, entry->can.name,
                    unit->name, name);
        dig_require(work->c, fabs(entry->scale - unit->scale) <= most_calibration * unit->scale,
                    "%s.scale: %g, expected %g (the DBC gives %s in %s)", at, entry->scale,
                    unit->scale, entry->can.name, unit->name);
    }
}

// The group of a message, added when it is new.
static unsigned group_of(const struct dig_config_map_work *const work, const char *const at,
                         const struct dig_dbc_message *const message)
{
    struct dig_signal_map *const map   = work->map;
    const int                    known = dig_signal_map_group(map, message->id, message->extended);
    if (known >= 0) {
        return (unsigned)known;
    }
    dig_require(work->c, map->groups < DIG_GROUPS_MAX, "%s.message: expected at most %d messages",
                at, DIG_GROUPS_MAX);
    if (work->c->status != DIG_OK) {
        return 0;
    }
    struct dig_map_group *const added = &map->group[map->groups];
    *added                            = (struct dig_map_group){ .id       = message->id,
                                                                .extended = message->extended,
                                                                .bytes    = message->bytes,
                                                                .frame    = { .cycle_s = message->cycle_s } };
    memcpy(added->name, message->name, sizeof added->name);
    return (unsigned)map->groups++;
}

void dig_config_map_find_can(const struct dig_config_map_work *const work, const char *const at,
                             const char *const message_name, const char *const signal_name,
                             struct dig_map_entry *const entry)
{
    dig_require(work->c, message_name[0] != '\0' && signal_name[0] != '\0',
                "%s.%s: missing, expected a name of the DBC", at,
                message_name[0] == '\0' ? "message" : "signal");
    const struct dig_dbc_message *const message =
        work->c->status == DIG_OK ? dig_dbc_find(work->dbc, message_name) : NULL;
    dig_require(work->c, message != NULL, "%s.message: \"%s\", expected a message of the DBC", at,
                message_name);
    const struct dig_dbc_signal *const signal =
        message != NULL ? dig_dbc_find_signal(work->dbc, message, signal_name) : NULL;
    dig_require(work->c, signal != NULL, "%s.signal: \"%s\", expected a signal of %s", at,
                signal_name, message_name);
    if (signal != NULL) {
        dig_require(work->c, !signal->multiplexed && !signal->is_float,
                    "%s.signal: \"%s\" is %s, expected a plain integer signal", at, signal_name,
                    signal->multiplexed ? "multiplexed" : "floating-point");
        entry->can   = *signal;
        entry->group = group_of(work, at, message);
    }
}

// A signal about the frame itself: its counter, its checksum.
static struct dig_dbc_signal find_frame_signal(const struct dig_config_map_work *const work,
                                               const char *const at, const char *const key_name,
                                               const char *const message, const char *const signal)
{
    struct dig_map_entry entry = { .used = true };
    dig_config_map_find_can(work, at, message, signal, &entry);
    dig_require(work->c, entry.can.bits <= 32, "%s.%s: \"%s\" has %u bits, expected at most 32", at,
                key_name, signal, entry.can.bits);
    return entry.can;
}

static void read_checksum(const struct dig_config_map_work *const work, const char *const at,
                          const struct dig_message_text *const text,
                          struct dig_map_group *const          group)
{
    group->checksum = text->checksum;
    group->checksum_at =
        find_frame_signal(work, at, "checksum", text->message, text->checksum_signal);

    const bool     tsc1 = text->checksum == DIG_CHECKSUM_J1939_TSC1;
    const unsigned bits = group->checksum_at.bits;
    const unsigned from = group->checksum_at.start_bit % 8;
    dig_require(work->c,
                tsc1 ? bits <= 4 && text->counter[0] != '\0'
                     : bits == 8 && from == (group->checksum_at.intel ? 0U : 7U),
                "%s.checksum: expected %s", at,
                tsc1 ? "up to 4 bits, and a counter beside it" : "a signal of one whole byte");
}

void dig_config_map_read_message(const struct dig_config_map_work *const work, const size_t index,
                                 const struct dig_message_text *const text)
{
    char at[32];
    (void)snprintf(at, sizeof at, "messages[%zu]", index);
    const struct dig_dbc_message *const message = dig_dbc_find(work->dbc, text->message);
    const int                           known =
        message != NULL ? dig_signal_map_group(work->map, message->id, message->extended) : -1;
    dig_require(work->c, known >= 0,
                "%s.message: \"%s\", expected a message that carries one of the signals", at,
                text->message);
    if (known < 0) {
        return;
    }
    struct dig_map_group *const group = &work->map->group[known];
    group->frame.delay_s              = text->delay_s;
    group->frame.cycle_s              = text->cycle_s > 0.0 ? text->cycle_s : group->frame.cycle_s;
    if (text->counter[0] != '\0') {
        group->counter = find_frame_signal(work, at, "counter", text->message, text->counter);
        group->frame.counter_mod = group->counter.bits > 0 && group->counter.bits < 32
                                       ? 1U << group->counter.bits
                                       : UINT32_MAX;
    }
    if (text->checksum != DIG_CHECKSUM_NONE) {
        read_checksum(work, at, text, group);
    }
}
