#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/model/approach_change.h"
#include "closed_loop/search/search_work.h"
#include "estimator/approach/approach_slots.h"

#include <math.h>
#include <string.h>

static const struct dig_hypothesis none = { .effects = 0 };

// The least that a depth which nobody tells is open by.
#define LEAST_SHARE 0.125

// A path that is off its trajectory by less, in depths, is taken for along it: noise of angles.
static const double least_off = 0.04;

// Whether a dig's path says that it is not the table's.
static bool is_made_otherwise(const struct dig_measured *const dig)
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += dig->deeper[k] * dig->deeper[k] / DIG_CURVE_POINTS;
    }
    return !dig_approach_is_plain(&dig->made) || sum > least_off * least_off;
}

// How far a dig is off features of the table, in variances of one dig.
static double squares_off(const struct dig_trace_work *const w,
                          const struct dig_measured *const dig, const double model[DIG_FEATURES],
                          const double amplitude[])
{
    const size_t t   = (size_t)dig->trajectory;
    double       sum = 0.0;
    double       feature[DIG_FEATURES];
    bool         has[DIG_FEATURES];
    dig_features_of((const double(*)[DIG_CURVE_POINTS])dig->value, feature);
    dig_features_mask(dig->measured, dig->first, dig->last, has);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const double off = (feature[f] - model[f]) / amplitude[f / DIG_FEATURE_BINS];
        sum += has[f] ? off * off / w->scatter->covariance[t][f][f] : 0.0;
    }
    return sum;
}

// The plain dig of that gravel and what the approach adds to it: how far off the dig is. added:
// that.
static enum dig_status compare(const struct dig_trace_work *const w, const double place[],
                               const struct dig_measured *const dig,
                               const struct dig_approach *const approach,
                               struct dig_added *const added, double *const squares)
{
    const size_t            t      = (size_t)dig->trajectory;
    const struct dig_gravel gravel = dig_response_surface_gravel(w->surface, place);
    const enum dig_status   status =
        dig_approach_added(w->set, t, &gravel, approach, dig->deeper, added);
    double feature[DIG_FEATURES];
    double more[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    if (status != DIG_OK) {
        return status;
    }
    dig_response_surface_features(w->surface, t, place, feature, amplitude);
    dig_features_of((const double(*)[DIG_CURVE_POINTS])added->value, more);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        feature[f] += more[f];
    }
    *squares = squares_off(w, dig, feature, amplitude);
    return DIG_OK;
}

static void add_value(struct dig_measured *const dig, const double sign)
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            dig->value[c][k] += dig->measured[c] ? sign * dig->added.value[c][k] : 0.0;
        }
    }
}

static void put_back(struct dig_measured *const dig)
{
    add_value(dig, 1.0);
    memset(&dig->added, 0, sizeof dig->added);
    dig->taken_off = dig_approach_plain();
}

// A path that is longer than the table's is that of a deeper dig, or begins in the air: as deep as
// it was made, level with the table's, or whichever what it resists is liker to.
enum way { MADE, LEVEL, LIKER };

// Takes off what another approach, where a dig's path tells it, adds to the plain dig of that
// gravel; what was taken off of another gravel is put back.
static enum dig_status take_off_approach(const struct dig_trace_work *const w, const double place[],
                                         enum way way, struct dig_measured *const dig)
{
    const struct dig_approach approach[] = {
        [MADE] = dig_approach_normalized(&dig->made), [LEVEL] = { 1.0, dig->made.attack_rad }
    };
    struct dig_added added[2];
    double           squares[2];
    put_back(dig);
    for (int i = MADE; i <= LEVEL; i++) {
        const enum dig_status status = compare(w, place, dig, &approach[i], &added[i], &squares[i]);
        if (status != DIG_OK) {
            return status;
        }
    }
    way            = way != LIKER ? way : squares[MADE] < squares[LEVEL] ? MADE : LEVEL;
    dig->taken_off = approach[way];
    dig->added     = added[way];
    add_value(dig, -1.0);
    return DIG_OK;
}

static enum dig_status take_off_approaches(const struct dig_trace_work *const w,
                                           const double place[], const enum way way)
{
    enum dig_status status = DIG_OK;
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        struct dig_measured *const dig = &w->measured[i];
        if (w->surface->known[dig->trajectory] && is_made_otherwise(dig)) {
            status = take_off_approach(w, place, way, dig);
        }
    }
    return status;
}

// Whitens the digs to fit to, about the gravel at place (NULL: not known yet), into the batch.
static enum dig_status whiten(const struct dig_trace_work *const w, const double place[])
{
    return dig_batch_make(w->soil, w->scatter, w->digs, w->measured, w->fit, place, w->batch);
}

