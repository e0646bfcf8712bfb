// Reads and checks the signal map's YAML.

#include "core/did_you_mean.h"
#include "files/yaml/yaml.h"
#include "firmware_host/bus/register_plan.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config_map_parts.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

// Where a value lies on the map's bus.
static void find_place(const struct dig_config_map_work *const work, const char *const at,
                       const struct dig_signal_text *const text, struct dig_map_entry *const entry)
{
    if (work->map->kind == DIG_MAP_CAN) {
        dig_config_map_find_can(work, at, text->message, text->signal, entry);
        return;
    }
    dig_require(work->c, text->reg != NULL,
                "%s.register: missing, expected the register's address, counted from 0", at);
    entry->reg = text->reg != NULL ? *text->reg : 0;
    dig_require(work->c,
                entry->reg <= 0xFFFF && entry->reg + dig_register_words(entry->type) <= 0x10000,
                "%s.register: %u, expected 0 … 65535", at, entry->reg);
}

static void read_signal(const struct dig_config_map_work *const work, const size_t index,
                        const struct dig_signal_text *const text)
{
    char at[32];
    (void)snprintf(at, sizeof at, "signals[%zu]", index);
    const int signal = dig_signal_find(text->name);
    if (signal < 0) {
        char             best[DIG_GUESS_SIZE];
        struct dig_guess guess = dig_guess(text->name);
        for (int s = 0; s < DIG_SIGNALS; s++) {
            dig_guess_try(&guess, dig_signal_name((enum dig_signal)s));
        }
        dig_require(work->c, false,
                    "%s.name: \"%s\", expected a column of a machine recording (boom_rad, …)%s", at,
                    text->name, dig_guess_text(&guess, "", best));
        return;
    }
    struct dig_map_entry entry       = text->entry;
    const bool           scale_given = fabs(entry.scale) > 0.0;
    dig_require(work->c, !work->map->entry[signal].used,
                "%s.name: \"%s\" again, expected every signal once", at, text->name);
    dig_require(work->c, text->sign >= -1 && text->sign <= 1, "%s.sign: %d, expected 1 or -1", at,
                text->sign);
    dig_require(work->c, entry.min < entry.max, "%s.max: %g, expected more than min %g", at,
                entry.max, entry.min);
    dig_require(work->c, entry.max_rate >= 0.0, "%s.max_rate: %g, expected 0 (any) or more", at,
                entry.max_rate);
    entry.used  = true;
    entry.sign  = text->sign < 0 ? -1.0 : 1.0;
    entry.scale = scale_given ? entry.scale : 1.0;
    find_place(work, at, text, &entry);
    if (work->map->kind == DIG_MAP_CAN && work->c->status == DIG_OK) {
        dig_config_map_check_unit(work, at, (size_t)signal, &entry, scale_given);
    }
    work->map->entry[signal] = entry;
}

static void read_alive(const struct dig_config_map_work *const work,
                       const struct dig_signal_text *const     text)
{
    const struct dig_yaml_range  frozen = { "frozen_ms", text->frozen_ms, 0.0, 60e3 };
    struct dig_signal_map *const map    = work->map;

    map->has_alive   = true;
    map->alive       = text->entry;
    map->alive.used  = true;
    map->alive.sign  = 1.0;
    map->alive.scale = 1.0;
    map->frozen_s    = text->frozen_ms > 0.0 ? text->frozen_ms * 1e-3 : 0.5;
    find_place(work, "alive", text, &map->alive);
    dig_yaml_check_ranges("alive", 1, &frozen, work->c);
}

// Checks the keys of the map that do not depend on its signals.
static void check_map(const struct dig_config_map_work *const work,
                      const struct dig_map_text *const        text)
{
    const struct dig_signal_map *const map     = work->map;
    const bool                         can     = map->kind == DIG_MAP_CAN;
    const struct dig_yaml_range        range[] = {
               { "coherent_ms", map->coherent_s, 0.0, 1000.0 },
               { "stuck_ms", text->stuck_ms != NULL ? *text->stuck_ms : 0.0, 0.0, 60e3 },
    };
    dig_require(work->c, !can || work->dbc != NULL, "kind: can, expected modbus for this input");
    dig_require(work->c, text->function == 0 || text->function == 3 || text->function == 4,
                "function: %u, expected 4 (input registers) or 3 (holding registers)",
                text->function);
    dig_yaml_check_ranges("", 2, range, work->c);
    dig_require(work->c, !can || map->groups == 0,
                "blocks: given for can, expected with kind: modbus only");
    dig_require(work->c, can || (text->messages_count == 0 && !map->j1939),
                "%s: given for modbus, expected with kind: can only",
                map->j1939 ? "j1939" : "messages");
}

// Checks a block, and what it says in the file's units becomes what the map keeps.
static void take_block(const struct dig_config_map_work *const work, const size_t index,
                       const unsigned function, struct dig_map_group *const block)
{
    char                        at[32];
    const double                first   = block->first_register;
    const struct dig_yaml_range range[] = {
        { "register", first, 0.0, 65535.0 },
        { "registers", block->registers, 1.0, fmin(DIG_REGISTERS_MAX, 65536.0 - first) },
        { "function", block->function, block->function == 0 ? 0.0 : 3.0, 4.0 },
        { "poll_Hz", block->poll_s, fabs(block->poll_s) > 0.0 ? 0.01 : 0.0, 1000.0 },
        { "delay_ms", block->frame.delay_s, 0.0, 1000.0 },
    };
    (void)snprintf(at, sizeof at, "blocks[%zu]", index);
    dig_yaml_check_ranges(at, sizeof range / sizeof range[0], range, work->c);
    block->function = block->function != 0 ? block->function : function;
    block->poll_s   = block->poll_s > 0.0 ? 1.0 / block->poll_s : 0.0;
    block->frame.delay_s *= 1e-3;
}

