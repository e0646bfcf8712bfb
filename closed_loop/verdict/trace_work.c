#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/model/approach_change.h"
#include "estimator/approach/approach_slots.h"

#include <math.h>
#include <string.h>

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

enum dig_status dig_trace_whiten(const struct dig_trace_work *const w, const double place[])
{
    return dig_whitened_digs_make(w->soil, w->scatter, w->digs, w->measured, w->fit, place,
                                  w->batch);
}

void dig_trace_fit_plain(const struct dig_trace_work *const w, struct dig_fitted *const plain)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    dig_hypothesis_fit(w->batch, &none, middle, DIG_FIT_THOROUGH, plain);
}

// Of digs that are whitened otherwise, too, in units of the table. What was taken off was dug in
// few beds: so much is to be expected of it in the digs about their means.
double dig_trace_misfit(const struct dig_trace_work *const w, const struct dig_fitted *const fitted)
{
    double misfit = fitted->misfit;
    for (size_t i = 0; i < w->batch->digs; i++) {
        const struct dig_whitened_digs_dig *const   dig   = &w->batch->dig[i];
        const struct dig_whitened_digs_group *const group = &w->batch->group[dig->group];
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
        return dig_trace_whiten(w, place);
    }
    for (size_t i = 0; i < sizeof shares / sizeof shares[0] && status == DIG_OK; i++) {
        struct dig_fitted plain;
        (void)set_share(w, shares[i]);
        status = dig_trace_whiten(w, place);
        if (status == DIG_OK) {
            dig_trace_fit_plain(w, &plain);
            const double misfit = dig_trace_misfit(w, &plain);
            best                = misfit < least ? shares[i] : best;
            least               = fmin(misfit, least);
        }
    }
    (void)set_share(w, best);
    return status == DIG_OK ? dig_trace_whiten(w, place) : status;
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
    enum dig_status status = dig_trace_whiten(w, NULL);
    for (int round = 0; round < ROUNDS && status == DIG_OK; round++) {
        dig_trace_fit_plain(w, plain);
        status = take_off_approaches(w, plain->number, round == 0 ? begin : LIKER);
        status = status == DIG_OK ? dig_trace_whiten(w, plain->number) : status;
    }
    if (status == DIG_OK) {
        dig_trace_fit_plain(w, plain);
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
        const enum dig_status status = dig_trace_whiten(w, NULL);
        if (status == DIG_OK) {
            dig_trace_fit_plain(w, plain);
        }
        return status;
    }
    enum dig_status status = settle(w, MADE, plain);
    if (deep && status == DIG_OK) {
        const double made = dig_trace_misfit(w, plain);
        status            = settle(w, LEVEL, plain);
        if (status == DIG_OK && made < dig_trace_misfit(w, plain)) {
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
    dig_trace_fit_plain(w, plain);
    return DIG_OK;
}
