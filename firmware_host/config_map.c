// The signal map's YAML. Named config_* with the daemon's own configuration: the files that know
// libcyaml.

#include "core/units.h"
#include "files/yaml.h"
#include "firmware_host/signal_map.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

// The file as it is written.
struct alive_text {
    char                  *message, *signal;
    unsigned              *reg;
    enum dig_register_type type;
    double                 frozen_ms;
};

struct checksum_text {
    char             *signal;
    enum dig_checksum kind;
};

struct message_text {
    char                 *message, *counter;
    double                delay_ms, cycle_ms;
    struct checksum_text *checksum;
};

struct signal_text {
    char                  *name, *message, *signal;
    unsigned              *reg;
    enum dig_register_type type;
    int                    sign;
    double                 scale, offset, min, max, max_rate;
    uint64_t              *not_available;
    unsigned               not_available_count;
};

struct map_text {
    enum dig_map_kind    kind;
    unsigned             function;
    bool                 low_word_first, j1939;
    double               coherent_ms;
    double              *stuck_ms;
    struct alive_text   *alive;
    struct message_text *messages;
    unsigned             messages_count;
    struct signal_text  *signals;
    unsigned             signals_count;
};

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL
#define POINTER  CYAML_FLAG_POINTER

static const cyaml_strval_t kinds[] = { { "can", DIG_MAP_CAN }, { "modbus", DIG_MAP_MODBUS } };
static const cyaml_strval_t types[] = {
    { "uint16", DIG_REGISTER_UINT16 },   { "int16", DIG_REGISTER_INT16 },
    { "uint32", DIG_REGISTER_UINT32 },   { "int32", DIG_REGISTER_INT32 },
    { "float32", DIG_REGISTER_FLOAT32 },
};

static const cyaml_schema_value_t raw_value = { CYAML_VALUE_UINT(REQUIRED, uint64_t) };

