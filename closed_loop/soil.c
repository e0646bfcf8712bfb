#include "closed_loop/soil.h"

#include "closed_loop/dense.h"
#include "estimator/effects/effect.h"
#include "estimator/effects/template.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BASES_MAX = 16 };

static const double ridge = 1e-6; // of the diagonal, where magnitudes make terms nearly the same

// Beyond the table's largest magnitude.
static const double beyond = 1.5;

// Of the reduced forms: the exponent of pace, the share a dig adds.
static const double most_rate = 1.0;
static const double most_wear = 0.15;

// How far beyond the base gravels' strengths a template goes on changing.
static const double most_strength = 1.3;

static bool has_factor(const enum dig_effect_id effect)
{
    return effect == DIG_EFFECT_RATE_DEPENDENCE || effect == DIG_EFFECT_WEAR;
}

static bool acts_by_weight(const enum dig_effect_id effect)
{
    return effect == DIG_EFFECT_COHESION || effect == DIG_EFFECT_ADHESION;
}

static double strength_at(const struct dig_surface *const surface, const size_t t,
                          const double place[DIG_AXES], const double amplitude[DIG_FORCE_CHANNELS])
{
    (void)t;
    const struct dig_gravel gravel = dig_surface_gravel(surface, place);
    return log(amplitude[DIG_CHANNEL_MY_Nm] / gravel.value[DIG_AXIS_DENSITY_kgpm3]);
}

// One bed of an effect along one trajectory, relative to the plain dig of its gravel.
struct bed {
    double                  u, strength, weight;
    double                  amplitude[DIG_FORCE_CHANNELS];
    const struct dig_curve *curve;
    double                  plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

static void describe_bed(const struct dig_soil *const soil, const struct dig_effect_set *const set,
                         const size_t entry, const size_t t, struct bed *const bed)
{
    const struct dig_effect_entry *const of = &set->entry[entry];
    double                               place[DIG_AXES];
    double                               feature[DIG_FEATURES];
    dig_surface_place(soil->surface, &of->gravel, place);
    dig_surface_features(soil->surface, t, place, feature, bed->amplitude);
    dig_surface_curve(soil->surface, t, place, bed->plain);
    bed->curve    = &set->curve[entry * set->trajectories + t];
    bed->u        = (of->magnitude - soil->absent[of->effect]) / soil->scale[of->effect];
    bed->strength = strength_at(soil->surface, t, place, bed->amplitude);

    // A dig that is larger with the effect scatters more.
    double with[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double size[DIG_FORCE_CHANNELS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            with[c][k] = (double)bed->curve->mean[c][k];
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])with, feature);
    dig_features_amplitude(feature, NULL, size);
    bed->weight = (double)set->packings[entry * set->trajectories + t] /
                  pow(size[DIG_CHANNEL_MY_Nm] / bed->amplitude[DIG_CHANNEL_MY_Nm], 2.0);
}

static size_t gather(const struct dig_soil *const soil, const struct dig_effect_set *const set,
                     const enum dig_effect_id effect, const size_t t, const size_t room,
                     struct bed bed[])
{
    size_t beds = 0;
    for (size_t e = 0; e < set->entries && beds < room; e++) {
        if (set->entry[e].effect == effect && set->packings[e * set->trajectories + t] > 0) {
            describe_bed(soil, set, e, t, &bed[beds++]);
        }
    }
    return beds;
}

static size_t count_levels(const size_t beds, const struct bed bed[], const bool of_strength)
{
    double level[BASES_MAX];
    size_t levels = 0;
    for (size_t b = 0; b < beds; b++) {
        const double at = of_strength ? bed[b].strength : bed[b].u;
        bool new        = true;
        for (size_t i = 0; i < levels; i++) {
            new = new &&fabs(level[i] - at) > 1e-6;
        }
        if (new &&levels < BASES_MAX) {
            level[levels++] = at;
        }
    }
    return levels;
}

static void choose_terms(const size_t beds, const struct bed bed[],
                         struct dig_soil_template *const template)
{
    static const unsigned power[DIG_SOIL_TERMS][2] = {
        { 1, 0 }, { 1, 1 }, { 1, 2 }, { 2, 0 }, { 2, 1 }
    };
    const size_t strengths  = count_levels(beds, bed, true);
    const size_t magnitudes = count_levels(beds, bed, false);
    template->terms         = 0;
    for (size_t i = 0; i < DIG_SOIL_TERMS; i++) {
        if (power[i][0] <= magnitudes && power[i][1] < strengths && template->terms < beds) {
            memcpy(template->power[template->terms++], power[i], sizeof power[i]);
        }
    }
    double least = bed[0].strength;
    double most  = bed[0].strength;
    for (size_t b = 1; b < beds; b++) {
        least = fmin(least, bed[b].strength);
        most  = fmax(most, bed[b].strength);
    }
    template->centre = 0.5 * (least + most);
    template->half   = fmax(0.5 * (most - least), 1e-3);
}

