#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/model/approach_change.h"
#include "estimator/approach/approach_slots.h"

#include <math.h>
#include <string.h>

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
    const enum dig_status   status = dig_approach_added(w->set, t, &gravel, approach, added);
    double                  feature[DIG_FEATURES];
    double                  more[DIG_FEATURES];
    double                  amplitude[DIG_FORCE_CHANNELS];
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

// Takes off what another approach, where a dig's path tells it, adds to the plain dig of that
// gravel; what was taken off of another gravel is put back. A path that is longer as it begins in
// the air is told by what it resists: as it would at depth 1.
static enum dig_status take_off_approach(const struct dig_trace_work *const w, const double place[],
                                         struct dig_measured *const dig)
{
    enum { MADE, LEVEL, WAYS };
    const struct dig_approach way[WAYS] = {
        [MADE] = dig_approach_normalized(&dig->made), [LEVEL] = { 1.0, dig->made.attack_rad }
    };
    struct dig_added added[WAYS];
    double           squares[WAYS];
    add_value(dig, 1.0);
    memset(&dig->added, 0, sizeof dig->added);
    for (int i = 0; i < WAYS; i++) {
        const enum dig_status status = compare(w, place, dig, &way[i], &added[i], &squares[i]);
        if (status != DIG_OK) {
            return status;
        }
    }
    const int chosen = squares[MADE] < squares[LEVEL] ? MADE : LEVEL;
    dig->taken_off   = way[chosen];
    dig->added       = added[chosen];
    add_value(dig, -1.0);
    return DIG_OK;
}

// *any: a path tells one.
static enum dig_status take_off_approaches(const struct dig_trace_work *const w,
                                           const double place[], bool *const any)
{
    enum dig_status status = DIG_OK;
    *any                   = false;
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        struct dig_measured *const dig = &w->measured[i];
        if (w->surface->known[dig->trajectory] && !dig_approach_is_plain(&dig->made)) {
            status = take_off_approach(w, place, dig);
            *any   = true;
        }
    }
    return status;
}

static enum dig_status make_batch(const struct dig_trace_work *const w, const double place[])
{
    return dig_whitened_digs_make(w->surface, w->scatter, w->digs, w->measured, w->fit, place,
                                  w->batch);
}

static void fit_plain(const struct dig_trace_work *const w, struct dig_fitted *const plain)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    dig_hypothesis_fit(w->batch, w->soil, &none, middle, DIG_FIT_THOROUGH, plain);
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
    static const double shares[] = { 1.0, 0.5, 0.25, 0.125 };
    double              best     = 1.0;
    double              least    = INFINITY;
    enum dig_status     status   = DIG_OK;
    if (!set_share(w, best) || !dig_approach_varies_any(w->set)) {
        return make_batch(w, place);
    }
    for (size_t i = 0; i < sizeof shares / sizeof shares[0] && status == DIG_OK; i++) {
        struct dig_fitted plain;
        (void)set_share(w, shares[i]);
        status = make_batch(w, place);
        if (status == DIG_OK) {
            fit_plain(w, &plain);
            double misfit = plain.misfit;
            for (size_t g = 0; g < w->batch->groups; g++) {
                misfit += (double)w->batch->group[g].digs * w->batch->group[g].log_det;
            }
            best  = misfit < least ? shares[i] : best;
            least = fmin(misfit, least);
        }
    }
    (void)set_share(w, best);
    return status == DIG_OK ? make_batch(w, place) : status;
}

// What an approach adds depends on the gravel, and the gravel on what is taken off.
enum dig_status dig_trace_batch(const struct dig_trace_work *const w,
                                struct dig_fitted *const plain, struct dig_error *const error)
{
    enum { ROUNDS = 3 };
    bool any = true;
    (void)set_share(w, 1.0);
    enum dig_status status = make_batch(w, NULL);
    for (int round = 0; round < ROUNDS && status == DIG_OK && any; round++) {
        fit_plain(w, plain);
        status = take_off_approaches(w, plain->number, &any);
        status = status == DIG_OK ? make_batch(w, plain->number) : status;
    }
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