// Fits the plain hypothesis to the batch, thoroughly.
static void fit_plain(const struct dig_trace_work *const w, struct dig_fitted *const plain)
{
    const double middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    dig_hypothesis_fit(w->batch, &none, middle, DIG_FIT_THOROUGH, plain);
}

// -2 log likelihood of a fit of the batch, in units of the table: to compare it with one of a batch
// whitened otherwise. What was taken off was dug in
// few beds: so much is to be expected of it in the digs about their means.
static double misfit_of(const struct dig_trace_work *const w, const struct dig_fitted *const fitted)
{
    double misfit = fitted->misfit;
    for (size_t i = 0; i < w->batch->digs; i++) {
        const struct dig_batch_dig *const dig   = &w->batch->dig[i];
        const struct dig_group *const     group = &w->batch->group[dig->group];
        const double about = (double)group->features * (1.0 - 1.0 / (double)group->digs);
        misfit += group->log_det - about * w->measured[dig->measured].added.noise;
        for (size_t k = 0; k < group->features; k++) {
            misfit += 2.0 * log(group->amplitude[group->feature[k] / DIG_FEATURE_BINS]);
        }
    }
    return misfit;
}

static bool set_share(const struct dig_trace_work *const w, const double share)
{
    bool any = false;
    for (size_t i = 0; i < w->digs; i++) {
        if (w->measured[i].depth_share > 0.0) {
            w->measured[i].depth_share = share;
            any                        = true;
        }
    }
    return any;
}

// The batch at a gravel, its open depths as wide as makes the digs likeliest: a machine whose
// ground lies where the table has it is not to pay for others'.
static enum dig_status open_depths(const struct dig_trace_work *const w, const double place[])
{
    static const double shares[] = { 1.0, 0.5, 0.25, LEAST_SHARE };
    double              best     = 1.0;
    double              least    = INFINITY;
    enum dig_status     status   = DIG_OK;
    if (!set_share(w, best) || !dig_approach_varies_any(w->set)) {
        return whiten(w, place);
    }
    for (size_t i = 0; i < sizeof shares / sizeof shares[0] && status == DIG_OK; i++) {
        struct dig_fitted plain;
        (void)set_share(w, shares[i]);
        status = whiten(w, place);
        if (status == DIG_OK) {
            fit_plain(w, &plain);
            const double misfit = misfit_of(w, &plain);
            best                = misfit < least ? shares[i] : best;
            least               = fmin(misfit, least);
        }
    }
    (void)set_share(w, best);
    return status == DIG_OK ? whiten(w, place) : status;
}

// What an approach adds depends on the gravel, and the gravel on what is taken off: begins with one
// way for all digs, and lets each go its own.
static enum dig_status settle(const struct dig_trace_work *const w, const enum way begin,
                              struct dig_fitted *const plain)
{
    enum { ROUNDS = 3 };
    for (size_t i = 0; i < w->digs; i++) {
        put_back(&w->measured[i]);
    }
    enum dig_status status = whiten(w, NULL);
    for (int round = 0; round < ROUNDS && status == DIG_OK; round++) {
        fit_plain(w, plain);
        status = take_off_approaches(w, plain->number, round == 0 ? begin : LIKER);
        status = status == DIG_OK ? whiten(w, plain->number) : status;
    }
    if (status == DIG_OK) {
        fit_plain(w, plain);
    }
    return status;
}

// Settled from either beginning, and kept as the digs are likeliest.
static enum dig_status settle_best(const struct dig_trace_work *const w,
                                   struct dig_fitted *const           plain)
{
    bool any  = false;
    bool deep = false;
    for (size_t i = 0; i < w->digs; i++) {
        any  = any || is_made_otherwise(&w->measured[i]);
        deep = deep || fabs(dig_approach_normalized(&w->measured[i].made).depth - 1.0) > 0.0;
    }
    (void)set_share(w, deep ? LEAST_SHARE : 1.0);
    if (!any) {
        const enum dig_status status = whiten(w, NULL);
        if (status == DIG_OK) {
            fit_plain(w, plain);
        }
        return status;
    }
    enum dig_status status = settle(w, MADE, plain);
    if (deep && status == DIG_OK) {
        const double made = misfit_of(w, plain);
        status            = settle(w, LEVEL, plain);
        if (status == DIG_OK && made < misfit_of(w, plain)) {
            status = settle(w, MADE, plain);
        }
    }
    return status;
}

