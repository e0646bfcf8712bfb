#include "closed_loop/search/search_work.h"

#include <math.h>

static double penalty(const struct dig_search_work *const c, const size_t numbers)
{
    double observations = 0.0;
    for (size_t g = 0; g < c->batch->groups; g++) {
        observations += (double)c->batch->group[g].features;
    }
    return 0.5 * (double)numbers * log(observations);
}

double dig_search_evidence(const struct dig_search_work *const c,
                           const struct dig_fitted *const fitted, const size_t more)
{
    return 0.5 * (c->s->plain.misfit - fitted->misfit) -
           penalty(c, dig_hypothesis_free(&fitted->hypothesis) + more);
}

double dig_search_left(const struct dig_search_work *const c, const struct dig_fitted *const fitted)
{
    return dig_null_simulation_left(c->batch, c->soil, fitted);
}

bool dig_search_holds(const struct dig_hypothesis *const hypothesis,
                      const enum dig_effect_id           effect)
{
    bool found = false;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        found = found || hypothesis->effect[e] == effect;
    }
    return found;
}

size_t dig_search_best_rival(const struct dig_search *const s)
{
    size_t best = 0;
    for (size_t i = 1; i < s->rivals; i++) {
        best = s->log_evidence[i] > s->log_evidence[best] ? i : best;
    }
    return best;
}

double dig_search_best_evidence(const struct dig_search *const s)
{
    return s->rivals > 0 ? fmax(s->log_evidence[dig_search_best_rival(s)], 0.0) : 0.0;
}
