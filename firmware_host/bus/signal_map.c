#include "firmware_host/bus/signal_map.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static bool is_not_available(const struct dig_map_entry *const entry, const uint64_t raw)
{
    for (size_t i = 0; i < entry->not_available; i++) {
        if (entry->not_available_raw[i] == raw) {
            return true;
        }
    }
    return false;
}

// The values J1939-71 reserves for "error" and "not available" in a field of so many bits.
static bool is_reserved(const unsigned bits, const uint64_t raw)
{
    if (bits < 8 || (bits > 8 && bits < 16)) {
        const uint64_t top = (UINT64_C(1) << bits) - 1;
        return bits > 1 && raw >= top - 1;
    }
    return raw >> (bits - 8) >= 0xFBU;
}

static void decode(const struct dig_map_entry *const entry, const uint64_t raw,
                   const double physical, uint8_t *const state, double *const value)
{
    const double si = entry->sign * (entry->scale * physical + entry->offset);
    if (is_not_available(entry, raw)) {
        *state = DIG_READING_NOT_AVAILABLE;
    } else if (!isfinite(si)) {
        *state = DIG_READING_NAN;
    } else if (!(si >= entry->min && si <= entry->max)) {
        *state = DIG_READING_OUT_OF_RANGE;
    } else {
        *state = DIG_READING_OK;
        *value = si;
    }
}

enum dig_sensing dig_signal_map_sensing(const struct dig_signal_map *const map)
{
    assert(map != NULL);
    bool used[DIG_SIGNALS];
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        used[i] = map->entry[i].used;
    }
    return dig_signals_sensing(used);
}

int dig_signal_map_group(const struct dig_signal_map *const map, const uint32_t id,
                         const bool extended)
{
    assert(map != NULL);
    for (size_t i = 0; i < map->groups; i++) {
        if (map->group[i].id == id && map->group[i].extended == extended) {
            return (int)i;
        }
    }
    return -1;
}

enum dig_status dig_signal_map_frame(const struct dig_signal_map *const map, const unsigned group,
                                     const size_t bytes, const uint8_t data[],
                                     const int64_t time_ns, struct dig_reading *const reading)
{
    assert(map != NULL && map->kind == DIG_MAP_CAN && group < map->groups && reading != NULL);
    const struct dig_map_group *const g = &map->group[group];
    if (bytes < g->bytes) {
        return DIG_EINVAL;
    }
    struct dig_reading out = { .time_ns = time_ns, .group = group };
    out.counter            = g->frame.counter_mod > 0 ? dig_dbc_raw(&g->counter, data) : 0;
    if (g->checksum != DIG_CHECKSUM_NONE &&
        dig_dbc_raw(&g->checksum_at, data) != dig_checksum_of(g->checksum, g->bytes, data,
                                                              g->checksum_at.start_bit / 8, g->id,
                                                              out.counter)) {
        return DIG_ESTALE;
    }
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        const struct dig_map_entry *const entry = &map->entry[i];
        if (entry->used && entry->group == group) {
            const uint64_t raw = dig_dbc_raw(&entry->can, data);
            decode(entry, raw, dig_dbc_value(&entry->can, raw), &out.state[i], &out.value[i]);
            if (map->j1939 && is_reserved(entry->can.bits, raw)) {
                out.state[i] = DIG_READING_NOT_AVAILABLE;
            }
        }
    }
    if (map->has_alive && map->alive.group == group) {
        out.has_alive = true;
        out.alive     = dig_dbc_raw(&map->alive.can, data);
    }
    *reading = out;
    return DIG_OK;
}

// One or two registers as a raw value; the first is the high word unless the map says otherwise.
static uint64_t raw_of(const struct dig_signal_map *const map,
                       const struct dig_map_entry *const entry, const uint16_t registers[])
{
    const size_t at = entry->reg - map->group[entry->group].first_register;
    if (entry->type == DIG_REGISTER_UINT16 || entry->type == DIG_REGISTER_INT16) {
        return registers[at];
    }
    const uint64_t first  = registers[at];
    const uint64_t second = registers[at + 1];
    return map->low_word_first ? (second << 16) | first : (first << 16) | second;
}

static double physical_of(const enum dig_register_type type, const uint64_t raw)
{
    switch (type) {
    case DIG_REGISTER_INT16: return raw < 0x8000U ? (double)raw : (double)raw - 65536.0;
    case DIG_REGISTER_INT32: return raw < 0x80000000U ? (double)raw : (double)raw - 4294967296.0;
    case DIG_REGISTER_FLOAT32: {
        const uint32_t bits = (uint32_t)raw;
        float          number;
        memcpy(&number, &bits, sizeof number);
        return (double)number;
    }
    case DIG_REGISTER_UINT16:
    case DIG_REGISTER_UINT32: break;
    }
    return (double)raw;
}

void dig_signal_map_registers(const struct dig_signal_map *const map, const unsigned group,
                              const uint16_t registers[], const int64_t time_ns,
                              struct dig_reading *const reading)
{
    assert(map != NULL && map->kind == DIG_MAP_MODBUS && group < map->groups && reading != NULL);
    struct dig_reading out = { .time_ns = time_ns, .group = group };
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        const struct dig_map_entry *const entry = &map->entry[i];
        if (entry->used && entry->group == group) {
            const uint64_t raw = raw_of(map, entry, registers);
            decode(entry, raw, physical_of(entry->type, raw), &out.state[i], &out.value[i]);
        }
    }
    if (map->has_alive && map->alive.group == group) {
        out.has_alive = true;
        out.alive     = raw_of(map, &map->alive, registers);
    }
    *reading = out;
}