static const cyaml_schema_field_t alive_fields[] = {
    CYAML_FIELD_STRING_PTR("message", OPTIONAL | POINTER, struct alive_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("signal", OPTIONAL | POINTER, struct alive_text, signal, 1, 63),
    CYAML_FIELD_UINT_PTR("register", OPTIONAL | POINTER, struct alive_text, reg),
    CYAML_FIELD_ENUM("type", OPTIONAL, struct alive_text, type, types, CYAML_ARRAY_LEN(types)),
    CYAML_FIELD_FLOAT("frozen_ms", OPTIONAL, struct alive_text, frozen_ms),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t signal_fields[] = {
    CYAML_FIELD_STRING_PTR("name", POINTER, struct signal_text, name, 1, 63),
    CYAML_FIELD_STRING_PTR("message", OPTIONAL | POINTER, struct signal_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("signal", OPTIONAL | POINTER, struct signal_text, signal, 1, 63),
    CYAML_FIELD_UINT_PTR("register", OPTIONAL | POINTER, struct signal_text, reg),
    CYAML_FIELD_ENUM("type", OPTIONAL, struct signal_text, type, types, CYAML_ARRAY_LEN(types)),
    CYAML_FIELD_INT("sign", OPTIONAL, struct signal_text, sign),
    CYAML_FIELD_FLOAT("scale", OPTIONAL, struct signal_text, scale),
    CYAML_FIELD_FLOAT("offset", OPTIONAL, struct signal_text, offset),
    CYAML_FIELD_FLOAT("min", REQUIRED, struct signal_text, min),
    CYAML_FIELD_FLOAT("max", REQUIRED, struct signal_text, max),
    CYAML_FIELD_FLOAT("max_rate", OPTIONAL, struct signal_text, max_rate),
    CYAML_FIELD_SEQUENCE("not_available", OPTIONAL | POINTER, struct signal_text, not_available,
                         &raw_value, 0, DIG_NOT_AVAILABLE_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t signal_value = { CYAML_VALUE_MAPPING(REQUIRED, struct signal_text,
                                                                       signal_fields) };

static const cyaml_strval_t checksums[] = {
    { "sum8", DIG_CHECKSUM_SUM8 },
    { "xor8", DIG_CHECKSUM_XOR8 },
    { "crc8_sae_j1850", DIG_CHECKSUM_CRC8_SAE_J1850 },
    { "j1939_tsc1", DIG_CHECKSUM_J1939_TSC1 },
};

static const cyaml_schema_field_t checksum_fields[] = {
    CYAML_FIELD_STRING_PTR("signal", POINTER, struct checksum_text, signal, 1, 63),
    CYAML_FIELD_ENUM("kind", REQUIRED, struct checksum_text, kind, checksums,
                     CYAML_ARRAY_LEN(checksums)),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t message_fields[] = {
    CYAML_FIELD_STRING_PTR("message", POINTER, struct message_text, message, 1, 63),
    CYAML_FIELD_STRING_PTR("counter", OPTIONAL | POINTER, struct message_text, counter, 1, 63),
    CYAML_FIELD_FLOAT("delay_ms", OPTIONAL, struct message_text, delay_ms),
    CYAML_FIELD_FLOAT("cycle_ms", OPTIONAL, struct message_text, cycle_ms),
    CYAML_FIELD_MAPPING_PTR("checksum", OPTIONAL | POINTER, struct message_text, checksum,
                            checksum_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t message_value = { CYAML_VALUE_MAPPING(
    REQUIRED, struct message_text, message_fields) };

static const cyaml_schema_field_t map_fields[] = {
    CYAML_FIELD_ENUM("kind", REQUIRED, struct map_text, kind, kinds, CYAML_ARRAY_LEN(kinds)),
    CYAML_FIELD_UINT("function", OPTIONAL, struct map_text, function),
    CYAML_FIELD_BOOL("low_word_first", OPTIONAL, struct map_text, low_word_first),
    CYAML_FIELD_BOOL("j1939", OPTIONAL, struct map_text, j1939),
    CYAML_FIELD_FLOAT("coherent_ms", OPTIONAL, struct map_text, coherent_ms),
    CYAML_FIELD_FLOAT_PTR("stuck_ms", OPTIONAL | POINTER, struct map_text, stuck_ms),
    CYAML_FIELD_SEQUENCE("messages", OPTIONAL | POINTER, struct map_text, messages, &message_value,
                         0, DIG_GROUPS_MAX),
    CYAML_FIELD_MAPPING_PTR("alive", OPTIONAL | POINTER, struct map_text, alive, alive_fields),
    CYAML_FIELD_SEQUENCE("signals", POINTER, struct map_text, signals, &signal_value, 1,
                         DIG_SIGNALS),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(POINTER, struct map_text,
                                                                 map_fields) };

// What is being read, for messages.
struct work {
    const char            *path;
    const struct dig_dbc  *dbc;
    struct dig_signal_map *map;
    struct dig_error      *error;
};

struct key {
    char text[96];
};

static struct key key_of(const char *const parent, const char *const name)
{
    struct key key;
    (void)snprintf(key.text, sizeof key.text, "%.40s.%.40s", parent, name);
    return key;
}

// How far a unit is from SI, and what it measures.
struct unit {
    const char *name;
    char        kind; // p pressure, a angle, t temperature
    double      scale;
};

static const struct unit units[] = {
    { "Pa", 'p', 1.0 },          { "kPa", 'p', 1e3 },
    { "MPa", 'p', 1e6 },         { "bar", 'p', 1e5 },
    { "psi", 'p', 6894.757293 }, { "rad", 'a', 1.0 },
    { "mrad", 'a', 1e-3 },       { "deg", 'a', DIG_RAD_PER_DEG },
    { "degC", 't', 1.0 },
};

static char kind_of(const size_t signal)
{
    if (signal == DIG_SIGNAL_TEMPERATURE_degC) {
        return 't';
    }
    return signal >= DIG_SIGNAL_BOOM_HEAD_Pa && signal <= DIG_SIGNAL_BUCKET_ROD_Pa ? 'p' : 'a';
}

// A scale that contradicts the DBC's unit is a slip, not a calibration: beyond a tenth it is
// refused.
static enum dig_status check_unit(const struct work *const work, const char *const at,
                                  const size_t signal, struct dig_map_entry *const entry,
                                  const bool scale_given)
{
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        const struct unit *const unit = &units[i];
        if (strcmp(unit->name, entry->can.unit) != 0) {
            continue;
        }
        if (unit->kind != kind_of(signal)) {
            const struct key key = key_of(at, "signal");
            return dig_yaml_refuse(work->path, key.text, work->error,
                                   "%s is in %s, expected a signal that can be %s", entry->can.name,
                                   unit->name, dig_signal_name((enum dig_signal)signal));
        }
        if (!scale_given) {
            entry->scale = unit->scale;
        }
        if (!(fabs(entry->scale - unit->scale) <= 0.1 * unit->scale)) {
            const struct key key = key_of(at, "scale");
            return dig_yaml_refuse(work->path, key.text, work->error,
                                   "%g, expected %g (the DBC gives %s in %s)", entry->scale,
                                   unit->scale, entry->can.name, unit->name);
        }
    }
    return DIG_OK;
}

// The group of a message, added when it is new.
static enum dig_status group_of(const struct work *const work, const char *const at,
                                const struct dig_dbc_message *const message, unsigned *const group)
{
    struct dig_signal_map *const map   = work->map;
    const int                    known = dig_signal_map_group(map, message->id, message->extended);
    if (known >= 0) {
        *group = (unsigned)known;
        return DIG_OK;
    }
    if (map->groups == DIG_GROUPS_MAX) {
        const struct key key = key_of(at, "message");
        return dig_yaml_refuse(work->path, key.text, work->error, "expected at most %d messages",
                               DIG_GROUPS_MAX);
    }
    struct dig_map_group *const added = &map->group[map->groups];
    *added                            = (struct dig_map_group){ .id       = message->id,
                                                                .extended = message->extended,
                                                                .bytes    = message->bytes,
                                                                .frame    = { .cycle_s = message->cycle_s } };
    memcpy(added->name, message->name, sizeof added->name);
    *group = (unsigned)map->groups++;
    return DIG_OK;
}

// Where on the CAN bus: message and signal by name.
static enum dig_status find_can(const struct work *const work, const char *const at,
                                const char *const message_name, const char *const signal_name,
                                struct dig_map_entry *const entry)
{
    const struct key message_key = key_of(at, "message");
    const struct key signal_key  = key_of(at, "signal");
    if (message_name == NULL || signal_name == NULL) {
        const struct key *const key = message_name == NULL ? &message_key : &signal_key;
        return dig_yaml_refuse(work->path, key->text, work->error,
                               "missing, expected a name of the DBC");
    }
    const struct dig_dbc_message *const message = dig_dbc_find(work->dbc, message_name);
    if (message == NULL) {
        return dig_yaml_refuse(work->path, message_key.text, work->error,
                               "\"%s\", expected a message of the DBC", message_name);
    }
    const struct dig_dbc_signal *const signal =
        dig_dbc_find_signal(work->dbc, message, signal_name);
    if (signal == NULL) {
        return dig_yaml_refuse(work->path, signal_key.text, work->error,
                               "\"%s\", expected a signal of %s", signal_name, message_name);
    }
    if (signal->multiplexed || signal->is_float) {
        return dig_yaml_refuse(work->path, signal_key.text, work->error,
                               "\"%s\" is %s, expected a plain integer signal", signal_name,
                               signal->multiplexed ? "multiplexed" : "floating-point");
    }
    entry->can = *signal;
    return group_of(work, at, message, &entry->group);
}

static unsigned words_of(const enum dig_register_type type)
{
    return type == DIG_REGISTER_UINT16 || type == DIG_REGISTER_INT16 ? 1 : 2;
}

// Where in the registers; the polled block grows to hold it.
static enum dig_status find_register(const struct work *const work, const char *const at,
                                     const unsigned *const reg, struct dig_map_entry *const entry)
{
    const struct key             key = key_of(at, "register");
    struct dig_signal_map *const map = work->map;
    if (reg == NULL) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               "missing, expected the register's address, counted from 0");
    }
    const unsigned last = *reg + words_of(entry->type);
    if (*reg > 0xFFFF || last > 0x10000) {
        return dig_yaml_refuse(work->path, key.text, work->error, "%u, expected 0 … 65535", *reg);
    }
    entry->reg = *reg;
    const unsigned first =
        map->registers == 0 || *reg < map->first_register ? *reg : map->first_register;
    const unsigned old_end = map->first_register + map->registers;
    const unsigned end     = map->registers == 0 || last > old_end ? last : old_end;
    if (end - first > DIG_REGISTERS_MAX) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               "%u, expected all registers within a block of %d", *reg,
                               DIG_REGISTERS_MAX);
    }
    map->first_register = first;
    map->registers      = end - first;
    return DIG_OK;
}

static enum dig_status read_signal(const struct work *const work, const size_t index,
                                   const struct signal_text *const text)
{
    struct key at;
    (void)snprintf(at.text, sizeof at.text, "signals[%zu]", index);
    const struct key name_key = key_of(at.text, "name");
    const int        signal   = dig_signal_find(text->name);
    if (signal < 0) {
        return dig_yaml_refuse(work->path, name_key.text, work->error,
                               "\"%s\", expected a column of a machine recording (boom_rad, …)",
                               text->name);
    }
    if (work->map->entry[signal].used) {
        return dig_yaml_refuse(work->path, name_key.text, work->error,
                               "\"%s\" again, expected every signal once", text->name);
    }
    if (text->sign != 0 && text->sign != 1 && text->sign != -1) {
        const struct key key = key_of(at.text, "sign");
        return dig_yaml_refuse(work->path, key.text, work->error, "%d, expected 1 or -1",
                               text->sign);
    }
    if (!(text->min < text->max)) {
        const struct key key = key_of(at.text, "max");
        return dig_yaml_refuse(work->path, key.text, work->error, "%g, expected more than min %g",
                               text->max, text->min);
    }
    if (!(text->max_rate >= 0.0)) {
        const struct key key = key_of(at.text, "max_rate");
        return dig_yaml_refuse(work->path, key.text, work->error, "%g, expected 0 (any) or more",
                               text->max_rate);
    }
    const bool           scale_given = fabs(text->scale) > 0.0;
    struct dig_map_entry entry       = {
              .used          = true,
              .type          = text->type,
              .sign          = text->sign < 0 ? -1.0 : 1.0,
              .scale         = scale_given ? text->scale : 1.0,
              .offset        = text->offset,
              .max_rate      = text->max_rate,
              .min           = text->min,
              .max           = text->max,
              .not_available = text->not_available_count,
    };
    for (size_t i = 0; i < entry.not_available; i++) {
        entry.not_available_raw[i] = text->not_available[i];
    }
    enum dig_status status;
    if (work->map->kind == DIG_MAP_CAN) {
        status = find_can(work, at.text, text->message, text->signal, &entry);
        if (status == DIG_OK) {
            status = check_unit(work, at.text, (size_t)signal, &entry, scale_given);
        }
        if (status == DIG_OK && signal < (int)DIG_SIGNALS_NEEDED) {
            work->map->group[entry.group].needed = true;
        }
    } else {
        status = find_register(work, at.text, text->reg, &entry);
    }
    if (status == DIG_OK) {
        work->map->entry[signal] = entry;
    }
    return status;
}

static enum dig_status read_alive(const struct work *const       work,
                                  const struct alive_text *const text)
{
    struct dig_map_entry entry  = { .used = true, .type = text->type, .sign = 1.0, .scale = 1.0 };
    enum dig_status      status = work->map->kind == DIG_MAP_CAN
                                      ? find_can(work, "alive", text->message, text->signal, &entry)
                                      : find_register(work, "alive", text->reg, &entry);
    if (status == DIG_OK && !(text->frozen_ms >= 0.0 && text->frozen_ms <= 60e3)) {
        status = dig_yaml_refuse(work->path, "alive.frozen_ms", work->error,
                                 "%g, expected 0 … 60000", text->frozen_ms);
    }
    if (status == DIG_OK) {
        work->map->has_alive = true;
        work->map->alive     = entry;
        work->map->frozen_s  = text->frozen_ms > 0.0 ? text->frozen_ms * 1e-3 : 0.5;
    }
    return status;
}

// A signal of the frame that is no value: its counter, its checksum.
static enum dig_status find_own(const struct work *const work, const char *const at,
                                const char *const key_name, const char *const message,
                                const char *const signal, struct dig_dbc_signal *const found)
{
    struct dig_map_entry  entry  = { .used = true };
    const struct key      key    = key_of(at, key_name);
    const enum dig_status status = find_can(work, at, message, signal, &entry);
    if (status != DIG_OK) {
        return status;
    }
    if (entry.can.bits > 32) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               "\"%s\" has %u bits, expected at most 32", signal, entry.can.bits);
    }
    *found = entry.can;
    return DIG_OK;
}

static enum dig_status read_checksum(const struct work *const work, const char *const at,
                                     const struct message_text *const text,
                                     struct dig_map_group *const      group)
{
    const struct key      key = key_of(at, "checksum");
    const enum dig_status status =
        find_own(work, at, "checksum", text->message, text->checksum->signal, &group->checksum_at);
    if (status != DIG_OK) {
        return status;
    }
    const bool     tsc1 = text->checksum->kind == DIG_CHECKSUM_J1939_TSC1;
    const unsigned bits = group->checksum_at.bits;
    const unsigned from = group->checksum_at.start_bit % 8;
    if (tsc1 ? bits > 4 || text->counter == NULL
             : bits != 8 || from != (group->checksum_at.intel ? 0U : 7U)) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               tsc1 ? "expected up to 4 bits, and a counter beside it"
                                    : "expected a signal of one whole byte");
    }
    group->checksum = text->checksum->kind;
    return DIG_OK;
}

