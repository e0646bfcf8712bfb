#include "closed_loop/model/soil_fit.h"

#include "closed_loop/numeric/dense.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 200 };

static const double ridge = 1e-6; // of the diagonal, where magnitudes make terms nearly the same

// Beyond the table's largest magnitude.
static const double beyond = 1.5;

// Widest and narrowest prior of a term, in variances of what one dig scatters by.
static const double widest    = 1e6;
static const double narrowest = 1e-6;

// Of a term's square, so that one the beds say nothing about has a width at all.
static const double least_told = 1e-6;

double dig_soil_strength(const struct dig_response_surface *const surface,
                         const double place[DIG_AXES], const double amplitude[DIG_FORCE_CHANNELS])
{
    const struct dig_gravel gravel = dig_response_surface_gravel(surface, place);
    return log(amplitude[DIG_CHANNEL_MY_Nm] / gravel.value[DIG_AXIS_DENSITY_kgpm3]);
}

// Of the one template of an effect whose sides are alike the other side is not looked at.
static size_t side_of(const enum dig_effect_id effect, const double u)
{
    return u < 0.0 && dig_effect_of(effect) != NULL && dig_effect_of(effect)->unlike_sides ? 1 : 0;
}

const struct dig_soil_template *dig_soil_template_at(const struct dig_soil *const soil,
                                                     const enum dig_effect_id     effect,
                                                     const size_t trajectory, const double u)
{
    return &soil->template[effect][side_of(effect, u)][trajectory];
}

// One bed of an effect along one trajectory, relative to the plain dig of its gravel.
struct bed {
    double                  weight;
    double                  term[DIG_SOIL_TERMS]; // of the template
    double                  amplitude[DIG_FORCE_CHANNELS];
    const struct dig_curve *curve;
    double                  plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double                  feature[DIG_FEATURES]; // of what the effect adds, over the amplitude
};

static void describe_bed(const struct dig_soil *const soil, const struct dig_entry_set *const set,
                         const struct dig_scatter *const scatter, const size_t entry,
                         const size_t t, struct dig_soil_at *const at, struct bed *const bed)
{
    const struct dig_entry *const of = &set->entry[entry];
    double                        place[DIG_AXES];
    double                        plain[DIG_FEATURES];
    dig_response_surface_place(soil->surface, &of->gravel, place);
    dig_response_surface_features(soil->surface, t, place, plain, bed->amplitude);
    dig_response_surface_curve(soil->surface, t, place, bed->plain);
    bed->curve   = &set->curve[entry * set->trajectories + t];
    at->u        = (of->magnitude - soil->absent[of->effect]) / soil->scale[of->effect];
    at->strength = dig_soil_strength(soil->surface, place, bed->amplitude);

    // A dig that is larger with the effect scatters more, and so does one of a strong gravel.
    double size[DIG_FORCE_CHANNELS];
    dig_features_of_table(bed->curve->mean, bed->feature);
    dig_features_amplitude(bed->feature, NULL, size);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        bed->feature[f] = (bed->feature[f] - plain[f]) / bed->amplitude[f / DIG_FEATURE_BINS];
    }
    bed->weight = (double)set->packings[entry * set->trajectories + t] /
                  (dig_scatter_factor(scatter, t, at->strength) *
                   pow(size[DIG_CHANNEL_MY_Nm] / bed->amplitude[DIG_CHANNEL_MY_Nm], 2.0));
}

static size_t gather(const struct dig_soil *const soil, const struct dig_entry_set *const set,
                     const struct dig_scatter *const scatter, const enum dig_effect_id effect,
                     const size_t side, const size_t t, struct dig_soil_at at[], struct bed bed[])
{
    size_t beds = 0;
    for (size_t e = 0; e < set->entries; e++) {
        const struct dig_entry *const of = &set->entry[e];
        if (of->effect == effect && set->packings[e * set->trajectories + t] > 0 &&
            side_of(effect, of->magnitude - soil->absent[effect]) == side) {
            describe_bed(soil, set, scatter, e, t, &at[beds], &bed[beds]);
            beds++;
        }
    }
    return beds;
}

// (sum w x x' + the priors' precision)^-1 over the terms.
static enum dig_status invert(const size_t beds, const struct bed bed[],
                              const double precision[DIG_SOIL_TERMS],
                              struct dig_soil_template *const template)
{
    const size_t n                                       = template->terms;
    double       normal[DIG_SOIL_TERMS * DIG_SOIL_TERMS] = { 0.0 };
    for (size_t b = 0; b < beds; b++) {
        const double *const term = bed[b].term;
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                normal[i * n + j] += bed[b].weight * term[i] * term[j];
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        normal[i * n + i] += ridge * normal[i * n + i] + precision[i];
    }
    const enum dig_status status = dig_cholesky(n, normal);
    for (size_t j = 0; j < n && status == DIG_OK; j++) {
        double column[DIG_SOIL_TERMS] = { 0.0 };
        column[j]                     = 1.0;
        dig_cholesky_solve(n, normal, column);
        for (size_t i = 0; i < n; i++) {
            template->inverse[i][j] = column[i];
        }
    }
    return status;
}

