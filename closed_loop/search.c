#include "closed_loop/search.h"

#include "closed_loop/chance.h"
#include "closed_loop/confirm.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTNERS = 4 }; // of the best single effects that pairs are made with

// An effect is believed to be the whole truth when digs of its own would misfit as much in one
// campaign of a hundred, or when it takes away this share of what the plain hypothesis leaves and
// what it leaves itself is at most so many times what digs of its own would.
static const double least_fit   = 0.01;
static const double least_share = 0.75;
static const double most_left   = 2.0;
static const double much_left   = 4.0;

// What is significant and that nothing explains, with a name or without, is taken for chance unless
// it is so much rarer than the level.
static const double rarer = 0.01;

// Log evidence within which two answers are not told apart: an effect from another, from none, or
// from two.
static const double told_apart = 6.0;

// Beyond which digs that differ as an effect says are not put down to scatter.
static const double lead = 3.0;

// Below this chance of its own misfit the plain hypothesis is refuted by itself.
static const double refuted = 0.001;

// Evidence is tempered: covariance and templates are known from a few packings only.
static const double temper = 0.5;

struct context {
    struct dig_batch      *batch;
    const struct dig_soil *soil;
    double                 false_alarm;
    size_t                 draws;
    uint64_t               seed;
    struct dig_hypothesis  single[DIG_NULL_RIVALS];
    struct dig_null        plain_null;
    double                 left, expected; // misfit of chosen, and of digs that it made
    struct dig_search     *s;
};

static double penalty(const struct context *const c, const size_t numbers)
{
    double observations = 0.0;
    for (size_t g = 0; g < c->batch->groups; g++) {
        observations += (double)c->batch->group[g].features;
    }
    return 0.5 * (double)numbers * log(observations);
}

// Of a fit with more numbers than the plain hypothesis has.
static double evidence_of(const struct context *const c, const struct dig_fitted *const fitted,
                          const size_t numbers)
{
    return 0.5 * (c->s->plain.misfit - fitted->misfit) - penalty(c, numbers);
}

static double about_of(const struct dig_batch *const batch)
{
    double about = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        about += batch->group[g].about;
    }
    return about;
}

static void list_rivals(struct context *const c)
{
    c->s->rivals = 0;
    for (int e = 0; e < DIG_EFFECTS; e++) {
        const enum dig_effect_id effect = (enum dig_effect_id)e;
        if (!dig_effect_is_of_machine(effect) && effect != DIG_EFFECT_UNLISTED &&
            c->s->rivals < DIG_NULL_RIVALS && dig_hypothesis_possible(c->batch, c->soil, effect)) {
            c->single[c->s->rivals++] = (struct dig_hypothesis){ 1, { effect }, false };
        }
    }
}

// What a fit leaves of the digs' means.
static double left_of(const struct context *const c, const struct dig_fitted *const fitted)
{
    return dig_hypothesis_differs(&fitted->hypothesis)
               ? dig_hypothesis_squares(c->batch, c->soil, fitted, fitted->noise)
               : fitted->squares - about_of(c->batch);
}

// Fits everything once, thoroughly, from the middle of the table.
static void fit_all(struct context *const c, struct dig_statistic *const statistic)
{
    static const struct dig_hypothesis plain   = { .effects = 0 };
    static const struct dig_hypothesis outside = { .effects = 0, .outside = true };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_fitted                  fitted[DIG_NULL_RIVALS + 1];
    dig_null_fit(c->batch, c->soil, &plain, c->s->rivals, c->single, middle, true, fitted,
                 statistic);
    c->s->plain = fitted[0];
    for (size_t i = 0; i < c->s->rivals; i++) {
        c->s->rival[i]        = fitted[1 + i];
        c->s->log_evidence[i] = evidence_of(c, &fitted[1 + i], 1);
    }
    dig_hypothesis_fit(c->batch, c->soil, &outside, fitted[0].number, true, &c->s->beyond);
}

