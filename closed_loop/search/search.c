#include "closed_loop/search/search_work.h"

#include "core/chance.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// What is significant and that nothing explains, with a name or without, is taken for chance unless
// it is so much rarer than the level.
static const double rarer = 0.01;

// Evidence is tempered: covariance and templates are known from a few packings only.
static const double temper = 0.5;

size_t dig_search_rivals(const struct dig_batch *const batch,
                         struct dig_hypothesis         single[DIG_RIVALS_MAX])
{
    assert(batch != NULL && single != NULL);
    size_t rivals = 0;
    for (int e = 0; e < DIG_EFFECTS; e++) {
        const enum dig_effect_id effect = (enum dig_effect_id)e;
        if (effect != DIG_EFFECT_UNLISTED && rivals < DIG_RIVALS_MAX &&
            dig_hypothesis_possible(batch, effect)) {
            single[rivals++] = (struct dig_hypothesis){ .effects = 1, .effect = { effect } };
        }
    }
    return rivals;
}

// The one of more evidence first.
static int compare_rivals(const void *const left, const void *const right)
{
    const struct dig_rival *const a = left;
    const struct dig_rival *const b = right;
    const int by_effect = (int)a->fitted.hypothesis.effect[0] - (int)b->fitted.hypothesis.effect[0];
    const int by_evidence =
        (a->log_evidence < b->log_evidence) - (a->log_evidence > b->log_evidence);
    return by_evidence != 0 ? by_evidence : by_effect;
}

// Fits everything once, thoroughly, from the middle of the table.
static void fit_all(struct dig_search_work *const c, struct dig_statistic *const statistic)
{
    static const struct dig_hypothesis plain   = { .effects = 0 };
    static const struct dig_hypothesis outside = { .effects = 0, .outside = true };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_fitted                  fitted[DIG_RIVALS_MAX + 1];
    dig_null_simulation_fit(c->batch, &plain, c->s->rivals, c->single, middle, DIG_FIT_THOROUGH,
                            fitted, statistic);
    c->s->plain = fitted[0];
    for (size_t i = 0; i < c->s->rivals; i++) {
        c->s->rival[i].fitted       = fitted[1 + i];
        c->s->rival[i].log_evidence = dig_search_evidence(c, &fitted[1 + i], 0);
    }
    qsort(c->s->rival, c->s->rivals, sizeof c->s->rival[0], compare_rivals);
    for (size_t i = 0; i < c->s->rivals; i++) {
        c->single[i] = c->s->rival[i].fitted.hypothesis;
    }
    dig_hypothesis_fit(c->batch, &outside, fitted[0].number, DIG_FIT_THOROUGH, &c->s->beyond);
    dig_hypothesis_fit_unlisted(c->batch, &fitted[0], &c->s->nameless);
}

// The digs differ as an effect says that differs from dig to dig: no mere scatter, and not in any
// order.
static bool is_told_by_order(const struct dig_search_work *const c)
{
    bool told = false;
    for (size_t i = 0; i < c->s->rivals; i++) {
        const struct dig_rival *const rival = &c->s->rival[i];
        told = told || (dig_effect_is_by_dig(c->single[i].effect[0]) &&
                        rival->log_evidence > DIG_SEARCH_BY_ORDER &&
                        dig_drift_of(c->batch, &rival->fitted, 1.0).line >= DIG_SEARCH_BY_ORDER);
    }
    return told;
}

// Digs that scatter more about their means than the table's: all is weighed by their own scatter.
static void allow_for_scatter(struct dig_search_work *const c,
                              struct dig_statistic *const   statistic)
{
    c->s->spread = 1.0;
    if (c->plain_null.mean[1] > 0.0 && !is_told_by_order(c) &&
        dig_null_simulation_p(&c->plain_null, 1, statistic->about) < c->false_alarm) {
        c->s->spread = sqrt(statistic->about / c->plain_null.mean[1]);
        dig_batch_spread(c->batch, c->s->spread);
        fit_all(c, statistic);
    }
}

// The smaller chance of two tests, as if there were but one.
static double chance_of_either(const double p)
{
    return 1.0 - (1.0 - p) * (1.0 - p);
}

