#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/model/depth_change.h"

#include <math.h>

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

// Takes off what another depth, where a dig's path tells it, adds to the plain dig of that gravel.
// A path that is longer as it begins in the air is told by what it resists: as the plain dig does.
static enum dig_status take_off_depth(const struct dig_trace_work *const w, const double place[],
                                      struct dig_measured *const dig)
{
    const size_t            t      = (size_t)dig->trajectory;
    const struct dig_gravel gravel = dig_response_surface_gravel(w->surface, place);
    double                  added[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double                  plain[DIG_FEATURES];
    double                  deeper[DIG_FEATURES];
    double                  amplitude[DIG_FORCE_CHANNELS];
    const enum dig_status   status = dig_depth_added(w->set, t, &gravel, dig->depth, added);
    if (status != DIG_OK || !w->surface->known[t]) {
        return status;
    }
    dig_response_surface_features(w->surface, t, place, plain, amplitude);
    dig_features_of((const double(*)[DIG_CURVE_POINTS])added, deeper);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        deeper[f] += plain[f];
    }
    const bool is_deeper =
        squares_off(w, dig, deeper, amplitude) < squares_off(w, dig, plain, amplitude);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            dig->value[c][k] -= is_deeper && dig->measured[c] ? added[c][k] : 0.0;
        }
    }
    dig->depth = 1.0;
    return DIG_OK;
}

static enum dig_status take_off_depths(const struct dig_trace_work *const w, const double place[])
{
    enum dig_status status = DIG_OK;
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        struct dig_measured *const dig = &w->measured[i];
        if (dig->depth > 0.0 && fabs(dig->depth - 1.0) > 0.0) {
            status = take_off_depth(w, place, dig);
        }
    }
    return status;
}

enum dig_status dig_trace_batch(const struct dig_trace_work *const w,
                                struct dig_fitted *const plain, struct dig_error *const error)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    enum dig_status status = dig_whitened_digs_make(w->surface, w->scatter, w->digs, w->measured,
                                                    w->fit, NULL, w->batch);
    for (int round = 0; round < 2 && status == DIG_OK; round++) {
        dig_hypothesis_fit(w->batch, w->soil, &none, middle, DIG_FIT_THOROUGH, plain);
        status = round == 0 ? take_off_depths(w, plain->number) : DIG_OK;
        if (round == 0 && status == DIG_OK) {
            status = dig_whitened_digs_make(w->surface, w->scatter, w->digs, w->measured, w->fit,
                                            plain->number, w->batch);
        }
    }
    return status == DIG_OK
               ? status
               : dig_error_set(error, DIG_EINVAL,
                               "the digs of one trajectory have too little measured in common");
}
