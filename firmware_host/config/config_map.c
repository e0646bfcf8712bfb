// The signal map's YAML, checked and made into a map. Named config_* with the daemon's own
// configuration: the files that know libcyaml.

#include "core/units.h"
#include "files/yaml.h"
#include "firmware_host/bus/register_plan.h"
#include "firmware_host/bus/signal_map.h"
#include "firmware_host/config/config_map_text.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

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
    char        kind; // p pressure, a angle, t temperature, l length, f force, m moment
    double      scale;
};

static const struct unit units[] = {
    { "Pa", 'p', 1.0 },          { "kPa", 'p', 1e3 },
    { "MPa", 'p', 1e6 },         { "bar", 'p', 1e5 },
    { "psi", 'p', 6894.757293 }, { "rad", 'a', 1.0 },
    { "mrad", 'a', 1e-3 },       { "deg", 'a', DIG_RAD_PER_DEG },
    { "degC", 't', 1.0 },        { "m", 'l', 1.0 },
    { "mm", 'l', 1e-3 },         { "N", 'f', 1.0 },
    { "Nm", 'm', 1.0 },
};

static char kind_of(const size_t signal)
{
    switch ((enum dig_signal)signal) {
    case DIG_SIGNAL_BOOM_rad:
    case DIG_SIGNAL_ARM_rad:
    case DIG_SIGNAL_BUCKET_rad:
    case DIG_SIGNAL_PITCH_rad: return 'a';
    case DIG_SIGNAL_TEMPERATURE_degC: return 't';
    case DIG_SIGNAL_PIN_X_m:
    case DIG_SIGNAL_PIN_Z_m: return 'l';
    case DIG_SIGNAL_SENSOR_FX_N:
    case DIG_SIGNAL_SENSOR_FZ_N: return 'f';
    case DIG_SIGNAL_SENSOR_MY_Nm: return 'm';
    case DIG_SIGNAL_BOOM_HEAD_Pa:
    case DIG_SIGNAL_BOOM_ROD_Pa:
    case DIG_SIGNAL_ARM_HEAD_Pa:
    case DIG_SIGNAL_ARM_ROD_Pa:
    case DIG_SIGNAL_BUCKET_HEAD_Pa:
    case DIG_SIGNAL_BUCKET_ROD_Pa:
    case DIG_SIGNALS: break;
    }
    return 'p';
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

// Where in the registers.
static enum dig_status find_register(const struct work *const work, const char *const at,
                                     const unsigned *const reg, struct dig_map_entry *const entry)
{
    const struct key key = key_of(at, "register");
    if (reg == NULL) {
        return dig_yaml_refuse(work->path, key.text, work->error,
                               "missing, expected the register's address, counted from 0");
    }
    if (*reg > 0xFFFF || *reg + dig_register_words(entry->type) > 0x10000) {
        return dig_yaml_refuse(work->path, key.text, work->error, "%u, expected 0 … 65535", *reg);
    }
    entry->reg = *reg;
    return DIG_OK;
}

static enum dig_status read_signal(const struct work *const work, const size_t index,
                                   const struct dig_signal_text *const text)
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
    } else {
        status = find_register(work, at.text, text->reg, &entry);
    }
    if (status == DIG_OK) {
        work->map->entry[signal] = entry;
    }
    return status;
}

static enum dig_status read_alive(const struct work *const           work,
                                  const struct dig_alive_text *const text)
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
                                     const struct dig_message_text *const text,
                                     struct dig_map_group *const          group)
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
                                    const struct dig_message_text *const text)
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
static enum dig_status check_map(const struct work *const         work,
                                 const struct dig_map_text *const text)
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
    if (text->kind == DIG_MAP_CAN && text->blocks_count > 0) {
        return dig_yaml_refuse(work->path, "blocks", work->error,
                               "given for can, expected with kind: modbus only");
    }
    if (text->kind != DIG_MAP_CAN && (text->messages_count > 0 || text->j1939)) {
        return dig_yaml_refuse(work->path, text->j1939 ? "j1939" : "messages", work->error,
                               "given for modbus, expected with kind: can only");
    }
    return DIG_OK;
}

static enum dig_status read_block(const struct work *const work, const size_t index,
                                  const struct dig_block_text *const text, const unsigned function,
                                  struct dig_map_group *const group)
{
    const struct {
        const char *key;
        double      value, low, high;
    } ranges[] = {
        { "register", *text->reg, 0.0, 65535.0 },
        { "registers", text->registers, 1.0, fmin(DIG_REGISTERS_MAX, 65536.0 - *text->reg) },
        { "function", text->function, text->function == 0 ? 0.0 : 3.0, 4.0 },
        { "poll_Hz", text->poll_Hz, fabs(text->poll_Hz) > 0.0 ? 0.01 : 0.0, 1000.0 },
        { "delay_ms", text->delay_ms, 0.0, 1000.0 },
    };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        if (!(ranges[i].value >= ranges[i].low && ranges[i].value <= ranges[i].high)) {
            struct key at;
            (void)snprintf(at.text, sizeof at.text, "blocks[%zu].%s", index, ranges[i].key);
            return dig_yaml_refuse(work->path, at.text, work->error, "%g, expected %g … %g",
                                   ranges[i].value, ranges[i].low, ranges[i].high);
        }
    }
    *group = (struct dig_map_group){
        .first_register = *text->reg,
        .registers      = text->registers,
        .function       = text->function != 0 ? text->function : function,
        .poll_s         = text->poll_Hz > 0.0 ? 1.0 / text->poll_Hz : 0.0,
        .frame          = { .delay_s = text->delay_ms * 1e-3 },
    };
    return DIG_OK;
}