// How much of a bed's relative difference goes into each term.
static void shares_of(const struct dig_soil_template *const template, const struct bed *const bed,
                      double share[DIG_SOIL_TERMS])
{
    for (size_t j = 0; j < template->terms; j++) {
        share[j] = 0.0;
        for (size_t i = 0; i < template->terms; i++) {
            share[j] += bed->weight * template->inverse[j][i] * bed->term[i];
        }
    }
}

static void fit_features(const size_t beds, const struct bed bed[],
                         struct dig_soil_template *const template)
{
    memset(template->feature, 0, sizeof template->feature);
    for (size_t b = 0; b < beds; b++) {
        double share[DIG_SOIL_TERMS];
        shares_of(template, &bed[b], share);
        for (size_t j = 0; j < template->terms; j++) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                template->feature[j][f] += share[j] * bed[b].feature[f];
            }
        }
    }
}

// Every term but the first has a prior about nothing, as wide as the beds say: the width that makes
// them likeliest, term by term, by MacKay's fixed point (1992): its square over the share of it
// that the beds tell. A term that few beds ask for by less than their scatter then adds no noise.
static enum dig_status fit_terms(const size_t beds, const struct bed bed[],
                                 const double scatter[DIG_FEATURES][DIG_FEATURES],
                                 struct dig_soil_template *const template)
{
    double          precision[DIG_SOIL_TERMS] = { 0.0 };
    enum dig_status status                    = DIG_OK;
    for (size_t j = 1; j < template->terms; j++) {
        precision[j] = 1.0; // hats that add up to a line are told from it by their priors alone
    }
    for (int round = 0; round <= ROUNDS && status == DIG_OK; round++) {
        status = invert(beds, bed, precision, template);
        if (round < ROUNDS && status == DIG_OK) {
            fit_features(beds, bed, template);
        }
        for (size_t j = 1; j < template->terms && round < ROUNDS && status == DIG_OK; j++) {
            const double told   = 1.0 - template->inverse[j][j] * precision[j];
            double       square = 0.0;
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                square += template->feature[j][f] * template->feature[j][f] / scatter[f][f] /
                          (double)DIG_FEATURES;
            }
            square /= fmax(told, least_told);
            precision[j] = 1.0 / fmin(fmax(square, narrowest), widest);
        }
    }
    return status;
}

static void fit(const size_t beds, const struct bed bed[],
                const double scatter[DIG_FEATURES][DIG_FEATURES],
                struct dig_soil_template *const template)
{
    if (fit_terms(beds, bed, scatter, template) != DIG_OK) {
        return;
    }
    for (size_t b = 0; b < beds; b++) {
        double share[DIG_SOIL_TERMS];
        shares_of(template, &bed[b], share);
        for (size_t j = 0; j < template->terms; j++) {
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                    template->curve[j][c][k] +=
                        share[j] * ((double)bed[b].curve->mean[c][k] - bed[b].plain[c][k]) /
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
static bool set_range(struct dig_soil *const soil, const struct dig_entry_set *const set,
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
    // A bucket has no less than no friction.
    const struct dig_effect_parameter *const bound = &dig_effect_of(effect)->parameter[0];
    soil->scale[effect]                            = scale;
    soil->low[effect]  = fmax(beyond * least, bound->low - soil->absent[effect]) / scale;
    soil->high[effect] = fmin(beyond * most, bound->high - soil->absent[effect]) / scale;
    return true;
}

enum dig_status dig_soil_fit(struct dig_soil *const soil, const struct dig_entry_set *const set,
                             const struct dig_scatter *const scatter)
{
    assert(soil != NULL && set != NULL && scatter != NULL);
    struct bed *const         bed    = calloc(set->entries + 1, sizeof *bed);
    struct dig_soil_at *const at     = calloc(set->entries + 1, sizeof *at);
    const enum dig_status     status = bed != NULL && at != NULL ? DIG_OK : DIG_ENOMEM;
    for (int e = 0; e < DIG_EFFECTS && status == DIG_OK; e++) {
        const enum dig_effect_id effect = (enum dig_effect_id)e;
        const bool               any    = set_range(soil, set, effect);
        for (size_t i = 0; any && i < set->trajectories * DIG_SOIL_SIDES; i++) {
            const size_t t                           = i / DIG_SOIL_SIDES;
            const size_t side                        = i % DIG_SOIL_SIDES;
            struct dig_soil_template *const template = &soil->template[effect][side][t];
            const size_t beds =
                soil->surface->known[t] ? gather(soil, set, scatter, effect, side, t, at, bed) : 0;
            if (beds == 0) {
                continue;
            }
            template->base_density_kgpm3 = set->entry[0].gravel.value[DIG_AXIS_DENSITY_kgpm3];
            dig_soil_terms_choose(beds, at, template);
            for (size_t b = 0; b < beds; b++) {
                dig_soil_terms(template, &at[b], bed[b].term);
            }
            fit(beds, bed, (const double(*)[DIG_FEATURES])scatter->covariance[t], template);
        }
    }
    free(bed);
    free(at);
    return status;
}
