#include "core/effect.h"

#include <assert.h>
#include <string.h>

// clang-format off
#define NAME(id, name) [DIG_EFFECT_##id] = #name,
static const char *const names[DIG_EFFECTS] = {
    DIG_EFFECTS_OF_MACHINE(NAME)
    DIG_EFFECTS_OF_SOIL(NAME)
    [DIG_EFFECT_UNLISTED] = "unlisted",
};
#undef NAME
// clang-format on

const char *dig_effect_name(const enum dig_effect_id effect)
{
    assert(effect >= 0 && effect < DIG_EFFECTS);
    return names[effect];
}

int dig_effect_find(const char *const name)
{
    assert(name != NULL);
    for (int e = 0; e < DIG_EFFECTS; e++) {
        if (strcmp(names[e], name) == 0) {
            return e;
        }
    }
    return -1;
}

size_t dig_effect_place(const size_t n, const enum dig_effect_id list[],
                        const enum dig_effect_id effect)
{
    size_t place = 0;
    while (place < n && list[place] != effect) {
        place++;
    }
    return place;
}

bool dig_effect_is_of_machine(const enum dig_effect_id effect)
{
    return (int)effect < DIG_MACHINE_EFFECTS;
}

struct dig_gravel dig_effect_layer_gravel(const bool loose)
{
    return loose ? (struct dig_gravel){ { 0.3, 0.3, 1500.0 } }
                 : (struct dig_gravel){ { 0.9, 0.9, 4000.0 } };
}
