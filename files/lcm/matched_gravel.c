#include "files/lcm/matched_gravel.h"

#include "core/text.h"

#include <assert.h>
#include <math.h>

static bool is_gravel(const struct dig_gravel *const gravel)
{
    int a = 0;
    while (a < DIG_AXES && fabs(gravel->value[a]) < 1e6) {
        a++;
    }
    return a == DIG_AXES;
}

bool dig_matched_gravel_take(const digsight_match_t *const    m,
                             struct dig_matched_gravel *const matched)
{
    assert(m != NULL && matched != NULL);
    struct dig_matched_gravel g = {
        .known      = m->valid != 0,
        .outside    = m->outside != 0,
        .forces     = m->forces != 0,
        .going_on   = m->going_on != 0,
        .gravel     = { { m->friction, m->rolling, m->density_kgpm3 } },
        .low        = { { m->friction_low, m->rolling_low, m->density_low_kgpm3 } },
        .high       = { { m->friction_high, m->rolling_high, m->density_high_kgpm3 } },
        .nearest    = { { m->nearest_friction, m->nearest_rolling, m->nearest_density_kgpm3 } },
        .digs       = m->digs,
        .expires_ns = m->expires_ns,
    };
    if (g.known && !(is_gravel(&g.gravel) && is_gravel(&g.low) && is_gravel(&g.high) &&
                     is_gravel(&g.nearest))) {
        return false;
    }
    dig_text_copy(sizeof g.untold, g.untold, m->untold);
    dig_text_copy(sizeof g.untold_words, g.untold_words, m->untold);
    dig_axes_without_units(g.untold_words);
    dig_text_copy(sizeof g.wanted, g.wanted, m->wanted);
    *matched = g;
    return true;
}
