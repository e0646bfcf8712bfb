#include "closed_loop/model/candidate.h"

#include <assert.h>

const char *dig_part_name(const enum dig_part part)
{
    static const char *const name[DIG_TRACE_PHASES] = { "air", "soil", "lifted" };
    assert((size_t)part < DIG_TRACE_PHASES);
    return name[part];
}
