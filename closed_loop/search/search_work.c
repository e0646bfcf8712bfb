#include "closed_loop/search/search_work.h"

#include <math.h>

double dig_search_penalty(const struct dig_whitened_digs *const batch, const size_t numbers)
{
    double observations = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        observations += (double)batch->group[g].features;
    }
    return 0.5 * (double)numbers * log(observations);
}

double dig_search_evidence(const struct dig_search_work *const c,
                           const struct dig_fitted *const fitted, const size_t more)
{
    return 0.5 * (c->s->plain.misfit - fitted->misfit) -
           dig_search_penalty(c->batch, dig_hypothesis_free(&fitted->hypothesis) + more);
}

bool dig_search_holds(const struct dig_hypothesis *const hypothesis,
                      const enum dig_effect_id           effect)
{
    const size_t effects = hypothesis->effects;
    return dig_effect_place(effects, hypothesis->effect, effect) < effects;
}

size_t dig_search_best_rival(const struct dig_search *const s, const bool taken[])
{
    size_t best = s->rivals;
    for (size_t i = 0; i < s->rivals; i++) {
        if ((taken == NULL || !taken[i]) &&
            (best == s->rivals || s->log_evidence[i] > s->log_evidence[best])) {
            best = i;
        }
    }
    return best;
}

double dig_search_best_evidence(const struct dig_search *const s)
{
    return s->rivals > 0 ? fmax(s->log_evidence[dig_search_best_rival(s, NULL)], 0.0) : 0.0;
}
