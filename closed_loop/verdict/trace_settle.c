// What free air leaves open of an effect of the machine the digs may settle: the gain of a pressure
// sensor that reads little in free air, say, and much in a dig.
//
//   y(dig) = plain(gravel) + sum over k of z[k] D[k](dig),    z ~ N(0, 1), D: of dig_machine_doubt
//
// Gravel and z are fitted to the digs' means, weighed as hypothesis.h does, by Gauss-Newton. It is
// done only where the digs are not like the table's with free air's values, and kept only where
// they are with these: it explains nothing that could have another name.

#include "closed_loop/accuracy/effect_size.h"
#include "closed_loop/numeric/dense.h"
#include "closed_loop/recordings/features.h"
#include "closed_loop/search/search_work.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = DIG_MODEL_PARAMETERS_MAX, UNKNOWNS = STEPS + DIG_AXES, ROUNDS = 3 };

// A step of the gravel's place for slopes, of -1 … 1.
static const double place_step = 0.02;

static const double ninety = 1.645;

// What a step adds to the means of the groups, and what the doubt's middle adds to them beyond what
// was taken off, in the batch's units.
struct slopes {
    double of[STEPS][DIG_TRAJECTORY_MAX][DIG_FEATURES];
    double middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
};

static struct dig_model_effect effect_at(const struct dig_model_effect *const  effect,
                                         const struct dig_machine_doubt *const doubt,
                                         const double                          z[])
{
    struct dig_model_effect made = *effect;
    for (size_t p = 0; p < made.parameters; p++) {
        made.parameter[p].value = doubt->value[p];
        for (size_t k = 0; k < doubt->steps; k++) {
            made.parameter[p].value += z[k] * doubt->step[k][p];
        }
    }
    return made;
}

// The means over the groups' digs of what the machine adds, whitened.
static void mean_added(const struct dig_whitened_digs *const batch,
                       const struct dig_measured measured[], double y[][DIG_FEATURES])
{
    memset(y, 0, batch->groups * sizeof y[0]);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_whitened_digs_group *const group = &batch->group[batch->dig[i].group];
        double                                      feature[DIG_FEATURES];
        double                                      one[DIG_FEATURES];
        dig_features_of(measured[batch->dig[i].measured].machine, feature);
        dig_whitened_digs_whiten(group, feature, one);
        for (size_t f = 0; f < group->features; f++) {
            y[batch->dig[i].group][f] += one[f] / (double)group->digs;
        }
    }
}

// What the machine adds to the means with the effect at z; *told: whether every dig is told there.
static enum dig_status
added_at(struct dig_machine_side *const machine, const struct dig_whitened_digs *const batch,
         const struct dig_model_effect *const effect, const struct dig_machine_doubt *const doubt,
         const double z[], struct dig_measured other[], bool *const told, double y[][DIG_FEATURES])
{
    const struct dig_model_effect there  = effect_at(effect, doubt, z);
    const enum dig_status         status = dig_machine_side_apply(machine, 1, &there, other);
    *told                                = status == DIG_OK;
    if (status == DIG_OK) {
        mean_added(batch, other, y);
    }
    return status == DIG_ENOMATCH || status == DIG_EINVAL ? DIG_OK : status;
}

// A step at which a dig is not told is a way that stays shut; told: false where the middle is not.
static enum dig_status find_slopes(struct dig_machine_side *const        machine,
                                   const struct dig_whitened_digs *const batch,
                                   const struct dig_model_effect *const  effect,
                                   const struct dig_machine_doubt *const doubt, const size_t digs,
                                   const struct dig_measured measured[],
                                   struct slopes *const slopes, bool *const told)
{
    double                     here[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    const double               middle[STEPS] = { 0.0 };
    struct dig_measured *const other         = malloc(digs * sizeof *other);
    if (other == NULL) {
        return DIG_ENOMEM;
    }
    memset(slopes, 0, sizeof *slopes);
    memcpy(other, measured, digs * sizeof *other);
    mean_added(batch, measured, here);
    enum dig_status status =
        added_at(machine, batch, effect, doubt, middle, other, told, slopes->middle);
    for (size_t k = 0; k < doubt->steps && status == DIG_OK && *told; k++) {
        double z[STEPS] = { 0.0 };
        bool   known    = false;
        z[k]            = 1.0;
        status          = added_at(machine, batch, effect, doubt, z, other, &known, slopes->of[k]);
        for (size_t g = 0; g < batch->groups && known; g++) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                slopes->of[k][g][f] -= slopes->middle[g][f];
            }
        }
    }
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            slopes->middle[g][f] -= here[g][f];
        }
    }
    free(other);
    return status;
}