// What is said of a message beyond its signals. It must carry one that is mapped.
static enum dig_status read_message(const struct work *const work, const size_t index,
                                    const struct message_text *const text)
{
    struct key at;
    (void)snprintf(at.text, sizeof at.text, "messages[%zu]", index);
    const struct key                    key     = key_of(at.text, "message");
    const struct dig_dbc_message *const message = dig_dbc_find(work->dbc, text->message);
    const int                           known =
        message != NULL ? dig_signal_map_group(work->map, message->id, message->extended) : -1;
    if (known < 0) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               "\"%s\", expected a message that carries one of the signals",
                               text->message);
    }
    struct dig_map_group *const group = &work->map->group[known];
    if (!(text->delay_ms >= 0.0 && text->delay_ms <= 1000.0)) {
        const struct key delay = key_of(at.text, "delay_ms");
        return dig_yaml_refuse(work->path, delay.text, work->error, "%g, expected 0 … 1000",
                               text->delay_ms);
    }
    if (!(text->cycle_ms >= 0.0 && text->cycle_ms <= 60e3)) {
        const struct key cycle = key_of(at.text, "cycle_ms");
        return dig_yaml_refuse(work->path, cycle.text, work->error, "%g, expected 0 … 60000",
                               text->cycle_ms);
    }
    group->frame.delay_s = text->delay_ms * 1e-3;
    group->frame.cycle_s = text->cycle_ms > 0.0 ? text->cycle_ms * 1e-3 : group->frame.cycle_s;

    enum dig_status status = DIG_OK;
    if (text->counter != NULL) {
        status = find_own(work, at.text, "counter", text->message, text->counter, &group->counter);
        group->frame.counter_mod = group->counter.bits > 0 && group->counter.bits < 32
                                       ? 1U << group->counter.bits
                                       : UINT32_MAX;
    }
    return status == DIG_OK && text->checksum != NULL ? read_checksum(work, at.text, text, group)
                                                      : status;
}

