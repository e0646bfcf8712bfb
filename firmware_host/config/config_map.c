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

// The map, beside what it is made of; its groups are the blocks. What is absent is 0, unless a
// default stands below.
struct map_text {
    struct dig_signal_map   map;
    const struct dig_dbc   *dbc;
    unsigned                function;
    struct dig_signal_text  alive;
    struct dig_message_text messages[DIG_GROUPS_MAX];
    size_t                  messages_count;
    struct dig_signal_text  signals[DIG_SIGNALS];
    size_t                  signals_count;
};

#define NAME(key, flag, type, member) FIELD(TEXT, key, type, member, flag, .least = 1)
#define MS(key, type, member, most)                                                                \
    FIELD(NUMBER, key, type, member, OPTIONAL, .low = 0.0, .high = (most), .factor = 1e-3)

static const struct dig_yaml_word kinds[] = { { "can", DIG_MAP_CAN },
                                              { "modbus", DIG_MAP_MODBUS },
                                              { .word = NULL } };
static const struct dig_yaml_word types[] = {
    { "uint16", DIG_REGISTER_UINT16 },   { "int16", DIG_REGISTER_INT16 },
    { "uint32", DIG_REGISTER_UINT32 },   { "int32", DIG_REGISTER_INT32 },
    { "float32", DIG_REGISTER_FLOAT32 }, { .word = NULL },
};
static const struct dig_yaml_word signs[]     = { { "1", 1 }, { "-1", -1 }, { .word = NULL } };
static const struct dig_yaml_word checksums[] = {
    { "sum8", DIG_CHECKSUM_SUM8 },
    { "xor8", DIG_CHECKSUM_XOR8 },
    { "crc8_sae_j1850", DIG_CHECKSUM_CRC8_SAE_J1850 },
    { "j1939_tsc1", DIG_CHECKSUM_J1939_TSC1 },
    { .word = NULL },
};

static const struct dig_yaml_field raw_value = { .kind = DIG_YAML_COUNT, .size = sizeof(uint64_t) };

#define OF(kind, key, member, ...) FIELD(kind, key, dig_signal_text, member, __VA_ARGS__)

// Where a value lies on the bus.
#define PLACE                                                                                      \
    NAME("message", OPTIONAL, dig_signal_text, message),                                           \
        NAME("signal", OPTIONAL, dig_signal_text, signal),                                         \
        OF(COUNT, "register", entry.reg, OPTIONAL, GIVEN(dig_signal_text, has_reg)),               \
        OF(WORD, "type", entry.type, OPTIONAL, .word = types)

static const struct dig_yaml_field alive_fields[] = {
    PLACE,
    MS("frozen_ms", dig_signal_text, frozen_s, 60e3),
    END,
};

static const struct dig_yaml_field signal_fields[] = {
    NAME("name", REQUIRED, dig_signal_text, name),
    PLACE,
    OF(WORD, "sign", sign, OPTIONAL, .word = signs),
    OF(NUMBER, "scale", entry.scale, OPTIONAL),
    OF(NUMBER, "offset", entry.offset, OPTIONAL),
    OF(NUMBER, "min", entry.min, REQUIRED),
    OF(NUMBER, "max", entry.max, REQUIRED),
    OF(NUMBER, "max_rate", entry.max_rate, OPTIONAL),
    LIST("not_available", OPTIONAL, dig_signal_text, entry.not_available_raw, entry.not_available,
         &raw_value, 0),
    END,
};
static const struct dig_yaml_field signal_value = ENTRY(dig_signal_text, signal_fields);

static const struct dig_yaml_field checksum_fields[] = {
    NAME("signal", REQUIRED, dig_message_text, checksum_signal),
    FIELD(WORD, "kind", dig_message_text, checksum, REQUIRED, .word = checksums),
    END,
};

static const struct dig_yaml_field message_fields[] = {
    NAME("message", REQUIRED, dig_message_text, message),
    NAME("counter", OPTIONAL, dig_message_text, counter),
    MS("delay_ms", dig_message_text, delay_s, 1000.0),
    MS("cycle_ms", dig_message_text, cycle_s, 60e3),
    ACROSS("checksum", OPTIONAL, checksum_fields),
    END,
};
static const struct dig_yaml_field message_value = ENTRY(dig_message_text, message_fields);

#define OF_BLOCK(kind, key, member, ...) FIELD(kind, key, dig_map_group, member, __VA_ARGS__)

static const struct dig_yaml_field block_fields[] = {
    OF_BLOCK(COUNT, "register", first_register, REQUIRED, .low = 0.0, .high = 65535.0),
    OF_BLOCK(COUNT, "registers", registers, REQUIRED, .low = 1.0, .high = DIG_REGISTERS_MAX),
    OF_BLOCK(COUNT, "function", function, OPTIONAL, .low = 3.0, .high = 4.0),
    OF_BLOCK(NUMBER, "poll_Hz", poll_s, OPTIONAL, .low = 0.01, .high = 1000.0, .factor = -1.0),
    MS("delay_ms", dig_map_group, frame.delay_s, 1000.0),
    END,
};
static const struct dig_yaml_field block_value = ENTRY(dig_map_group, block_fields);

