// What is said about the answer: a gravel outside the grid, what cannot be told apart, odds.

#include "closed_loop/search/search_work.h"

#include <math.h>

// Evidence is tempered: covariance and templates are known from a few packings only.
static const double temper = 0.5;

bool dig_search_is_outside(const struct dig_search_work *const c)
{
    const struct dig_fitted *const chosen    = &c->s->chosen;
    const double                   by_gravel = dig_search_evidence(c, &c->s->beyond, 1);
    const double                   by_effect =
        c->s->unlisted ? dig_search_best_evidence(c->s) : dig_search_evidence(c, chosen, 0);
    return by_gravel > 0.0 && by_gravel >= by_effect &&
           by_gravel >= dig_search_evidence(c, &c->s->nameless, 0);
}

void dig_search_find_alike(struct dig_search_work *const c)
{
    enum { MOST = 3 };
    struct dig_candidate_set *const alike    = &c->s->alike;
    const double                    evidence = dig_search_evidence(c, &c->s->chosen, 0);
    const double                    least    = fmax(evidence - DIG_SEARCH_TOLD_APART, 0.0);
    alike->effect[0]                         = c->s->chosen.hypothesis.effect[0];
    alike->effects                           = 1;
    for (size_t i = 0; i < c->s->rivals && alike->effects < MOST; i++) {
        const enum dig_effect_id effect = c->single[i].effect[0];
        if (c->s->rival[i].log_evidence > least && effect != alike->effect[0]) {
            alike->effect[alike->effects++] = effect;
        }
    }
    alike->effects = alike->effects > 1 ? alike->effects : 0;
}

void dig_search_set_probabilities(struct dig_search_work *const c)
{
    const struct dig_fitted *const chosen    = &c->s->chosen;
    const double                   evidence  = dig_search_evidence(c, chosen, 0);
    const bool                     single    = chosen->hypothesis.effects == 1;
    const double                   by_gravel = dig_search_evidence(c, &c->s->beyond, 1);
    for (size_t e = 0; e < chosen->hypothesis.effects; e++) {
        double with    = 1.0;
        double without = exp(-temper * evidence) + exp(temper * (by_gravel - evidence));
        for (size_t i = 0; i < c->s->rivals; i++) {
            const double weight = exp(temper * (c->s->rival[i].log_evidence - evidence));
            const bool   same   = c->single[i].effect[0] == chosen->hypothesis.effect[e];
            with += same && !single ? weight : 0.0;
            without += same ? 0.0 : weight;
        }
        c->s->probability[e] = with / (with + without);
    }
}
