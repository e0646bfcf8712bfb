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

static bool is_near_chosen(const struct dig_search_work *const c, const size_t rival)
{
    const double evidence = dig_search_evidence(c, &c->s->chosen, 0);
    return c->s->log_evidence[rival] > fmax(evidence - DIG_SEARCH_TOLD_APART, 0.0) &&
           !dig_search_holds(&c->s->chosen.hypothesis, c->single[rival].effect[0]);
}

void dig_search_find_set(struct dig_search_work *const c)
{
    struct dig_candidate_set *const set = &c->s->set[0];
    set->effects                        = 0;
    set->effect[set->effects++]         = c->s->chosen.hypothesis.effect[0];
    bool taken[DIG_RIVALS_MAX];
    for (size_t i = 0; i < c->s->rivals; i++) {
        taken[i] = !is_near_chosen(c, i);
    }
    for (size_t turn = 0; turn < 2; turn++) {
        const size_t next = dig_search_best_rival(c->s, taken);
        if (next < c->s->rivals) {
            taken[next]                 = true;
            set->effect[set->effects++] = c->single[next].effect[0];
        }
    }
    c->s->sets = set->effects > 1 ? 1 : 0;
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
            const double weight = exp(temper * (c->s->log_evidence[i] - evidence));
            const bool   same   = c->single[i].effect[0] == chosen->hypothesis.effect[e];
            with += same && !single ? weight : 0.0;
            without += same ? 0.0 : weight;
        }
        c->s->probability[e] = with / (with + without);
    }
}