// The blocks as the map names them, with every register in one; else as they are made.
static enum dig_status read_blocks(const struct work *const         work,
                                   const struct dig_map_text *const text)
{
    struct dig_signal_map *const map      = work->map;
    const unsigned               function = text->function == 3 ? 3 : 4;
    if (text->blocks_count == 0) {
        dig_register_plan(map, function);
        return DIG_OK;
    }
    enum dig_status status = DIG_OK;
    for (unsigned i = 0; status == DIG_OK && i < text->blocks_count; i++) {
        status = read_block(work, i, &text->blocks[i], function, &map->group[map->groups++]);
    }
    for (unsigned i = 0; status == DIG_OK && i < text->signals_count; i++) {
        if (!dig_register_assign(map, &map->entry[dig_signal_find(text->signals[i].name)])) {
            struct key at;
            (void)snprintf(at.text, sizeof at.text, "signals[%u].register", i);
            status =
                dig_yaml_refuse(work->path, at.text, work->error,
                                "%u, expected it within one of the blocks", *text->signals[i].reg);
        }
    }
    if (status == DIG_OK && map->has_alive && !dig_register_assign(map, &map->alive)) {
        status = dig_yaml_refuse(work->path, "alive.register", work->error,
                                 "%u, expected it within one of the blocks", map->alive.reg);
    }
    return status;
}

// What the moment needs must be there, and nothing of the other kind of machine. A cylinder's force
// is told by both of its chambers.
static enum dig_status check_signals(const struct work *const work)
{
    const struct dig_map_entry *const entry   = work->map->entry;
    const enum dig_sensing            sensing = dig_signal_map_sensing(work->map);
    const bool                        sensor  = sensing == DIG_SENSING_SENSOR;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        const enum dig_signal signal = (enum dig_signal)i;
        if (!entry[i].used && dig_signal_tells_moment(sensing, signal)) {
            return dig_yaml_refuse(work->path, "signals", work->error, "no entry %s, expected %s",
                                   dig_signal_name(signal),
                                   sensor ? "the pin's place, the bucket's angle and all that the "
                                            "force sensor reads"
                                          : "one for each angle and both pressures of the "
                                            "bucket's cylinder");
        }
        if (entry[i].used && !dig_signal_is_optional(signal) &&
            !dig_signal_is_needed(sensing, signal)) {
            return dig_yaml_refuse(work->path, "signals", work->error,
                                   "entry %s, expected signals of cylinders or of a force sensor, "
                                   "not of both",
                                   dig_signal_name(signal));
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

// Polls follow each other, and values are interpolated to one time: blocks may lie this far apart.
static const double coherent_polls_s = 0.2;

static enum dig_status read_map(const struct work *const         work,
                                const struct dig_map_text *const text)
{
    struct dig_signal_map *const map    = work->map;
    enum dig_status              status = check_map(work, text);
    if (status != DIG_OK) {
        return status;
    }
    map->kind           = text->kind;
    map->low_word_first = text->low_word_first;
    map->j1939          = text->j1939;
    map->stuck_s        = text->stuck_ms != NULL ? *text->stuck_ms * 1e-3 : 0.5;
    map->coherent_s     = text->coherent_ms > 0.0     ? text->coherent_ms * 1e-3
                          : text->kind == DIG_MAP_CAN ? 6e-3
                                                      : coherent_polls_s;

    for (unsigned i = 0; status == DIG_OK && i < text->signals_count; i++) {
        status = read_signal(work, i, &text->signals[i]);
    }
    if (status == DIG_OK && text->alive != NULL) {
        status = read_alive(work, text->alive);
    }
    for (unsigned i = 0; status == DIG_OK && i < text->messages_count; i++) {
        status = read_message(work, i, &text->messages[i]);
    }
    if (status == DIG_OK && map->kind == DIG_MAP_MODBUS) {
        status = read_blocks(work, text);
    }
    const enum dig_sensing sensing = dig_signal_map_sensing(map);
    for (size_t i = 0; status == DIG_OK && i < DIG_SIGNALS; i++) {
        if (map->entry[i].used && dig_signal_is_needed(sensing, (enum dig_signal)i)) {
            struct dig_map_group *const group = &map->group[map->entry[i].group];
            group->spared                     = (group->spared || !group->needed) &&
                            !dig_signal_tells_moment(sensing, (enum dig_signal)i);
            group->needed = true;
        }
    }
    return status == DIG_OK ? check_signals(work) : status;
}

enum dig_status dig_signal_map_read(const char *const path, const struct dig_dbc *const dbc,
                                    struct dig_signal_map *const map, struct dig_error *const error)
{
    assert(path != NULL && map != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &dig_map_schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_signal_map loaded = { 0 };
    const struct work     work   = { .path = path, .dbc = dbc, .map = &loaded, .error = error };
    status                       = read_map(&work, (const struct dig_map_text *)data);
    dig_yaml_free(&dig_map_schema, data);
    if (status == DIG_OK) {
        *map = loaded;
    }
    return status;
}