static void plain_model(const struct dig_trace_work *const w, const size_t g, const double place[],
                        double y[DIG_FEATURES])
{
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    dig_response_surface_features(w->surface, w->batch->group[g].trajectory, place, feature,
                                  amplitude);
    dig_whitened_digs_whiten(&w->batch->group[g], feature, y);
}

// Adds one group's means to the normal equations: A x = b of the changes of z and the place.
static void add_group(const struct dig_trace_work *const w, const struct dig_fitted *const plain,
                      const struct slopes *const slopes, const size_t steps, const size_t g,
                      const double z[], const double place[], double a[UNKNOWNS][UNKNOWNS],
                      double b[UNKNOWNS])
{
    const struct dig_whitened_digs_group *const group = &w->batch->group[g];
    const double weight = 1.0 / (1.0 / (double)group->digs + plain->noise[g]);
    double       rest[DIG_FEATURES];
    double       slope[UNKNOWNS][DIG_FEATURES];
    plain_model(w, g, place, rest);
    for (size_t p = 0; p < DIG_AXES; p++) {
        double there[DIG_AXES];
        memcpy(there, place, sizeof there);
        there[p] += place_step;
        plain_model(w, g, there, slope[steps + p]);
        for (size_t f = 0; f < group->features; f++) {
            slope[steps + p][f] = (slope[steps + p][f] - rest[f]) / place_step;
        }
    }
    for (size_t f = 0; f < group->features; f++) {
        rest[f] = group->mean[f] - slopes->middle[g][f] - rest[f];
        for (size_t k = 0; k < steps; k++) {
            rest[f] -= z[k] * slopes->of[k][g][f];
            slope[k][f] = slopes->of[k][g][f];
        }
    }
    for (size_t f = 0; f < group->features; f++) {
        for (size_t i = 0; i < steps + DIG_AXES; i++) {
            b[i] += weight * slope[i][f] * rest[f];
            for (size_t j = 0; j <= i; j++) {
                a[i][j] += weight * slope[i][f] * slope[j][f];
            }
        }
    }
}

// z that free air and the digs ask for, and the diagonal of what is left of its variance.
static bool fit(const struct dig_trace_work *const w, const struct dig_fitted *const plain,
                const struct slopes *const slopes, const size_t steps, double z[STEPS],
                double covariance[STEPS][STEPS])
{
    const size_t n = steps + DIG_AXES;
    double       place[DIG_AXES];
    double       lower[UNKNOWNS * UNKNOWNS];
    memcpy(place, plain->number, sizeof place);
    memset(z, 0, STEPS * sizeof z[0]);
    for (int round = 0; round < ROUNDS; round++) {
        double a[UNKNOWNS][UNKNOWNS] = { { 0.0 } };
        double b[UNKNOWNS]           = { 0.0 };
        for (size_t g = 0; g < w->batch->groups; g++) {
            add_group(w, plain, slopes, steps, g, z, place, a, b);
        }
        for (size_t i = 0; i < n; i++) {
            // Of the gravel's place no more is known than that the table holds it.
            a[i][i] += 1.0;
            b[i] -= i < steps ? z[i] : place[i - steps];
            for (size_t j = 0; j <= i; j++) {
                lower[i * n + j] = a[i][j];
            }
        }
        if (dig_cholesky(n, lower) != DIG_OK) {
            return false;
        }
        dig_lower_solve(n, lower, b);
        dig_lower_transposed_solve(n, lower, b);
        for (size_t i = 0; i < n; i++) {
            *(i < steps ? &z[i] : &place[i - steps]) += b[i];
        }
    }
    for (size_t i = 0; i < steps; i++) {
        double one[UNKNOWNS] = { 0.0 };
        one[i]               = 1.0;
        dig_lower_solve(n, lower, one);
        dig_lower_transposed_solve(n, lower, one);
        memcpy(covariance[i], one, steps * sizeof one[0]);
    }
    return true;
}