// What holds for the map as a whole, whatever its signals are.
static enum dig_status check_map(const struct work *const work, const struct map_text *const text)
{
    if (text->kind == DIG_MAP_CAN && work->dbc == NULL) {
        return dig_yaml_refuse(work->path, "kind", work->error,
                               "can, expected modbus for this input");
    }
    if (text->function != 0 && text->function != 3 && text->function != 4) {
        return dig_yaml_refuse(work->path, "function", work->error,
                               "%u, expected 4 (input registers) or 3 (holding registers)",
                               text->function);
    }
    if (!(text->coherent_ms >= 0.0 && text->coherent_ms <= 1000.0)) {
        return dig_yaml_refuse(work->path, "coherent_ms", work->error, "%g, expected 0 … 1000",
                               text->coherent_ms);
    }
    if (text->stuck_ms != NULL && !(*text->stuck_ms >= 0.0 && *text->stuck_ms <= 60e3)) {
        return dig_yaml_refuse(work->path, "stuck_ms", work->error, "%g, expected 0 … 60000",
                               *text->stuck_ms);
    }
    if (text->kind != DIG_MAP_CAN && (text->messages_count > 0 || text->j1939)) {
        return dig_yaml_refuse(work->path, text->j1939 ? "j1939" : "messages", work->error,
                               "given for modbus, expected with kind: can only");
    }
    return DIG_OK;
}