static double power_of(const double x, const unsigned power)
{
    double product = 1.0;
    for (unsigned p = 0; p < power; p++) {
        product *= x;
    }
    return product;
}

static void terms_at(const struct dig_soil_template *const template, const double u,
                     const double strength, double term[DIG_SOIL_TERMS])
{
    const double s =
        fmin(fmax((strength - template->centre) / template->half, -most_strength), most_strength);
    for (size_t j = 0; j < template->terms; j++) {
        term[j] = power_of(u, template->power[j][0]) * power_of(s, template->power[j][1]);
    }
}

static enum dig_status invert(const size_t beds, const struct bed bed[],
                              struct dig_soil_template *const template)
{
    const size_t n                                       = template->terms;
    double       normal[DIG_SOIL_TERMS * DIG_SOIL_TERMS] = { 0.0 };
    for (size_t b = 0; b < beds; b++) {
        double term[DIG_SOIL_TERMS];
        terms_at(template, bed[b].u, bed[b].strength, term);
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                normal[i * n + j] += bed[b].weight * term[i] * term[j];
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        normal[i * n + i] *= 1.0 + ridge;
    }
    const enum dig_status status = dig_cholesky(n, normal);
    for (size_t j = 0; j < n && status == DIG_OK; j++) {
        double column[DIG_SOIL_TERMS] = { 0.0 };
        column[j]                     = 1.0;
        dig_lower_solve(n, normal, column);
        dig_lower_transposed_solve(n, normal, column);
        for (size_t i = 0; i < n; i++) {
            template->inverse[i][j] = column[i];
        }
    }
    return status;
}

static void fit(const size_t beds, const struct bed bed[], struct dig_soil_template *const template)
{
    if (invert(beds, bed, template) != DIG_OK) {
        return;
    }
    for (size_t b = 0; b < beds; b++) {
        double term[DIG_SOIL_TERMS];
        terms_at(template, bed[b].u, bed[b].strength, term);
        for (size_t j = 0; j < template->terms; j++) {
            double share = 0.0;
            for (size_t i = 0; i < template->terms; i++) {
                share += bed[b].weight * template->inverse[j][i] * term[i];
            }
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                    template->curve[j][c][k] +=
                        share *((double)bed[b].curve->mean[c][k] - bed[b].plain[c][k]) /
                        bed[b].amplitude[c];
                }
            }
        }
    }
    for (size_t j = 0; j < template->terms; j++) {
        dig_features_of((const double(*)[DIG_CURVE_POINTS]) template->curve[j],
                        template->feature[j]);
    }
    template->known = true;
}

// The scale and range of an effect's magnitudes. False when the set has none.
static bool set_range(struct dig_soil *const soil, const struct dig_effect_set *const set,
                      const enum dig_effect_id effect)
{
    double least = 0.0;
    double most  = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        if (set->entry[e].effect == effect) {
            least = fmin(least, set->entry[e].magnitude - soil->absent[effect]);
            most  = fmax(most, set->entry[e].magnitude - soil->absent[effect]);
        }
    }
    const double scale = fmax(most, -least);
    if (!(scale > 0.0)) {
        return false;
    }
    soil->scale[effect] = scale;
    soil->low[effect]   = beyond * least / scale;
    soil->high[effect]  = beyond * most / scale;
    return true;
}

static enum dig_status fit_all(struct dig_soil *const soil, const struct dig_effect_set *const set)
{
    struct bed *const bed = calloc(set->entries + 1, sizeof *bed);
    if (bed == NULL) {
        return DIG_ENOMEM;
    }
    for (int e = 0; e < DIG_EFFECTS; e++) {
        const enum dig_effect_id effect = (enum dig_effect_id)e;
        for (size_t t = 0; set_range(soil, set, effect) && t < set->trajectories; t++) {
            const size_t beds =
                soil->surface->known[t] ? gather(soil, set, effect, t, set->entries, bed) : 0;
            if (beds > 0) {
                struct dig_soil_template *const template = &soil->template[e][t];
                template->base_density_kgpm3 = set->entry[0].gravel.value[DIG_AXIS_DENSITY_kgpm3];
                choose_terms(beds, bed, template);
                fit(beds, bed, template);
            }
        }
    }
    free(bed);
    return DIG_OK;
}

static void fill_speeds(struct dig_soil *const soil)
{
    const struct dig_curve_set *const set = soil->surface->set;
    for (size_t t = 0; t < set->trajectories; t++) {
        double speed[DIG_CURVE_POINTS];
        dig_effect_speeds(set, t, speed);
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            size_t from;
            size_t to;
            dig_feature_bin(b, &from, &to);
            for (size_t k = from; k < to; k++) {
                soil->speed[t][k] = log(speed[k]);
                soil->bin_speed[t][b] += soil->speed[t][k] / (double)(to - from);
            }
        }
    }
}