// Digs that scatter more than the table's raise the noise of everything.
static void spread_batch(struct dig_batch *const batch, const double spread)
{
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t i = 0; i < DIG_FORCE_CHANNELS; i++) {
            batch->group[g].amplitude[i] *= spread;
        }
    }
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t k = 0; k < DIG_FEATURES; k++) {
            batch->dig[i].y[k] /= spread;
        }
    }
    dig_batch_summarise(batch);
}

// The digs differ as an effect says that differs from dig to dig: no mere scatter.
static bool is_told_by_order(const struct context *const c)
{
    bool told = false;
    for (size_t i = 0; i < c->s->rivals; i++) {
        const enum dig_effect_id effect = c->single[i].effect[0];
        const bool by_dig = effect == DIG_EFFECT_RATE_DEPENDENCE || effect == DIG_EFFECT_WEAR ||
                            effect == DIG_EFFECT_COMPACTION;
        told = told || (by_dig && c->s->log_evidence[i] > lead);
    }
    return told;
}

static enum dig_status decide_whether(struct context *const c)
{
    struct dig_statistic statistic;
    fit_all(c, &statistic);
    enum dig_status status = dig_null_draw(c->batch, c->soil, &c->s->plain, c->s->rivals, c->single,
                                           c->draws, &c->seed, &c->plain_null);
    if (status != DIG_OK) {
        return status;
    }
    c->s->spread = 1.0;
    if (c->plain_null.mean[1] > 0.0 && !is_told_by_order(c) &&
        dig_null_p(&c->plain_null, 1, statistic.about) < c->false_alarm) {
        c->s->spread = sqrt(statistic.about / c->plain_null.mean[1]);
        spread_batch(c->batch, c->s->spread);
        fit_all(c, &statistic);
    }
    const double p    = fmin(dig_null_p(&c->plain_null, 0, statistic.misfit),
                             dig_null_p(&c->plain_null, 2, statistic.gain));
    c->s->p_complete  = 1.0 - (1.0 - p) * (1.0 - p);
    c->s->significant = c->s->p_complete < c->false_alarm;
    c->s->plain_fit   = dig_null_p(&c->plain_null, 0, left_of(c, &c->s->plain));
    for (size_t i = 0; i < c->s->rivals; i++) {
        c->s->rival_fit[i] = dig_null_p(&c->plain_null, 0, left_of(c, &c->s->rival[i]));
    }
    return status;
}

static size_t best_rival(const struct dig_search *const s)
{
    size_t best = 0;
    for (size_t i = 1; i < s->rivals; i++) {
        best = s->log_evidence[i] > s->log_evidence[best] ? i : best;
    }
    return best;
}

static double best_evidence(const struct dig_search *const s)
{
    return s->rivals > 0 ? fmax(s->log_evidence[best_rival(s)], 0.0) : 0.0;
}

// Share of the plain hypothesis' excess misfit that a fit takes away.
static double share_of(const struct context *const c, const struct dig_fitted *const fitted)
{
    const double expected = c->plain_null.mean[0];
    const double before   = left_of(c, &c->s->plain) - expected;
    const double after    = left_of(c, fitted) - expected;
    return before > 0.0 ? 1.0 - after / before : 1.0;
}

static bool holds(const struct dig_hypothesis *const hypothesis, const enum dig_effect_id effect)
{
    bool found = false;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        found = found || hypothesis->effect[e] == effect;
    }
    return found;
}

// The chosen hypothesis with each other effect beside it.
static size_t list_additions(const struct context *const c, const struct dig_hypothesis *const base,
                             struct dig_hypothesis added[DIG_NULL_RIVALS])
{
    size_t n = 0;
    for (size_t i = 0; i < c->s->rivals; i++) {
        if (!holds(base, c->single[i].effect[0])) {
            added[n]                            = *base;
            added[n].effect[added[n].effects++] = c->single[i].effect[0];
            n++;
        }
    }
    return n;
}

