// Chooses one effect or two: the best single effect, pairs with it, and the rules for a name.

#include "closed_loop/search/cross_validation.h"
#include "closed_loop/search/search_work.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PARTNERS = 4 }; // of the best single effects that pairs are made with

// Log evidence by which an effect must lead what has no name. That may be liker to an effect than
// its wide prior lets it be: a trench is nearly a slope. Chosen on the split for development.
static const double least_lead = 15.0;

// Share of what the plain hypothesis leaves that a rock elsewhere must explain: another depth gives
// its hump another shape.
static const double half = 0.5;

// Log likelihood by which a parabola leads a line once in a hundred times by chance.
static const double by_a_bend = 0.5 * 2.576 * 2.576;

// The best pair made with one of the best single effects. False when none is better than single.
static bool find_pair(struct dig_search_work *const c, struct dig_fitted *const pair)
{
    bool   any  = false;
    double best = INFINITY;
    for (size_t first = 0; first < PARTNERS && first < c->s->rivals; first++) {
        struct dig_hypothesis added[DIG_RIVALS_MAX];
        struct dig_fitted     fitted[DIG_RIVALS_MAX + 1];
        struct dig_statistic  statistic;
        size_t                n = 0;
        for (size_t i = 0; i < c->s->rivals; i++) {
            if (i != first) {
                added[n]           = c->single[first];
                added[n].effects   = 2;
                added[n].effect[1] = c->single[i].effect[0];
                n++;
            }
        }
        dig_null_simulation_fit(c->batch, &c->single[first], n, added,
                                c->s->rival[first].fitted.number, DIG_FIT_BARE, fitted, &statistic);
        if (statistic.best < n && fitted[1 + statistic.best].misfit < best) {
            best  = fitted[1 + statistic.best].misfit;
            *pair = fitted[1 + statistic.best];
            any   = true;
        }
    }
    return any;
}

// An effect must explain the digs better than none by what tells two answers apart, and better than
// what has no name by more, which pays for all the forms it may take. And it must be enough: where
// something without a name beside it explains more, it has no claim to what it was fitted to.
static bool is_believable(const struct dig_search_work *const c, const double evidence)
{
    struct dig_fitted with;
    dig_hypothesis_fit_unlisted(c->batch, &c->s->chosen, &with);
    return evidence >= DIG_SEARCH_TOLD_APART &&
           evidence >= dig_search_evidence(c, &c->s->nameless, 0) + least_lead &&
           evidence >= dig_search_evidence(c, &with, 0) - DIG_SEARCH_TOLD_APART;
}

// A tooth wears from dig to dig; what comes to rest, or steps once, is no wear, and neither is one
// dig that is unlike the others.
static bool drifts_otherwise(struct dig_search_work *const c)
{
    struct dig_batch settled = *c->batch;
    dig_steps_settle(&settled, c->s->chosen.z);
    const struct dig_drift drift    = dig_drift_of(&settled, &c->s->chosen, c->s->spread);
    const bool             bends    = drift.parabola > drift.line + by_a_bend;
    const bool             no_order = drift.line < DIG_SEARCH_BY_ORDER;
    if (bends || no_order) {
        (void)snprintf(c->s->without_name.depends_on, sizeof c->s->without_name.depends_on,
                       bends ? "the order of the digs" : "which dig it is");
    }
    return bends || no_order;
}

// The best single effect again, from where a pair that holds it has led: a pair must not lead for
// having been fitted better.
static void fit_again(struct dig_search_work *const c, const struct dig_fitted *const pair)
{
    struct dig_rival *const best = &c->s->rival[0];
    double                  start[DIG_HYPOTHESIS_NUMBERS];
    memcpy(start, pair->number, sizeof start);
    for (size_t e = 0; e < pair->hypothesis.effects; e++) {
        if (pair->hypothesis.effect[e] == best->fitted.hypothesis.effect[0]) {
            struct dig_fitted again;
            start[DIG_AT_U(0)]        = pair->number[DIG_AT_U(e)];
            start[DIG_AT_CONTRAST(0)] = pair->number[DIG_AT_CONTRAST(e)];
            dig_hypothesis_fit(c->batch, &c->single[0], start, DIG_FIT_BARE, &again);
            if (again.misfit < best->fitted.misfit) {
                best->fitted       = again;
                best->log_evidence = dig_search_evidence(c, &again, 0);
            }
        }
    }
}

