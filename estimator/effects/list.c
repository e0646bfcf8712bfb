#include "estimator/effects/list.h"

#include <assert.h>
#include <math.h>

// clang-format off
#define ENTRY(id, name) [DIG_EFFECT_##id] = &dig_effect_##name,
static const struct dig_effect *const list[DIG_EFFECTS] = {
    DIG_EFFECTS_OF_MACHINE(ENTRY)
    DIG_EFFECTS_OF_SOIL(ENTRY)
};
#undef ENTRY
// clang-format on

const struct dig_effect *dig_effect_of(const enum dig_effect_id id)
{
    assert(id >= 0 && id < DIG_EFFECTS);
    return list[id];
}

bool dig_effect_is_by_dig(const enum dig_effect_id id)
{
    return list[id] != NULL && list[id]->by != DIG_BY_NOTHING;
}

double dig_effect_share(const enum dig_effect_id id, const struct dig_effect_dig *const dig)
{
    switch (list[id] != NULL ? list[id]->by : DIG_BY_NOTHING) {
    case DIG_BY_PACE: return log(dig->pace);
    case DIG_BY_ORDER: return (double)dig->order;
    case DIG_BY_PASS: return dig->pass > 1 ? (double)dig->pass - 1.0 : 0.0;
    case DIG_BY_NOTHING: break;
    }
    return 1.0;
}
