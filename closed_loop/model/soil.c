#include "closed_loop/model/soil.h"

#include "closed_loop/model/soil_fit.h"
#include "estimator/effects/effect.h"
#include "estimator/effects/template.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has_templates(const enum dig_effect_id effect)
{
    const struct dig_effect *const known = dig_effect_of(effect);
    return known == NULL || known->templated;
}

static void fill_speeds(struct dig_soil *const soil)
{
    const struct dig_curve_set *const set = soil->surface->set;
    for (size_t t = 0; t < set->trajectories; t++) {
        double speed[DIG_CURVE_POINTS];
        dig_effect_speeds(set, t, speed);
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            double               sum    = 0.0;
            const struct dig_bin points = dig_feature_bin(b);
            for (size_t k = points.from; k < points.to; k++) {
                soil->speed[t][k] = speed[k];
                sum += log(speed[k]);
            }
            soil->bin_speed[t][b] = exp(sum / (double)(points.to - points.from));
        }
    }
}

enum dig_status dig_soil_create(const struct dig_response_surface *const surface,
                                const struct dig_entry_set *const        effects,
                                const struct dig_scatter *const          scatter,
                                struct dig_soil **const                  soil)
{
    assert(surface != NULL && (effects == NULL || scatter != NULL) && soil != NULL);
    if (effects != NULL && (strcmp(effects->scene_hash, surface->set->scene_hash) != 0 ||
                            effects->trajectories != surface->set->trajectories)) {
        return DIG_EINVAL;
    }
    struct dig_soil *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        return DIG_ENOMEM;
    }
    made->surface = surface;
    fill_speeds(made);
    for (int e = 0; e < DIG_EFFECTS; e++) {
        made->absent[e] = dig_template_absent((enum dig_effect_id)e);
        if (!has_templates((enum dig_effect_id)e)) {
            made->scale[e] = 1.0;
            made->high[e]  = dig_effect_of((enum dig_effect_id)e)->reach;
            made->low[e]   = -made->high[e];
        }
    }
    if (effects != NULL && dig_soil_fit(made, effects, scatter) != DIG_OK) {
        free(made);
        return DIG_ENOMEM;
    }
    *soil = made;
    return DIG_OK;
}

bool dig_soil_knows(const struct dig_soil *const soil, const enum dig_effect_id effect,
                    const size_t trajectory)
{
    const bool above = soil->high[effect] > 0.0;
    const bool below = soil->low[effect] < 0.0;
    return !has_templates(effect) ||
           ((above || below) &&
            (!above || dig_soil_template_at(soil, effect, trajectory, 1.0)->known) &&
            (!below || dig_soil_template_at(soil, effect, trajectory, -1.0)->known));
}

double dig_soil_share(const enum dig_effect_id effect, const struct dig_measured *const dig)
{
    const struct dig_effect_dig of = { .pass = dig->pass, .order = dig->order, .pace = dig->pace };
    return dig_effect_share(effect, &of);
}

// What an effect without templates adds, as a share of the plain dig.
static double factor_of(const struct dig_soil *const soil, const enum dig_effect_id effect,
                        const double u, const double share, const double speed)
{
    const struct dig_effect *const known = dig_effect_of(effect);
    double                         value[DIG_MODEL_PARAMETERS_MAX];
    dig_effect_absent(known, value);
    value[0] = u;
    value[1] = effect == DIG_EFFECT_RATE_DEPENDENCE ? soil->along : value[1];
    return known->factor != NULL ? known->factor(value, share, speed) : 0.0;
}

// The template of an effect and its terms at a place, u scaled to the gravel's density.
static const struct dig_soil_template *terms_of(const struct dig_soil *const soil,
                                                const enum dig_effect_id effect, const size_t t,
                                                const double place[DIG_AXES], const double u,
                                                const double amplitude[DIG_FORCE_CHANNELS],
                                                double       term[DIG_SOIL_TERMS])
{
    const struct dig_soil_template *const template = dig_soil_template_at(soil, effect, t, u);
    const struct dig_gravel  gravel = dig_response_surface_gravel(soil->surface, place);
    const struct dig_soil_at at     = { u * dig_template_scale(soil->surface->set, effect,
                                                               template->base_density_kgpm3,
                                                               gravel.value[DIG_AXIS_DENSITY_kgpm3]),
                                        dig_soil_strength(soil->surface, place, amplitude) };
    dig_soil_terms(template, &at, term);
    return template;
}

void dig_soil_add(const struct dig_soil *const soil, const enum dig_effect_id effect,
                  const size_t trajectory, const double place[DIG_AXES], const double u,
                  const double contrast, const double share, const double plain[DIG_FEATURES],
                  const double amplitude[DIG_FORCE_CHANNELS], double feature[DIG_FEATURES],
                  double *const noise)
{
    if (!has_templates(effect)) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const double factor = factor_of(soil, effect, u, share, soil->bin_speed[trajectory][b]);
            for (size_t f = b; f < DIG_FEATURES; f += DIG_FEATURE_BINS) {
                feature[f] += factor * plain[f];
            }
        }
        return;
    }
    double term[DIG_SOIL_TERMS];
    const struct dig_soil_template *const template =
        terms_of(soil, effect, trajectory, place, u * share, amplitude, term);
    // Most hats are nothing at any one magnitude.
    size_t some[DIG_SOIL_TERMS];
    size_t n = 0;
    for (size_t i = 0; i < template->terms; i++) {
        term[i] *= contrast;
        if (fabs(term[i]) > 0.0) {
            some[n++] = i;
        }
    }
    for (size_t i = 0; noise != NULL && i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            *noise += term[some[i]] * template->inverse[some[i]][some[j]] * term[some[j]];
        }
    }
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double shape[DIG_FEATURE_BINS] = { 0.0 };
        for (size_t i = 0; i < n; i++) {
            const double *const of = &template->feature[some[i]][c * DIG_FEATURE_BINS];
            for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
                shape[b] += term[some[i]] * of[b];
            }
        }
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            feature[c * DIG_FEATURE_BINS + b] += shape[b] * amplitude[c];
        }
    }
}

void dig_soil_add_curve(const struct dig_soil *const soil, const enum dig_effect_id effect,
                        const size_t trajectory, const double place[DIG_AXES], const double u,
                        const double contrast, const double share,
                        const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    if (!has_templates(effect)) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double factor = factor_of(soil, effect, u, share, soil->speed[trajectory][k]);
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                curve[c][k] += factor * plain[c][k];
            }
        }
        return;
    }
    double term[DIG_SOIL_TERMS];
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    dig_response_surface_features(soil->surface, trajectory, place, feature, amplitude);
    const struct dig_soil_template *const template =
        terms_of(soil, effect, trajectory, place, u * share, amplitude, term);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            double sum = 0.0;
            for (size_t i = 0; i < template->terms; i++) {
                sum += contrast * term[i] * template->curve[i][c][k] * amplitude[c];
            }
            curve[c][k] += sum;
        }
    }
}

double dig_soil_magnitude(const struct dig_soil *const soil, const enum dig_effect_id effect,
                          const double u)
{
    return soil->absent[effect] + u * soil->scale[effect];
}
