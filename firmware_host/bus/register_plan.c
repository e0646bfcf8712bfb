#include "firmware_host/bus/register_plan.h"

#include <assert.h>

unsigned dig_register_words(const enum dig_register_type type)
{
    return type == DIG_REGISTER_UINT16 || type == DIG_REGISTER_INT16 ? 1 : 2;
}

static unsigned end_of(const struct dig_map_entry *const entry)
{
    return entry->reg + dig_register_words(entry->type);
}

bool dig_register_assign(const struct dig_signal_map *const map, struct dig_map_entry *const entry)
{
    assert(map != NULL && entry != NULL);
    for (size_t g = 0; g < map->groups; g++) {
        const struct dig_map_group *const group = &map->group[g];
        if (entry->reg >= group->first_register &&
            end_of(entry) <= group->first_register + group->registers) {
            entry->group = (unsigned)g;
            return true;
        }
    }
    return false;
}

// The entry with the lowest register that no block holds yet; NULL: all are held.
static struct dig_map_entry *lowest(struct dig_signal_map *const map)
{
    struct dig_map_entry *found = NULL;
    for (size_t i = 0; i <= DIG_SIGNALS; i++) {
        struct dig_map_entry *const entry = i < DIG_SIGNALS ? &map->entry[i] : &map->alive;
        if (entry->used && !dig_register_assign(map, entry) &&
            (found == NULL || entry->reg < found->reg)) {
            found = entry;
        }
    }
    return found;
}

void dig_register_plan(struct dig_signal_map *const map, const unsigned function)
{
    assert(map != NULL && map->groups == 0);
    for (struct dig_map_entry *entry = lowest(map); entry != NULL; entry = lowest(map)) {
        struct dig_map_group *last = map->groups > 0 ? &map->group[map->groups - 1] : NULL;
        if (last == NULL || end_of(entry) > last->first_register + DIG_REGISTERS_MAX) {
            assert(map->groups < DIG_GROUPS_MAX); // more than there are signals
            last  = &map->group[map->groups++];
            *last = (struct dig_map_group){ .first_register = entry->reg, .function = function };
        }
        last->registers = end_of(entry) - last->first_register;
    }
}
