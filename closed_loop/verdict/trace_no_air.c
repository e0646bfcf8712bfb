// A machine's digs without free air: nothing tells its effects from those of the soil.

#include "closed_loop/search/cross_validation.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <stdio.h>

static const char *const advice =
    "no free air in the recordings: effects of the machine cannot be told, and what is said of the "
    "soil and its gravel may be theirs; record two seconds or more before contact and after the "
    "dump";

// A correction without a name was tried on the digs of each trajectory in turn
// (closed_loop/search/unlisted.h): that says nothing where every trajectory was dug once.
static bool was_tried(const struct dig_whitened_digs *const batch)
{
    bool tried = false;
    for (size_t g = 0; g < batch->groups; g++) {
        tried = tried || batch->group[g].digs > 1;
    }
    return tried;
}

void dig_trace_confirm_without_air(struct dig_trace_work *const w)
{
    assert(w != NULL);
    const struct dig_search *const s = w->search;
    w->confirmed                     = true;
    if (w->air->no_air && s->significant) {
        w->confirmed = s->unlisted
                           ? was_tried(w->batch)
                           : dig_cross_validation_gain(w->batch, &s->plain, &s->chosen) > 0.0;
    }
}

void dig_trace_advise_on_air(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    assert(w != NULL && trace != NULL);
    if (!w->air->no_air) {
        return;
    }
    char more[sizeof trace->advice];
    (void)snprintf(more, sizeof more, "%s", trace->advice);
    (void)snprintf(trace->advice, sizeof trace->advice, "%s%s%.280s", advice,
                   more[0] != '\0' ? ". Of the digs alone: " : "", more);
}
