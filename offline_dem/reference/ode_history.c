#include "offline_dem/reference/ode_history.h"

#include <stdlib.h>
#include <string.h>

#define ROOM_LEAST 1024

// Never 0: a free slot's key.
static uint64_t key_of(const uint32_t a, const uint32_t b)
{
    return ((uint64_t)a << 32 | b) + 1;
}

// The slot that holds the key, or the free one where it would stand. Fibonacci hashing.
static struct dig_ode_slot *find(struct dig_ode_slot *const slot, const size_t room,
                                 const uint64_t key)
{
    size_t place = (size_t)((key * 0x9E3779B97F4A7C15U) >> 20) & (room - 1);
    while (slot[place].key != 0 && slot[place].key != key) {
        place = (place + 1) & (room - 1);
    }
    return &slot[place];
}

static bool grow(struct dig_ode_history *const map, const int table)
{
    const size_t               room = map->room[table] == 0 ? ROOM_LEAST : 2 * map->room[table];
    struct dig_ode_slot *const slot = calloc(room, sizeof *slot);
    if (slot == NULL) {
        return false;
    }
    for (size_t k = 0; k < map->room[table]; k++) {
        if (map->slot[table][k].key != 0) {
            *find(slot, room, map->slot[table][k].key) = map->slot[table][k];
        }
    }
    free(map->slot[table]);
    map->slot[table] = slot;
    map->room[table] = room;
    return true;
}

const struct dig_contact_history *dig_ode_history_previous(const struct dig_ode_history *const map,
                                                           const uint32_t a, const uint32_t b)
{
    const int was = 1 - map->now;
    if (map->used[was] == 0) {
        return NULL;
    }
    const struct dig_ode_slot *const slot = find(map->slot[was], map->room[was], key_of(a, b));
    return slot->key != 0 ? &slot->history : NULL;
}

struct dig_contact_history *dig_ode_history_of(struct dig_ode_history *const map, const uint32_t a,
                                               const uint32_t b)
{
    const int now = map->now;
    if (2 * (map->used[now] + 1) > map->room[now] && !grow(map, now)) {
        return NULL;
    }
    struct dig_ode_slot *const slot = find(map->slot[now], map->room[now], key_of(a, b));
    if (slot->key == 0) {
        const struct dig_contact_history *const was = dig_ode_history_previous(map, a, b);
        slot->key                                   = key_of(a, b);
        slot->history = was != NULL ? *was : (struct dig_contact_history){ 0 };
        map->used[now]++;
    }
    return &slot->history;
}

void dig_ode_history_end_step(struct dig_ode_history *const map)
{
    map->now      = 1 - map->now;
    const int now = map->now;
    if (map->used[now] > 0) {
        memset(map->slot[now], 0, map->room[now] * sizeof *map->slot[now]);
    }
    map->used[now] = 0;
}

void dig_ode_history_finish(struct dig_ode_history *const map)
{
    free(map->slot[0]);
    free(map->slot[1]);
    *map = (struct dig_ode_history){ 0 };
}
