#include "estimator/effects/effect.h"

#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void dig_effect_absent(const struct dig_effect *const effect,
                       double                         value[DIG_MODEL_PARAMETERS_MAX])
{
    assert(effect != NULL && value != NULL);
    for (size_t p = 0; p < DIG_MODEL_PARAMETERS_MAX; p++) {
        value[p] = p < effect->parameters ? effect->parameter[p].absent : 0.0;
    }
}

enum dig_status dig_effect_values(const struct dig_model_effect *const found,
                                  double value[DIG_MODEL_PARAMETERS_MAX])
{
    assert(found != NULL && value != NULL);
    const struct dig_effect *const effect = dig_effect_of(found->effect);
    if (effect == NULL) {
        return DIG_EINVAL;
    }
    double read[DIG_MODEL_PARAMETERS_MAX];
    dig_effect_absent(effect, read);
    for (size_t i = 0; i < found->parameters; i++) {
        size_t p = 0;
        while (p < effect->parameters &&
               strcmp(effect->parameter[p].name, found->parameter[i].name) != 0) {
            p++;
        }
        const double at = found->parameter[i].value;
        if (p == effect->parameters ||
            !(at >= effect->parameter[p].low && at <= effect->parameter[p].high)) {
            return DIG_EINVAL;
        }
        read[p] = at;
    }
    memcpy(value, read, sizeof read);
    return DIG_OK;
}

static void add_factor(const struct dig_effect *const    effect,
                       const struct dig_curve_set *const plain, const double value[],
                       const size_t trajectory, const double share,
                       const struct dig_curve *const curve,
                       double                        delta[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    double speed[DIG_CURVE_POINTS];
    dig_effect_speeds(plain, trajectory, speed);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double factor = effect->factor(value, share, speed[k]);
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            delta[c][k] += factor * (double)curve->mean[c][k];
        }
    }
}

static void times(const double by, struct dig_template *const sum)
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sum->delta[c][k] *= by;
            sum->sigma[c][k] *= by;
        }
    }
}

enum dig_status dig_effect_add(const struct dig_effect *const    effect,
                               const struct dig_curve_set *const plain,
                               const struct dig_entry_set *const effects, const double value[],
                               const struct dig_gravel *const     gravel,
                               const struct dig_effect_dig *const dig,
                               struct dig_template *const         added)
{
    assert(effect != NULL && effect->correct == NULL && plain != NULL && value != NULL);
    assert(gravel != NULL && dig != NULL && added != NULL);
    struct dig_template sum   = { .delta = { { 0.0 } } };
    const double        share = dig_effect_share(effect->id, dig);
    if (effect->templated) {
        const double          at     = value[0] * share;
        const bool            absent = fabs(at - dig_template_absent(effect->id)) <= 0.0;
        const enum dig_status status = absent ? DIG_OK
                                              : dig_template_find(plain, effects, effect->id, at,
                                                                  gravel, dig->trajectory, &sum);
        if (status != DIG_OK) {
            return status;
        }
        times(effect->contrasted ? value[1] : 1.0, &sum);
    }
    if (effect->factor != NULL || effect->reduce != NULL) {
        struct dig_cell       cell;
        struct dig_curve      curve;
        const enum dig_status status = dig_cell_find(plain, gravel, dig->trajectory, &cell);
        if (status != DIG_OK) {
            return status;
        }
        dig_cell_curve(&cell, &curve);
        if (effect->factor != NULL) {
            add_factor(effect, plain, value, dig->trajectory, share, &curve, sum.delta);
        }
        if (effect->reduce != NULL) {
            effect->reduce(value, &curve, sum.delta);
        }
    }
    *added = sum;
    return DIG_OK;
}