// By the misfit, and by the gain where that could still change the answer: a draw that rivals are
// fitted to costs as much as thirty that none are.
static void decide_whether(struct dig_search_work *const c)
{
    const struct dig_batch raw  = *c->batch;
    uint64_t               seed = c->seed;
    struct dig_statistic   statistic;
    fit_all(c, &statistic);
    const struct dig_fitted plain = c->s->plain;
    c->plain_null = dig_null_simulation_draw(&raw, &plain, 0, NULL, c->draws, NULL, &c->seed);
    allow_for_scatter(c, &statistic);
    const double p   = dig_null_simulation_p(&c->plain_null, 0, statistic.misfit);
    c->s->p_complete = chance_of_either(p);
    if (!(c->s->p_complete < c->false_alarm)) {
        const struct dig_null_question   asked = { statistic.gain, c->false_alarm };
        const struct dig_null_simulation gains = dig_null_simulation_draw(
            &raw, &plain, c->s->rivals, c->single, c->draws, &asked, &seed);
        c->s->p_complete =
            chance_of_either(fmin(p, dig_null_simulation_p(&gains, 2, statistic.gain)));
    }
    c->s->significant = c->s->p_complete < c->false_alarm;
    for (size_t i = 0; i < c->s->rivals; i++) {
        const double left    = dig_null_simulation_left(c->batch, &c->s->rival[i].fitted);
        c->s->rival[i].p_fit = dig_null_simulation_p(&c->plain_null, 0, left);
    }
}

// Resamples the digs of each trajectory.
static void resample(const struct dig_batch *const batch, uint64_t *const seed,
                     struct dig_batch *const drawn)
{
    for (size_t i = 0; i < batch->digs; i++) {
        const size_t g    = batch->dig[i].group;
        size_t       pick = dig_chance_index(seed, batch->group[g].digs);
        for (size_t j = 0; j < batch->digs; j++) {
            if (batch->dig[j].group == g && pick-- == 0) {
                drawn->dig[i] = batch->dig[j];
                break;
            }
        }
    }
    dig_batch_summarise(drawn);
}

// How often each single effect is best when the campaign is drawn from its own digs.
static void bootstrap(struct dig_search_work *const c, const size_t times)
{
    struct dig_fitted fitted[DIG_RIVALS_MAX + 1];
    struct dig_batch  drawn = *c->batch;
    for (size_t i = 0; i < times; i++) {
        struct dig_statistic statistic;
        resample(c->batch, &c->seed, &drawn);
        dig_null_simulation_fit(&drawn, &c->s->plain.hypothesis, c->s->rivals, c->single,
                                c->s->plain.number, DIG_FIT_BARE, fitted, &statistic);
        if (statistic.best < c->s->rivals) {
            c->s->rival[statistic.best].inclusion += 1.0 / (double)times;
        }
    }
}

// Whether a gravel that the grid does not hold explains the digs at least as well as what was
// chosen.
static bool is_outside(const struct dig_search_work *const c)
{
    const struct dig_fitted *const chosen    = &c->s->chosen;
    const double                   by_gravel = dig_search_evidence(c, &c->s->beyond, 1);
    const double                   by_effect =
        c->s->unlisted ? dig_search_best_evidence(c->s) : dig_search_evidence(c, chosen, 0);
    return by_gravel > 0.0 && by_gravel >= by_effect &&
           by_gravel >= dig_search_evidence(c, &c->s->nameless, 0);
}

// The two best single effects that the digs cannot tell from the one chosen.
static void find_alike(struct dig_search_work *const c)
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

// The weight of each answer among all that were tried, by tempered Bayes.
static void set_probabilities(struct dig_search_work *const c)
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

void dig_search_run(struct dig_batch *const batch, const double false_alarm, const size_t draws,
                    const uint64_t seed, struct dig_search *const search)
{
    assert(batch != NULL && search != NULL && draws >= 4);
    memset(search, 0, sizeof *search);
    search->unnamed          = 1.0;
    struct dig_search_work c = {
        .batch = batch, .false_alarm = false_alarm, .draws = draws, .seed = seed, .s = search
    };
    search->rivals = dig_search_rivals(batch, c.single);
    decide_whether(&c);
    search->chosen = search->plain;
    if (!search->significant) {
        return;
    }
    bootstrap(&c, draws / 4);
    dig_search_which(&c);
    search->outside = !search->is_rock && is_outside(&c);
    if (search->unlisted && !search->is_rock && !search->outside &&
        !(search->without_name.log_evidence > 0.0) &&
        dig_search_best_evidence(search) < DIG_SEARCH_TOLD_APART &&
        search->p_complete > rarer * false_alarm) {
        search->unlisted    = false;
        search->significant = false;
        return;
    }
    if (search->outside) {
        search->chosen   = search->beyond;
        search->unlisted = false;
    }
    if (search->chosen.hypothesis.effects == 1) {
        find_alike(&c);
    }
    set_probabilities(&c);
}