// The best pair made with one of the best single effects. False when none is better than single.
static bool find_pair(struct context *const c, struct dig_fitted *const pair)
{
    bool   tried[DIG_NULL_RIVALS] = { false };
    bool   any                    = false;
    double best                   = INFINITY;
    for (size_t p = 0; p < PARTNERS && p < c->s->rivals; p++) {
        size_t first = c->s->rivals;
        for (size_t i = 0; i < c->s->rivals; i++) {
            if (!tried[i] &&
                (first == c->s->rivals || c->s->log_evidence[i] > c->s->log_evidence[first])) {
                first = i;
            }
        }
        tried[first] = true;
        struct dig_hypothesis added[DIG_NULL_RIVALS];
        struct dig_fitted     fitted[DIG_NULL_RIVALS + 1];
        struct dig_statistic  statistic;
        const size_t          n = list_additions(c, &c->single[first], added);
        dig_null_fit(c->batch, c->soil, &c->single[first], n, added, c->s->rival[first].number,
                     false, fitted, &statistic);
        if (statistic.best < n && fitted[1 + statistic.best].misfit < best) {
            best  = fitted[1 + statistic.best].misfit;
            *pair = fitted[1 + statistic.best];
            any   = true;
        }
    }
    return any;
}

// What digs of the chosen hypothesis would show; whether a second effect is significant beside it.
static enum dig_status weigh_chosen(struct context *const c, bool *const more)
{
    struct dig_hypothesis added[DIG_NULL_RIVALS];
    struct dig_fitted     fitted[DIG_NULL_RIVALS + 1];
    struct dig_statistic  statistic;
    struct dig_null       null;
    const bool            room = c->s->chosen.hypothesis.effects < DIG_HYPOTHESIS_EFFECTS;
    const size_t          n    = room ? list_additions(c, &c->s->chosen.hypothesis, added) : 0;
    // Digs that differ cost as many times more as there are of them.
    const size_t draws =
        dig_hypothesis_differs(&c->s->chosen.hypothesis) ? c->draws / 8 + 2 : c->draws / 2;
    dig_null_fit(c->batch, c->soil, &c->s->chosen.hypothesis, n, added, c->s->chosen.number, false,
                 fitted, &statistic);
    const enum dig_status status =
        dig_null_draw(c->batch, c->soil, &c->s->chosen, n, added, draws, &c->seed, &null);
    if (status == DIG_OK) {
        c->s->p_fit = dig_null_p(&null, 0, statistic.misfit);
        c->left     = statistic.misfit;
        c->expected = null.mean[0];
        *more       = n > 0 && dig_null_p(&null, 2, statistic.gain) < c->false_alarm;
    }
    return status;
}

// Where much is left of the plain hypothesis, the effect's own curves must explain it: not only the
// noise that an effect of this size, known from few beds, brings along.
static bool is_matched(const struct context *const c)
{
    const double expected = c->plain_null.mean[0];
    const double before =
        dig_hypothesis_squares(c->batch, c->soil, &c->s->plain, c->s->plain.noise);
    const double after =
        dig_hypothesis_squares(c->batch, c->soil, &c->s->chosen, c->s->plain.noise);
    return before < much_left * expected || before - after >= least_share * (before - expected);
}

static bool is_believable(const struct context *const c)
{
    return is_matched(c) &&
           (c->s->p_fit >= least_fit ||
            (share_of(c, &c->s->chosen) >= least_share && c->left <= most_left * c->expected));
}

// Beside a plain hypothesis that could be true an effect must be decisive. Where it cannot, an
// effect need only be the likelier.
static bool is_decisive(const struct context *const c, const double evidence)
{
    return evidence >= told_apart || (evidence > 0.0 && c->s->plain_fit < refuted);
}

