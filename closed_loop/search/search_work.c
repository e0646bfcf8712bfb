#include "closed_loop/search/search_work.h"

#include <math.h>

double dig_search_penalty(const struct dig_batch *const batch, const size_t numbers)
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

double dig_search_best_evidence(const struct dig_search *const s)
{
    return s->rivals > 0 ? fmax(s->rival[0].log_evidence, 0.0) : 0.0;
}
