#include "estimator/effects/effect.h"

#include "estimator/approach/interpolate.h"
#include "estimator/effects/list.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const struct dig_effect *const list[DIG_EFFECTS] = {
    [DIG_EFFECT_CYLINDER_FRICTION] = &dig_effect_cylinder_friction,
    [DIG_EFFECT_PRESSURE_OFFSET]   = &dig_effect_pressure_offset,
    [DIG_EFFECT_BUCKET_WEIGHT]     = &dig_effect_bucket_weight,
    [DIG_EFFECT_BUCKET_INERTIA]    = &dig_effect_bucket_inertia,
    [DIG_EFFECT_PAYLOAD]           = &dig_effect_payload,
    [DIG_EFFECT_LINKAGE_GEOMETRY]  = &dig_effect_linkage_geometry,
    [DIG_EFFECT_SENSOR_DELAY]      = &dig_effect_sensor_delay,
    [DIG_EFFECT_COHESION]          = &dig_effect_cohesion,
    [DIG_EFFECT_ADHESION]          = &dig_effect_adhesion,
    [DIG_EFFECT_POLYDISPERSITY]    = &dig_effect_polydispersity,
    [DIG_EFFECT_GRAIN_SHAPE]       = &dig_effect_grain_shape,
    [DIG_EFFECT_GROUND_SLOPE]      = &dig_effect_ground_slope,
    [DIG_EFFECT_LAYERING]          = &dig_effect_layering,
    [DIG_EFFECT_OBSTACLE]          = &dig_effect_obstacle,
    [DIG_EFFECT_COMPACTION]        = &dig_effect_compaction,
    [DIG_EFFECT_RATE_DEPENDENCE]   = &dig_effect_rate_dependence,
    [DIG_EFFECT_WEAR]              = &dig_effect_wear,
    [DIG_EFFECT_BUCKET_FRICTION]   = &dig_effect_bucket_friction,
};

const struct dig_effect *dig_effect_of(const enum dig_effect_id id)
{
    assert(id >= 0 && id < DIG_EFFECTS);
    return list[id];
}

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

// The plain curve of a gravel, which a reduced form scales.
static enum dig_status plain_at(const struct dig_curve_set *const plain,
                                const struct dig_gravel *const gravel, const size_t trajectory,
                                struct dig_curve *const curve)
{
    struct dig_cell       cell;
    const enum dig_status status = dig_cell_find(plain, gravel, trajectory, &cell);
    if (status != DIG_OK) {
        return status;
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[c][k] = (float)dig_cell_mean(&cell, (enum dig_channel)c, k);
            curve->sd[c][k]   = 0.0F;
        }
    }
    return DIG_OK;
}

enum dig_status dig_effect_add(const struct dig_effect *const     effect,
                               const struct dig_curve_set *const  plain,
                               const struct dig_effect_set *const effects, const double value[],
                               const struct dig_gravel *const     gravel,
                               const struct dig_effect_dig *const dig,
                               struct dig_template *const         added)
{
    assert(effect != NULL && effect->correct == NULL && plain != NULL && value != NULL);
    assert(gravel != NULL && dig != NULL && added != NULL);
    struct dig_template sum = { .delta = { { 0.0 } } };
    if (effect->templated) {
        const double at     = effect->magnitude != NULL ? effect->magnitude(value, dig) : value[0];
        const bool   absent = fabs(at - dig_template_absent(effect->id)) <= 0.0;

        const enum dig_status status = absent ? DIG_OK
                                              : dig_template_find(plain, effects, effect->id, at,
                                                                  gravel, dig->trajectory, &sum);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (effect->reduce != NULL) {
        struct dig_curve      curve;
        const enum dig_status status = plain_at(plain, gravel, dig->trajectory, &curve);
        if (status != DIG_OK) {
            return status;
        }
        double                speed[DIG_CURVE_POINTS];
        struct dig_effect_dig along = *dig;
        if (along.speed == NULL) {
            dig_effect_speeds(plain, dig->trajectory, speed);
            along.speed = speed;
        }
        effect->reduce(value, &along, &curve, sum.delta);
    }
    *added = sum;
    return DIG_OK;
}