// Reads the blocks of a Modbus map, every register within one; plans them where there are none.
static void read_blocks(const struct dig_config_map_work *const work,
                        const struct dig_map_text *const        text)
{
    struct dig_signal_map *const map      = work->map;
    const unsigned               function = text->function == 3 ? 3 : 4;
    if (map->groups == 0) {
        dig_register_plan(map, function);
        return;
    }
    for (size_t i = 0; i < map->groups; i++) {
        take_block(work, i, function, &map->group[i]);
    }
    for (unsigned i = 0; work->c->status == DIG_OK && i < text->signals_count; i++) {
        struct dig_map_entry *const entry = &map->entry[dig_signal_find(text->signals[i].name)];
        dig_require(work->c, dig_register_assign(map, entry),
                    "signals[%u].register: %u, expected it within one of the blocks", i,
                    entry->reg);
    }
    dig_require(work->c, !map->has_alive || dig_register_assign(map, &map->alive),
                "alive.register: %u, expected it within one of the blocks", map->alive.reg);
}

// The signals the moment needs must be mapped, and none of the other kind of machine. A cylinder's
// force needs both of its chambers.
static void check_signals(const struct dig_config_map_work *const work)
{
    const struct dig_map_entry *const entry   = work->map->entry;
    const enum dig_sensing            sensing = dig_signal_map_sensing(work->map);
    const bool                        sensor  = sensing == DIG_SENSING_SENSOR;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        const enum dig_signal signal = (enum dig_signal)i;
        dig_require(work->c, entry[i].used || !dig_signal_gives_moment(sensing, signal),
                    "signals: no entry %s, expected %s", dig_signal_name(signal),
                    sensor ? "the pin's place, the bucket's angle and all that the force sensor "
                             "reads"
                           : "one for each angle and both pressures of the bucket's cylinder");
        dig_require(work->c,
                    !entry[i].used || dig_signal_is_optional(signal) ||
                        dig_signal_is_needed(sensing, signal),
                    "signals: entry %s, expected signals of cylinders or of a force sensor, not of "
                    "both",
                    dig_signal_name(signal));
    }
    for (int i = DIG_SIGNAL_BOOM_HEAD_Pa; i < DIG_SIGNALS_NEEDED; i += 2) {
        dig_require(work->c, entry[i].used == entry[i + 1].used,
                    "signals: no entry %s, expected both pressures of a cylinder or none",
                    dig_signal_name((enum dig_signal)(entry[i].used ? i + 1 : i)));
    }
}

// Polls follow each other, and values are interpolated to one time: so far apart may blocks lie.
static const double coherent_polls_s = 0.2;

// The groups that carry what is needed, and those the moment does not need.
static void find_needed(struct dig_signal_map *const map)
{
    const enum dig_sensing sensing = dig_signal_map_sensing(map);
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (map->entry[i].used && dig_signal_is_needed(sensing, (enum dig_signal)i)) {
            struct dig_map_group *const group = &map->group[map->entry[i].group];
            group->dispensable                = (group->dispensable || !group->needed) &&
                                 !dig_signal_gives_moment(sensing, (enum dig_signal)i);
            group->needed = true;
        }
    }
}

static void read_map(const struct dig_config_map_work *const work,
                     const struct dig_map_text *const        text)
{
    struct dig_signal_map *const map = work->map;
    check_map(work, text);
    map->stuck_s    = text->stuck_ms != NULL ? *text->stuck_ms * 1e-3 : 0.5;
    map->coherent_s = map->coherent_s > 0.0      ? map->coherent_s * 1e-3
                      : map->kind == DIG_MAP_CAN ? 6e-3
                                                 : coherent_polls_s;

    for (unsigned i = 0; work->c->status == DIG_OK && i < text->signals_count; i++) {
        read_signal(work, i, &text->signals[i]);
    }
    if (work->c->status == DIG_OK && text->alive != NULL) {
        read_alive(work, text->alive);
    }
    for (unsigned i = 0; work->c->status == DIG_OK && i < text->messages_count; i++) {
        dig_config_map_read_message(work, i, &text->messages[i]);
    }
    if (work->c->status == DIG_OK && map->kind == DIG_MAP_MODBUS) {
        read_blocks(work, text);
    }
    if (work->c->status == DIG_OK) {
        find_needed(map);
        check_signals(work);
    }
}

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    const struct dig_config_map_work *const asked = into;
    const struct dig_map_text *const        text  = loaded;
    struct dig_signal_map                   map   = text->map;
    const struct dig_config_map_work        work  = { asked->dbc, &map, c };
    (void)path;
    read_map(&work, text);
    if (c->status == DIG_OK) {
        *asked->map = map;
    }
}

enum dig_status dig_signal_map_read(const char *const path, const struct dig_dbc *const dbc,
                                    struct dig_signal_map *const map, struct dig_error *const error)
{
    assert(map != NULL);
    struct dig_config_map_work asked = { .dbc = dbc, .map = map };
    return dig_yaml_read(path, &dig_map_schema, take, &asked, error);
}