#define OF_MAP(kind, key, member, ...) FIELD(kind, key, map_text, map.member, __VA_ARGS__)

static const struct dig_yaml_field map_fields[] = {
    OF_MAP(WORD, "kind", kind, REQUIRED, .word = kinds),
    // 4, the default: input registers; 3: holding registers.
    FIELD(COUNT, "function", map_text, function, OPTIONAL, .low = 3.0, .high = 4.0),
    OF_MAP(BOOL, "low_word_first", low_word_first, OPTIONAL),
    OF_MAP(BOOL, "j1939", j1939, OPTIONAL),
    MS("coherent_ms", map_text, map.coherent_s, 1000.0),
    MS("stuck_ms", map_text, map.stuck_s, 60e3),
    LIST("messages", OPTIONAL, map_text, messages, messages_count, &message_value, 0),
    LIST("blocks", OPTIONAL, map_text, map.group, map.groups, &block_value, 0),
    FIELD(MAPPING, "alive", map_text, alive, OPTIONAL, .of = alive_fields,
          GIVEN(map_text, map.has_alive)),
    LIST("signals", REQUIRED, map_text, signals, signals_count, &signal_value, 1),
    END,
};

// Where a value lies on the map's bus.
static void find_place(const struct dig_config_map_work *const work, const char *const at,
                       const struct dig_signal_text *const text, struct dig_map_entry *const entry)
{
    if (work->map->kind == DIG_MAP_CAN) {
        dig_config_map_find_can(work, at, text->message, text->signal, entry);
        return;
    }
    dig_require(work->c, text->has_reg,
                "%s.register: missing, expected the register's address, counted from 0", at);
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
    struct dig_signal_map *const map = work->map;
    map->alive                       = text->entry;
    map->alive.used                  = true;
    map->alive.sign                  = 1.0;
    map->alive.scale                 = 1.0;
    map->frozen_s                    = text->frozen_s > 0.0 ? text->frozen_s : 0.5;
    find_place(work, "alive", text, &map->alive);
}

// Checks the keys of the map that do not depend on its signals.
static void check_map(const struct dig_config_map_work *const work,
                      const struct map_text *const            text)
{
    const struct dig_signal_map *const map = work->map;
    const bool                         can = map->kind == DIG_MAP_CAN;
    dig_require(work->c, !can || work->dbc != NULL, "kind: can, expected modbus for this input");
    dig_require(work->c, !can || map->groups == 0,
                "blocks: given for can, expected with kind: modbus only");
    dig_require(work->c, can || (text->messages_count == 0 && !map->j1939),
                "%s: given for modbus, expected with kind: can only",
                map->j1939 ? "j1939" : "messages");
}

// Reads the blocks of a Modbus map, every register within one; plans them where there are none.
static void read_blocks(const struct dig_config_map_work *const work,
                        const struct map_text *const            text)
{
    struct dig_signal_map *const map      = work->map;
    const unsigned               function = text->function == 3 ? 3 : 4;
    if (map->groups == 0) {
        dig_register_plan(map, function);
        return;
    }
    for (size_t i = 0; i < map->groups; i++) {
        struct dig_map_group *const block = &map->group[i];
        dig_require(work->c, block->first_register + block->registers <= 65536,
                    "blocks[%zu].registers: %u, expected 1 … %u", i, block->registers,
                    65536 - block->first_register);
        block->function = block->function != 0 ? block->function : function;
    }
    for (size_t i = 0; work->c->status == DIG_OK && i < text->signals_count; i++) {
        struct dig_map_entry *const entry = &map->entry[dig_signal_find(text->signals[i].name)];
        dig_require(work->c, dig_register_assign(map, entry),
                    "signals[%zu].register: %u, expected it within one of the blocks", i,
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
                     const struct map_text *const            text)
{
    struct dig_signal_map *const map = work->map;
    check_map(work, text);
    if (!(map->coherent_s > 0.0)) {
        map->coherent_s = map->kind == DIG_MAP_CAN ? 6e-3 : coherent_polls_s;
    }

    for (size_t i = 0; work->c->status == DIG_OK && i < text->signals_count; i++) {
        read_signal(work, i, &text->signals[i]);
    }
    if (work->c->status == DIG_OK && map->has_alive) {
        read_alive(work, &text->alive);
    }
    for (size_t i = 0; work->c->status == DIG_OK && i < text->messages_count; i++) {
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

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct map_text *const           text = loaded;
    const struct dig_config_map_work work = { text->dbc, &text->map, c };
    (void)path;
    read_map(&work, text);
}

enum dig_status dig_signal_map_read(const char *const path, const struct dig_dbc *const dbc,
                                    struct dig_signal_map *const map, struct dig_error *const error)
{
    assert(map != NULL);
    const struct map_text      start  = { .map.stuck_s = 0.5, .dbc = dbc };
    const struct dig_yaml_file schema = {
        .of = map_fields, .size = sizeof start, .kept = sizeof start.map, .defaults = &start
    };
    return dig_yaml_read(path, &schema, take, map, error);
}