// The pair, where it leads the best single effect as no second effect does by chance (Ville), and
// predicts digs left out better than that; where no dig can be left out for want of more, a second
// effect is not confirmed and not named.
static void choose_pair(struct dig_search_work *const c, const struct dig_fitted *const pair)
{
    const struct dig_rival *const best  = &c->s->rival[0];
    const double                  least = log((double)c->s->rivals / c->false_alarm);
    const bool leads  = dig_search_evidence(c, pair, 0) > best->log_evidence + least;
    const bool better = leads && dig_cross_validation_gain(c->batch, &best->fitted, pair) > 0.0;
    c->s->chosen      = better ? *pair : best->fitted;
}

// The gravel is the one beside something that may be anything: the plain one follows what is not
// its own. What digs of it scatter by is as for that.
static void give_up(struct dig_search_work *const c)
{
    c->s->unlisted = true;
    c->s->chosen   = c->s->nameless;
    memcpy(c->s->chosen.noise, c->s->plain.noise, sizeof c->s->chosen.noise);
}

// What has no name may be a rock elsewhere: it must lead all that was tried, and its hump must
// explain half of what is left; another depth gives it another shape. Of the digs as the plain
// hypothesis has the machine.
static void look_for_rock(struct dig_search_work *const c, const struct dig_batch *const settled)
{
    struct dig_rock *const rock = &c->s->rock;
    *rock                       = dig_rock_fit(settled, &c->s->plain);
    if (!rock->known) {
        return;
    }
    struct dig_fitted plain;
    memcpy(rock->plain.z, c->s->plain.z, sizeof rock->plain.z);
    dig_hypothesis_fit(settled, &c->s->plain.hypothesis, c->s->plain.number, DIG_FIT_BARE, &plain);
    const double before = dig_null_simulation_left(settled, &plain);
    const double after  = dig_batch_misfit_of_means(settled, rock->squares);
    rock->log_evidence  = dig_search_evidence(c, &rock->plain, rock->numbers) +
                         0.5 * (plain.misfit - c->s->plain.misfit);
    rock->p_fit = dig_null_simulation_p(&c->plain_null, 0,
                                        dig_batch_misfit_of_means(settled, rock->plain.squares));
    const double lead =
        rock->log_evidence - fmax(dig_search_best_evidence(c->s), c->s->without_name.log_evidence);
    c->s->is_rock =
        lead >= DIG_SEARCH_TOLD_APART && before - after >= half * (before - c->plain_null.mean[0]);
    if (c->s->is_rock) {
        c->s->chosen = rock->plain;
    }
}

void dig_search_which(struct dig_search_work *const c)
{
    struct dig_batch settled = *c->batch;
    dig_steps_settle(&settled, c->s->plain.z);
    c->s->without_name = dig_unlisted_find(&settled, &c->s->plain);
    if (c->s->rivals == 0) {
        give_up(c);
        return;
    }
    c->s->chosen = c->s->rival[0].fitted;
    struct dig_fitted pair;
    if (find_pair(c, &pair)) {
        fit_again(c, &pair);
        choose_pair(c, &pair);
    }
    const double evidence = dig_search_evidence(c, &c->s->chosen, 0);
    c->s->confirmed       = dig_cross_validation_gain(c->batch, &c->s->plain, &c->s->chosen);
    if (c->s->confirmed < 0.0 || !is_believable(c, evidence) || drifts_otherwise(c)) {
        give_up(c);
        look_for_rock(c, &settled);
    }
}