// The best single effect again, from where a pair that holds it has led: a pair must not lead for
// having been fitted better.
static void fit_again(struct context *const c, const size_t best,
                      const struct dig_fitted *const pair)
{
    double start[DIG_HYPOTHESIS_NUMBERS];
    memcpy(start, pair->number, sizeof start);
    for (size_t e = 0; e < pair->hypothesis.effects; e++) {
        if (pair->hypothesis.effect[e] == c->single[best].effect[0]) {
            struct dig_fitted again;
            start[DIG_AXES] = pair->number[DIG_AXES + e];
            dig_hypothesis_fit(c->batch, c->soil, &c->single[best], start, false, &again);
            if (again.misfit < c->s->rival[best].misfit) {
                c->s->rival[best]        = again;
                c->s->log_evidence[best] = evidence_of(c, &again, 1);
            }
        }
    }
}

static void give_up(struct context *const c)
{
    c->s->unlisted = true;
    c->s->chosen   = c->s->plain;
}

static enum dig_status decide_which(struct context *const c)
{
    enum dig_status status =
        dig_unlisted_find(c->batch, c->soil, &c->s->plain, &c->s->without_name);
    if (status != DIG_OK) {
        return status;
    }
    if (c->s->rivals == 0) {
        give_up(c);
        return DIG_OK;
    }
    const size_t best = best_rival(c->s);
    c->s->chosen      = c->s->rival[best];
    bool more         = false;
    status            = weigh_chosen(c, &more);
    struct dig_fitted pair;
    if (status == DIG_OK && more && find_pair(c, &pair)) {
        fit_again(c, best, &pair);
        c->s->chosen = evidence_of(c, &pair, 2) > c->s->log_evidence[best] + told_apart
                           ? pair
                           : c->s->rival[best];
        status       = weigh_chosen(c, &more);
    }
    const double evidence = evidence_of(c, &c->s->chosen, c->s->chosen.hypothesis.effects);
    if (status == DIG_OK) {
        status = dig_confirm_gain(c->batch, c->soil, &c->s->plain, &c->s->chosen, &c->s->confirmed);
    }
    if (status == DIG_OK &&
        (!is_decisive(c, evidence) || c->s->confirmed < 0.0 || !is_believable(c))) {
        give_up(c);
    }
    return status;
}

// A gravel that the grid does not hold explains the digs at least as well as what was chosen.
static bool is_outside(const struct context *const c)
{
    const struct dig_fitted *const chosen = &c->s->chosen;
    const double                   p = dig_null_p(&c->plain_null, 0, left_of(c, &c->s->beyond));
    const double                   by_gravel = evidence_of(c, &c->s->beyond, 1);
    const double                   by_effect =
        c->s->unlisted ? best_evidence(c->s) : evidence_of(c, chosen, chosen->hypothesis.effects);
    return by_gravel > 0.0 && by_gravel >= by_effect &&
           (p >= least_fit || share_of(c, &c->s->beyond) >= least_share);
}

static bool is_near_chosen(const struct context *const c, const size_t rival)
{
    const double evidence = evidence_of(c, &c->s->chosen, 1);
    return c->s->log_evidence[rival] > fmax(evidence - told_apart, 0.0) &&
           !holds(&c->s->chosen.hypothesis, c->single[rival].effect[0]);
}

// Where evidence is not decisive: fits at least half as likely, and has less evidence only for the
// noise that few beds of it bring along.
static bool is_as_likely(const struct context *const c, const size_t rival)
{
    const double fit = dig_null_p(&c->plain_null, 0, left_of(c, &c->s->chosen));
    return evidence_of(c, &c->s->chosen, 1) < 2.0 * told_apart && c->s->plain_fit < least_fit &&
           c->s->rival_fit[rival] >= fmax(0.5 * fit, least_fit) && !is_near_chosen(c, rival) &&
           !holds(&c->s->chosen.hypothesis, c->single[rival].effect[0]);
}

