// Applies a model's effects: the machine's as one correction, the soil's to a table's curves.

#include "estimator/effects/effect.h"

#include "core/outline.h"

#include <assert.h>
#include <math.h>

enum dig_status dig_effects_correction(const struct dig_model *const model,
                                       struct dig_correction *const  correction)
{
    assert(model != NULL && correction != NULL);
    struct dig_correction sum = { .delay_s = 0.0 };
    for (size_t e = 0; e < model->effects; e++) {
        const enum dig_effect_id id = model->effect[e].effect;
        if (!dig_effect_is_of_machine(id) || id == DIG_EFFECT_PAYLOAD) {
            continue;
        }
        double                value[DIG_MODEL_PARAMETERS_MAX];
        const enum dig_status status = dig_effect_values(&model->effect[e], value);
        if (status != DIG_OK) {
            return status;
        }
        dig_effect_of(id)->correct(value, &sum);
    }
    *correction = sum;
    return DIG_OK;
}

static void add(const struct dig_template *const added, struct dig_curve *const curve)
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        const double error  = (double)curve->error[c];
        double       error2 = error * error * dig_curve_mean_square(curve->mean[c]);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[c][k] = (float)((double)curve->mean[c][k] + added->delta[c][k]);
            curve->sd[c][k]   = (float)hypot((double)curve->sd[c][k], added->sigma[c][k]);
            error2 += added->sigma[c][k] * added->sigma[c][k] / DIG_CURVE_POINTS;
        }
        const double mean2 = dig_curve_mean_square(curve->mean[c]);
        curve->error[c]    = mean2 > 0.0 ? (float)sqrt(error2 / mean2) : 0.0F;
    }
}

static void add_unlisted(const struct dig_model_unlisted *const unlisted, const size_t trajectory,
                         const struct dig_curve *const plain, struct dig_curve *const curve)
{
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        const double scale = sqrt(dig_curve_mean_square(plain->mean[c]));
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double more = scale * (double)unlisted->share[trajectory][c][k];
            curve->mean[c][k] = (float)((double)curve->mean[c][k] + more);
        }
    }
}

// Applies all effects to one curve of the table.
static enum dig_status apply(const struct dig_curve_set *const plain,
                             const struct dig_entry_set *const effects,
                             const struct dig_model *const model, const size_t entry,
                             const size_t trajectory, struct dig_curve *const out)
{
    const struct dig_curve *const before = &plain->curve[entry * plain->trajectories + trajectory];
    const struct dig_effect_dig   dig    = { .trajectory = trajectory, .pass = 1, .pace = 1.0 };

    struct dig_curve curve = *before;
    for (size_t e = 0; e < model->effects; e++) {
        const struct dig_effect *const effect = dig_effect_of(model->effect[e].effect);
        if (effect == NULL || effect->correct != NULL) {
            continue;
        }
        double              value[DIG_MODEL_PARAMETERS_MAX];
        struct dig_template added;
        enum dig_status     status = dig_effect_values(&model->effect[e], value);
        if (status == DIG_OK) {
            status =
                dig_effect_add(effect, plain, effects, value, &plain->gravel[entry], &dig, &added);
        }
        if (status != DIG_OK) {
            return status;
        }
        add(&added, &curve);
    }
    if (model->unlisted.any) {
        add_unlisted(&model->unlisted, trajectory, before, &curve);
    }
    *out = curve;
    return DIG_OK;
}

enum dig_status dig_effects_apply(const struct dig_curve_set *const plain,
                                  const struct dig_entry_set *const effects,
                                  const struct dig_model *const     model,
                                  struct dig_curve_set *const       out)
{
    assert(plain != NULL && model != NULL && out != NULL && out != plain);
    assert(out->entries == plain->entries && out->trajectories == plain->trajectories);
    size_t applied = 0;
    for (size_t e = 0; e < plain->entries; e++) {
        for (size_t t = 0; t < plain->trajectories; t++) {
            const size_t slot = e * plain->trajectories + t;
            if (plain->packings[slot] <= 0) {
                continue;
            }
            const enum dig_status status = apply(plain, effects, model, e, t, &out->curve[slot]);
            if (status == DIG_ENOMATCH) {
                out->packings[slot] = 0; // no template: not known, rather than wrong
            } else if (status != DIG_OK) {
                return status;
            } else {
                applied++;
            }
        }
    }
    dig_outlines_draw(out);
    return applied > 0 ? DIG_OK : DIG_ENOMATCH;
}
