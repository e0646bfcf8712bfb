#include "tests/blind/answer.h"

#include <math.h>
#include <string.h>

// Where the classes of size begin; the second is where the criterion for 1.5 is read off.
static const double class_low[BLIND_CLASSES] = { 0.0, 1.0, 2.25, 3.0 };

double blind_size_of(const struct blind_result *const result)
{
    double least = (double)INFINITY;
    for (size_t e = 0; e < result->order.effects; e++) {
        least = fmin(least, fmax(result->truth.size[e], result->truth.size_air[e]));
    }
    return result->order.effects == 0 ? 0.0 : least;
}

// What is left of it in the soil after the best refit of the gravel, alone.
double blind_size_in_soil(const struct blind_result *const result)
{
    double least = (double)INFINITY;
    for (size_t e = 0; e < result->order.effects; e++) {
        least = fmin(least, result->truth.size[e]);
    }
    return result->order.effects == 0 ? 0.0 : least;
}

int blind_class_of_size(const double size)
{
    int c = BLIND_CLASSES - 1;
    while (c > 0 && size < class_low[c]) {
        c--;
    }
    return c;
}

int blind_class_of(const struct blind_result *const result)
{
    return blind_class_of_size(blind_size_of(result));
}

bool blind_says(const struct blind_result *const r, const char *const name)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.names; i++) {
        is = is || strcmp(r->verdict.name[i], name) == 0;
    }
    return is;
}

static bool set_holds(const struct blind_result *const r, const size_t s, const char *const name)
{
    bool is = false;
    for (size_t i = 0; i < r->verdict.set_size[s]; i++) {
        is = is || strcmp(r->verdict.set[s][i], name) == 0;
    }
    return is;
}

// Named, or in a small enough set together with something that the verdict names.
bool blind_found(const struct blind_result *const r, const struct blind_choice *const truth)
{
    const size_t most = truth->how == BLIND_BY_MACHINE ? 2 : 3;
    bool         is   = blind_says(r, truth->name);
    for (size_t s = 0; s < r->verdict.sets && !is; s++) {
        for (size_t i = 0; i < r->verdict.names && r->verdict.set_size[s] <= most; i++) {
            is = is || (set_holds(r, s, truth->name) && set_holds(r, s, r->verdict.name[i]));
        }
    }
    return is;
}

// True when what the verdict names is there, or stands for something that is there.
bool blind_justified(const struct blind_result *const r, const char *const name)
{
    bool is = false;
    for (size_t e = 0; e < r->order.effects; e++) {
        const struct blind_choice *const truth = &r->order.effect[e];
        const size_t                     most  = truth->how == BLIND_BY_MACHINE ? 2 : 3;

        is = is || strcmp(name, truth->name) == 0;
        for (size_t s = 0; s < r->verdict.sets; s++) {
            is = is || (r->verdict.set_size[s] <= most && set_holds(r, s, name) &&
                        set_holds(r, s, truth->name));
        }
    }
    return is;
}

enum blind_answer blind_answer_of(const struct blind_result *const r)
{
    if (r->state == BLIND_REFUSED) {
        return BLIND_SAID_NOTHING;
    }
    size_t there = 0;
    size_t wrong = 0;
    bool   named = r->order.effects > 0;
    for (size_t e = 0; e < r->order.effects; e++) {
        there += blind_found(r, &r->order.effect[e]) ? 1 : 0;
        named = named && blind_says(r, r->order.effect[e].name);
    }
    for (size_t i = 0; i < r->verdict.names; i++) {
        wrong += blind_justified(r, r->verdict.name[i]) ? 0 : 1;
    }
    if (r->order.effects > 0 && there == r->order.effects) {
        return wrong > 0 ? BLIND_EXTRA : (named ? BLIND_RIGHT : BLIND_IN_SET);
    }
    if (blind_says(r, "none")) {
        return r->order.effects == 0 ? BLIND_RIGHT : BLIND_SAID_NONE;
    }
    return blind_says(r, "unlisted") ? BLIND_SAID_UNLISTED : BLIND_WRONG;
}