// What the moment needs must be there. A cylinder's force is told by both of its chambers.
static enum dig_status check_signals(const struct work *const work)
{
    const struct dig_map_entry *const entry = work->map->entry;
    for (int i = 0; i < DIG_SIGNALS_NEEDED; i++) {
        if (!entry[i].used && dig_signal_tells_moment((enum dig_signal)i)) {
            return dig_yaml_refuse(work->path, "signals", work->error,
                                   "no entry %s, expected one for each angle and both pressures of "
                                   "the bucket's cylinder",
                                   dig_signal_name((enum dig_signal)i));
        }
    }
    for (int i = DIG_SIGNAL_BOOM_HEAD_Pa; i < DIG_SIGNALS_NEEDED; i += 2) {
        if (entry[i].used != entry[i + 1].used) {
            return dig_yaml_refuse(work->path, "signals", work->error,
                                   "no entry %s, expected both pressures of a cylinder or none",
                                   dig_signal_name((enum dig_signal)(entry[i].used ? i + 1 : i)));
        }
    }
    return DIG_OK;
}

static enum dig_status read_map(const struct work *const work, const struct map_text *const text)
{
    struct dig_signal_map *const map    = work->map;
    enum dig_status              status = check_map(work, text);
    if (status != DIG_OK) {
        return status;
    }
    map->kind           = text->kind;
    map->function       = text->function == 3 ? 3 : 4;
    map->low_word_first = text->low_word_first;
    map->j1939          = text->j1939;
    map->stuck_s        = text->stuck_ms != NULL ? *text->stuck_ms * 1e-3 : 0.5;
    map->coherent_s     = text->coherent_ms > 0.0 ? text->coherent_ms * 1e-3 : 6e-3;

    for (unsigned i = 0; status == DIG_OK && i < text->signals_count; i++) {
        status = read_signal(work, i, &text->signals[i]);
    }
    if (status == DIG_OK && text->alive != NULL) {
        status = read_alive(work, text->alive);
    }
    for (unsigned i = 0; status == DIG_OK && i < text->messages_count; i++) {
        status = read_message(work, i, &text->messages[i]);
    }
    return status == DIG_OK ? check_signals(work) : status;
}

enum dig_status dig_signal_map_read(const char *const path, const struct dig_dbc *const dbc,
                                    struct dig_signal_map *const map, struct dig_error *const error)
{
    assert(path != NULL && map != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_signal_map loaded = { 0 };
    const struct work     work   = { .path = path, .dbc = dbc, .map = &loaded, .error = error };
    status                       = read_map(&work, (const struct map_text *)data);
    dig_yaml_free(&schema, data);
    if (status == DIG_OK) {
        *map = loaded;
    }
    return status;
}
