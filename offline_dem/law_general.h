// Contact laws beyond the plain one of law.h, chosen by fields of struct dig_law.

#ifndef DIG_OFFLINE_DEM_LAW_GENERAL_H
#define DIG_OFFLINE_DEM_LAW_GENERAL_H

#include "offline_dem/law.h"

/// As dig_law_step(), for laws whose `general` is set.
__attribute__((always_inline)) static inline struct dig_push
dig_law_general(const struct dig_law law, const double dt_s, const struct dig_touch touch,
                struct dig_memory *const memory)
{
    return dig_law_step(law, dt_s, touch, memory);
}

#endif // DIG_OFFLINE_DEM_LAW_GENERAL_H