enum dig_status dig_soil_create(const struct dig_surface *const    surface,
                                const struct dig_effect_set *const effects,
                                struct dig_soil **const            soil)
{
    assert(surface != NULL && soil != NULL);
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
    }
    made->scale[DIG_EFFECT_RATE_DEPENDENCE] = 1.0;
    made->low[DIG_EFFECT_RATE_DEPENDENCE]   = -most_rate;
    made->high[DIG_EFFECT_RATE_DEPENDENCE]  = most_rate;
    made->scale[DIG_EFFECT_WEAR]            = 1.0;
    made->low[DIG_EFFECT_WEAR]              = -most_wear;
    made->high[DIG_EFFECT_WEAR]             = most_wear;
    if (effects != NULL && fit_all(made, effects) != DIG_OK) {
        free(made);
        return DIG_ENOMEM;
    }
    *soil = made;
    return DIG_OK;
}

bool dig_soil_knows(const struct dig_soil *const soil, const enum dig_effect_id effect,
                    const size_t trajectory)
{
    return has_factor(effect) || soil->template[effect][trajectory].known;
}

double dig_soil_share(const enum dig_effect_id effect, const struct dig_measured *const dig)
{
    if (effect == DIG_EFFECT_RATE_DEPENDENCE) {
        return log(dig->pace);
    }
    if (effect == DIG_EFFECT_WEAR) {
        return (double)dig->order;
    }
    return effect == DIG_EFFECT_COMPACTION ? (double)dig->pass - 1.0 : 1.0;
}

// What a reduced form adds, as a share of the plain dig, where the tooth has this speed (its log).
static double factor_of(const struct dig_soil *const soil, const enum dig_effect_id effect,
                        const double u, const double share, const double speed)
{
    return effect == DIG_EFFECT_RATE_DEPENDENCE ? expm1(u * (share + soil->along * speed))
                                                : u * share;
}

// The terms of a template at a place, u scaled to the gravel's density.
static void terms_of(const struct dig_soil *const soil, const enum dig_effect_id effect,
                     const size_t t, const double place[DIG_AXES], const double u,
                     const double amplitude[DIG_FORCE_CHANNELS], double term[DIG_SOIL_TERMS])
{
    const struct dig_soil_template *const template = &soil->template[effect][t];
    double scaled                                  = u;
    if (acts_by_weight(effect)) {
        const struct dig_gravel gravel = dig_surface_gravel(soil->surface, place);
        scaled *= template->base_density_kgpm3 / gravel.value[DIG_AXIS_DENSITY_kgpm3];
    }
    terms_at(template, scaled, strength_at(soil->surface, t, place, amplitude), term);
}

void dig_soil_add(const struct dig_soil *const soil, const enum dig_effect_id effect,
                  const size_t trajectory, const double place[DIG_AXES], const double u,
                  const double share, const double plain[DIG_FEATURES],
                  const double amplitude[DIG_FORCE_CHANNELS], double feature[DIG_FEATURES],
                  double *const noise)
{
    if (has_factor(effect)) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const double factor = factor_of(soil, effect, u, share, soil->bin_speed[trajectory][b]);
            for (size_t f = b; f < DIG_FEATURES; f += DIG_FEATURE_BINS) {
                feature[f] += factor * plain[f];
            }
        }
        return;
    }
    const struct dig_soil_template *const template = &soil->template[effect][trajectory];
    double term[DIG_SOIL_TERMS];
    terms_of(soil, effect, trajectory, place, u * share, amplitude, term);
    for (size_t i = 0; i < template->terms; i++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += term[i] * template->feature[i][f] * amplitude[f / DIG_FEATURE_BINS];
        }
        for (size_t j = 0; j < template->terms; j++) {
            *noise += term[i] * template->inverse[i][j] * term[j];
        }
    }
}

void dig_soil_add_curve(const struct dig_soil *const soil, const enum dig_effect_id effect,
                        const size_t trajectory, const double place[DIG_AXES], const double u,
                        const double share,
                        const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    double term[DIG_SOIL_TERMS] = { 0.0 };
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    dig_surface_features(soil->surface, trajectory, place, feature, amplitude);
    const struct dig_soil_template *const template = &soil->template[effect][trajectory];
    if (!has_factor(effect)) {
        terms_of(soil, effect, trajectory, place, u * share, amplitude, term);
    }
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            double sum =
                has_factor(effect)
                    ? factor_of(soil, effect, u, share, soil->speed[trajectory][k]) * plain[c][k]
                    : 0.0;
            for (size_t i = 0; !has_factor(effect) && i < template->terms; i++) {
                sum += term[i] * template->curve[i][c][k] * amplitude[c];
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