static void write_intervals(const struct dig_machine_doubt *const doubt,
                            const double                          covariance[STEPS][STEPS],
                            struct dig_model_effect *const        effect)
{
    for (size_t p = 0; p < effect->parameters; p++) {
        double variance = 0.0;
        for (size_t i = 0; i < doubt->steps; i++) {
            for (size_t j = 0; j < doubt->steps; j++) {
                variance += doubt->step[i][p] * covariance[i][j] * doubt->step[j][p];
            }
        }
        const double wide         = ninety * sqrt(fmax(variance, 0.0));
        effect->parameter[p].low  = effect->parameter[p].value - wide;
        effect->parameter[p].high = effect->parameter[p].value + wide;
    }
}

// The effect as free air and the digs have it.
static enum dig_status settle(struct dig_machine_side *const machine, const size_t digs,
                              const struct dig_measured             measured[],
                              const struct dig_trace_work *const    w,
                              const struct dig_machine_doubt *const doubt,
                              struct dig_model_effect *const effect, bool *const possible)
{
    struct slopes *const slopes = malloc(sizeof *slopes);
    if (slopes == NULL) {
        return DIG_ENOMEM;
    }
    double                z[STEPS];
    double                covariance[STEPS][STEPS];
    bool                  told = false;
    const enum dig_status status =
        find_slopes(machine, w->batch, effect, doubt, digs, measured, slopes, &told);
    *possible =
        status == DIG_OK && told && fit(w, &w->search->plain, slopes, doubt->steps, z, covariance);
    if (*possible) {
        *effect = effect_at(effect, doubt, z);
        write_intervals(doubt, (const double(*)[STEPS])covariance, effect);
    }
    free(slopes);
    return status;
}

static const struct dig_machine_doubt *doubt_of(const struct dig_machine_finding *const air)
{
    const struct dig_machine_doubt *doubt = NULL;
    for (size_t c = 0; c < air->candidates; c++) {
        if (air->candidate[c].effect == air->effect[0].effect) {
            doubt = &air->doubt[c];
        }
    }
    return doubt;
}

static enum dig_status try(struct dig_machine_side *const         machine,
                           const struct dig_trace_settings *const settings, const size_t digs,
                           struct dig_measured measured[], struct dig_trace_work *const w,
                           bool *const settled, struct dig_error *const error)
{
    struct dig_machine_finding *const     air      = w->air;
    const struct dig_machine_doubt *const doubt    = doubt_of(air);
    struct dig_model_effect               effect   = air->effect[0];
    bool                                  possible = false;
    struct dig_fitted                     plain;
    enum dig_status                       status = DIG_OK;
    if (doubt == NULL || doubt->steps != effect.parameters) {
        return DIG_OK;
    }
    status = settle(machine, digs, measured, w, doubt, &effect, &possible);
    if (status != DIG_OK || !possible) {
        return status;
    }
    status = dig_machine_side_apply(machine, 1, &effect, measured);
    if (status == DIG_ENOMATCH || status == DIG_EINVAL) {
        return DIG_OK;
    }
    if (status == DIG_OK) {
        status = dig_trace_batch(w, digs, measured, &plain, error);
    }
    if (status == DIG_OK) {
        status = dig_search_whether(w->batch, w->soil, settings->false_alarm / 2.0,
                                    settings->bootstraps, settings->seed, w->search);
    }
    if (status == DIG_OK && !w->search->significant) {
        *settled = true;
        effect.probability /= fmax(dig_effect_size_chance(w->size[0]), DIG_TRACE_UNCONFIRMED);
        air->effect[0] = effect;
        status         = dig_trace_weigh_air(machine, digs, measured, w, &w->search->plain);
    }
    return status;
}

enum dig_status dig_trace_settle_air(struct dig_machine_side *const         machine,
                                     const struct dig_trace_settings *const settings,
                                     const size_t digs, struct dig_measured measured[],
                                     struct dig_trace_work *const w, bool *const settled,
                                     struct dig_error *const error)
{
    assert(machine != NULL && settings != NULL && measured != NULL && w != NULL && settled != NULL);
    struct dig_whitened_digs *const batch  = malloc(sizeof *batch);
    struct dig_search *const        search = malloc(sizeof *search);
    enum dig_status                 status = DIG_ENOMEM;
    *settled                               = false;
    if (batch != NULL && search != NULL) {
        *batch  = *w->batch;
        *search = *w->search;
        status  = try(machine, settings, digs, measured, w, settled, error);
    }
    if (status == DIG_OK && !*settled) {
        *w->batch  = *batch;
        *w->search = *search;
        status     = dig_machine_side_apply(machine, w->air->effects, w->air->effect, measured);
    }
    free(batch);
    free(search);
    return status;
}