// Single effects that the digs cannot tell from the one chosen, in the order of their evidence.
static void find_set(struct context *const c)
{
    struct dig_candidate_set *const set = &c->s->set[0];
    set->effects                        = 0;
    set->effect[set->effects++]         = c->s->chosen.hypothesis.effect[0];
    bool taken[DIG_NULL_RIVALS]         = { false };
    for (size_t turn = 0; turn < 2; turn++) {
        size_t next = c->s->rivals;
        for (size_t i = 0; i < c->s->rivals; i++) {
            if ((is_near_chosen(c, i) || is_as_likely(c, i)) && !taken[i] &&
                (next == c->s->rivals || c->s->log_evidence[i] > c->s->log_evidence[next])) {
                next = i;
            }
        }
        if (next < c->s->rivals) {
            taken[next]                 = true;
            set->effect[set->effects++] = c->single[next].effect[0];
        }
    }
    c->s->sets = set->effects > 1 ? 1 : 0;
}

// The weight of each answer among all that were tried: Bayes, tempered.
static void set_probabilities(struct context *const c)
{
    const struct dig_fitted *const chosen    = &c->s->chosen;
    const double                   evidence  = evidence_of(c, chosen, chosen->hypothesis.effects);
    const bool                     single    = chosen->hypothesis.effects == 1;
    const double                   by_gravel = evidence_of(c, &c->s->beyond, 1);
    for (size_t e = 0; e < chosen->hypothesis.effects; e++) {
        double with    = exp(0.0);
        double without = exp(-temper * evidence) + exp(temper * (by_gravel - evidence));
        for (size_t i = 0; i < c->s->rivals; i++) {
            // What fits as well may be what is there, whatever its noise costs.
            const double ahead  = c->s->log_evidence[i] - evidence;
            const double weight = exp(temper * (single && is_as_likely(c, i) ? 0.0 : ahead));
            const bool   same   = c->single[i].effect[0] == chosen->hypothesis.effect[e];
            with += same && !single ? weight : 0.0;
            without += same ? 0.0 : weight;
        }
        c->s->probability[e] = with / (with + without);
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
static enum dig_status bootstrap(struct context *const c, const size_t times)
{
    struct dig_fitted       fitted[DIG_NULL_RIVALS + 1];
    struct dig_batch *const drawn = malloc(sizeof *drawn);
    if (drawn == NULL) {
        return DIG_ENOMEM;
    }
    *drawn = *c->batch;
    for (size_t i = 0; i < times; i++) {
        struct dig_statistic statistic;
        resample(c->batch, &c->seed, drawn);
        dig_null_fit(drawn, c->soil, &c->s->plain.hypothesis, c->s->rivals, c->single,
                     c->s->plain.number, false, fitted, &statistic);
        if (statistic.best < c->s->rivals) {
            c->s->inclusion[statistic.best] += 1.0 / (double)times;
        }
    }
    free(drawn);
    return DIG_OK;
}

enum dig_status dig_search_run(struct dig_batch *const batch, const struct dig_soil *const soil,
                               const double false_alarm, const size_t draws, const uint64_t seed,
                               struct dig_search *const search)
{
    assert(batch != NULL && soil != NULL && search != NULL && draws >= 4);
    memset(search, 0, sizeof *search);
    struct context c = { .batch       = batch,
                         .soil        = soil,
                         .false_alarm = false_alarm,
                         .draws       = draws,
                         .seed        = seed,
                         .s           = search };
    list_rivals(&c);
    enum dig_status status = decide_whether(&c);
    search->chosen         = search->plain;
    if (status == DIG_OK) {
        status = bootstrap(&c, draws / 4);
    }
    if (status == DIG_OK && search->significant) {
        status = decide_which(&c);
    }
    if (status != DIG_OK || !search->significant) {
        return status;
    }
    search->outside = is_outside(&c);
    if (search->unlisted && !search->outside && search->without_name.functions == 0 &&
        best_evidence(search) < told_apart && search->p_complete > rarer * false_alarm) {
        search->unlisted    = false;
        search->significant = false;
        return DIG_OK;
    }
    if (search->outside) {
        search->chosen   = search->beyond;
        search->unlisted = false;
    }
    if (search->chosen.hypothesis.effects == 1) {
        find_set(&c);
    }
    set_probabilities(&c);
    return DIG_OK;
}