enum dig_status dig_trace_batch(const struct dig_trace_work *const w,
                                struct dig_fitted *const plain, struct dig_error *const error)
{
    enum dig_status status = settle_best(w, plain);
    if (status == DIG_OK) {
        status = open_depths(w, plain->number);
    }
    if (status != DIG_OK) {
        return dig_error_set(error, DIG_EINVAL,
                             "the digs of one trajectory have too little measured in common");
    }
    fit_plain(w, plain);
    return DIG_OK;
}

// Estimates noise of sensors that is correlated over a bin of a dig, as of a filtered load cell or
// an arm that trembles. Rows do not show it, as grains move as slowly. But it is as large where a
// dig hardly resists, it is rough along the dig, and no two digs have the same: neither scatter of
// beds nor any effect is like that. So the likelihood of the digs shows it.
//
// Sizes of noise that are asked about, over the mean dig's, each .6 of the one before, and how long
// it may last.
static const double shares[]   = { 0.25, 0.15, 0.09, 0.054, 0.0324, 0.0194, 0.0117 };
static const double memory_s[] = { 0.03, 0.1, 0.3 };

static enum dig_status set_noise(const struct dig_trace_work *const w, const double place[DIG_AXES],
                                 const struct dig_lasting *const noise)
{
    for (size_t i = 0; i < w->digs; i++) {
        w->measured[i].lasting = *noise;
    }
    return whiten(w, place);
}

// Misfit by which an effect must lead the plain gravel to have a say.
static const double told_apart = 2.0 * DIG_SEARCH_TOLD_APART;

// The misfit, with that noise, of what explains the digs best: a plain gravel, or one effect, or
// what has no name, where that is told apart from it. Noise must not take from an effect what is
// its own. start: where to fit from, then the plain fit.
static enum dig_status least_misfit(const struct dig_trace_work *const w,
                                    const double                       place[DIG_AXES],
                                    const struct dig_lasting *const    noise,
                                    double start[DIG_HYPOTHESIS_NUMBERS], double *const misfit)
{
    struct dig_hypothesis single[DIG_RIVALS_MAX];
    struct dig_fitted     fitted[DIG_RIVALS_MAX + 1];
    struct dig_fitted     nameless;
    struct dig_statistic  statistic;
    const enum dig_status status = set_noise(w, place, noise);
    if (status != DIG_OK) {
        return status;
    }
    const size_t rivals = dig_search_rivals(w->batch, single);
    dig_null_simulation_fit(w->batch, &none, rivals, single, start, DIG_FIT_BARE, fitted,
                            &statistic);
    dig_hypothesis_fit_unlisted(w->batch, &fitted[0], &nameless);
    memcpy(start, fitted[0].number, sizeof fitted[0].number);
    const double gain = fmax(statistic.gain, fitted[0].misfit - nameless.misfit);
    *misfit           = misfit_of(w, &fitted[0]) - fmax(gain - told_apart, 0.0);
    return status;
}

// Noise of a share of the mean dig's size, over the trajectories.
static struct dig_lasting noise_of(const struct dig_batch *const batch, const double share,
                                   const double lasts_s)
{
    struct dig_lasting noise = { .memory_s = lasts_s };
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            noise.sigma[c] += share * batch->group[g].amplitude[c] / (double)batch->groups;
        }
    }
    return noise;
}

enum dig_status dig_trace_tell_noise(const struct dig_trace_work *const w,
                                     struct dig_fitted *const           plain)
{
    const struct dig_batch without                       = *w->batch;
    double                 start[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_lasting     told                          = { .memory_s = 0.0 };
    double                 best                          = 0.0;
    double                 place[DIG_HYPOTHESIS_NUMBERS];
    memcpy(start, plain->number, DIG_AXES * sizeof start[0]);
    memcpy(place, start, sizeof place);
    enum dig_status status = least_misfit(w, plain->number, &told, start, &best);
    best -=
        2.0 * dig_search_penalty(&without, 1); // noise's size; its memory hardly tells by itself
    for (size_t m = 0; m < sizeof memory_s / sizeof memory_s[0]; m++) {
        for (size_t i = 0; i < sizeof shares / sizeof shares[0] && status == DIG_OK; i++) {
            const struct dig_lasting noise = noise_of(&without, shares[i], memory_s[m]);
            double                   misfit;
            status = least_misfit(w, plain->number, &noise, start, &misfit);
            if (status == DIG_OK && misfit < best) {
                best = misfit;
                told = noise;
                memcpy(place, start, sizeof place);
            }
        }
    }
    if (status == DIG_OK) {
        status = set_noise(w, place, &told);
    }
    if (status == DIG_OK && told.memory_s > 0.0) {
        fit_plain(w, plain);
    } else if (status == DIG_OK) {
        *w->batch = without;
    }
    return status;
}
