#include "closed_loop/search/null_simulation.h"

#include "closed_loop/numeric/dense.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { AT_A_TIME = 25 }; // draws after which is asked whether more would change the answer

double dig_null_simulation_left(const struct dig_batch *const  batch,
                                const struct dig_fitted *const fitted)
{
    const double squares = dig_hypothesis_differs(&fitted->hypothesis)
                               ? fitted->means
                               : fitted->squares - dig_batch_about(batch);
    return dig_batch_misfit_of_means(batch, squares);
}

// Fits base with one effect more. What an effect adds need not grow evenly with it, so that a fit
// may end near none: several magnitudes are started from.
static void fit_rival(const struct dig_batch *const batch, const struct dig_hypothesis *const base,
                      const struct dig_hypothesis *const rival, const struct dig_fitted *const from,
                      const enum dig_fit_care care, struct dig_fitted *const fitted)
{
    static const double starts[] = { 0.3, 0.6, -0.5 };
    const size_t        last     = DIG_AT_U(rival->effects - 1);
    const size_t      added = rival->effects > base->effects ? sizeof starts / sizeof starts[0] : 1;
    struct dig_fitted best  = { .misfit = INFINITY };
    for (size_t s = 0; s < added; s++) {
        double                   at[DIG_HYPOTHESIS_NUMBERS];
        struct dig_fitted        tried;
        const enum dig_effect_id effect = rival->effect[rival->effects - 1];
        memcpy(at, from->number, sizeof at);
        if (rival->effects > base->effects) {
            at[last + 1] = 1.0;
            at[last]     = starts[s] *
                       (starts[s] > 0.0 ? batch->soil->high[effect] : -batch->soil->low[effect]);
        }
        if (s > 0 && fabs(at[last]) <= 0.0) {
            continue;
        }
        dig_hypothesis_fit(batch, rival, at, care, &tried);
        if (tried.misfit < best.misfit) {
            best = tried;
        }
    }
    *fitted = best;
}

void dig_null_simulation_fit(const struct dig_batch *const      batch,
                             const struct dig_hypothesis *const base, const size_t rivals,
                             const struct dig_hypothesis rival[], const double start[],
                             const enum dig_fit_care care, struct dig_fitted fitted[],
                             struct dig_statistic *const statistic)
{
    assert(rivals <= DIG_RIVALS_MAX);
    dig_hypothesis_fit(batch, base, start, care, &fitted[0]);
    statistic->about  = dig_batch_about(batch);
    statistic->misfit = dig_null_simulation_left(batch, &fitted[0]);
    statistic->gain   = 0.0;
    statistic->best   = rivals;
    for (size_t i = 0; i < rivals; i++) {
        fit_rival(batch, base, &rival[i], &fitted[0], care, &fitted[1 + i]);
        const double gain = fitted[0].misfit - fitted[1 + i].misfit;
        if (gain > statistic->gain) {
            statistic->gain = gain;
            statistic->best = i;
        }
    }
}

// In how many directions digs of a group scatter independently (Satterthwaite: of what the trace
// is known from).
static double directions(const struct dig_batch *const batch, const size_t g)
{
    const struct dig_group *const group = &batch->group[g];
    const double(*const s)[DIG_FEATURES] =
        (const double(*)[DIG_FEATURES])batch->scatter->covariance[group->trajectory];
    double trace   = 0.0;
    double squares = 0.0;
    for (size_t i = 0; i < group->features; i++) {
        trace += s[group->feature[i]][group->feature[i]];
        for (size_t j = 0; j < group->features; j++) {
            squares += pow(s[group->feature[i]][group->feature[j]], 2.0);
        }
    }
    return trace * trace / squares;
}

// The size of a group's true scatter over what the table makes of its few packings: the root of
// n / chi-squared of n, by Wilson and Hilferty.
static double draw_size(const struct dig_batch *const batch, const size_t g, uint64_t *const seed)
{
    static const double least   = 0.05;
    const double        freedom = batch->scatter->freedom[batch->group[g].trajectory];
    if (!(freedom > 0.0)) {
        return 1.0;
    }
    const double part = 2.0 / (9.0 * freedom * directions(batch, g));
    return pow(fmax(1.0 - part + sqrt(part) * dig_chance_normal(seed), least), -1.5);
}

// Adds what lasts of the sensors' noise, if any does.
static void add_lasting(const struct dig_group *const group, uint64_t *const seed,
                        double feature[DIG_FEATURES])
{
    double lower[DIG_FEATURE_BINS * DIG_FEATURE_BINS];
    memcpy(lower, group->lasting, sizeof lower);
    if (dig_cholesky(DIG_FEATURE_BINS, lower) != DIG_OK) {
        return;
    }
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        const size_t j = f % DIG_FEATURE_BINS;
        const double z = group->lasting_sigma[f / DIG_FEATURE_BINS] * dig_chance_normal(seed);
        for (size_t i = j; i < DIG_FEATURE_BINS; i++) {
            feature[f + i - j] += lower[i * DIG_FEATURE_BINS + j] * z;
        }
    }
}

// One dig's scatter, whitened: a residual of the table and the sensors', or normal numbers.
static void draw_scatter(const struct dig_batch *const batch, const size_t g, uint64_t *const seed,
                         double y[DIG_FEATURES])
{
    const struct dig_group *const group = &batch->group[g];
    const size_t                  n     = batch->scatter->residuals[group->trajectory];
    if (n == 0) {
        for (size_t k = 0; k < group->features; k++) {
            y[k] = dig_chance_normal(seed);
        }
        return;
    }
    // In the group's units a residual of the table is one of its amplitude.
    const double *const residual =
        batch->scatter->residual[group->trajectory][dig_chance_index(seed, n)];
    const double sign       = dig_chance_uniform(seed) < 0.5 ? -1.0 : 1.0;
    uint64_t     of_sensors = ~*seed; // numbers of their own: the table's are drawn as without
    double       feature[DIG_FEATURES];
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        feature[f] = sign * residual[f] * group->amplitude[f / DIG_FEATURE_BINS] +
                     group->sensor[f] * dig_chance_normal(&of_sensors);
    }
    add_lasting(group, &of_sensors, feature);
    dig_batch_whiten(group, feature, y);
}

void dig_null_simulation_digs(const struct dig_batch *const  batch,
                              const struct dig_fitted *const fitted,
                              const struct dig_common_error error[], uint64_t *const seed,
                              struct dig_batch *const drawn)
{
    assert(batch != NULL && fitted != NULL && error != NULL && seed != NULL && drawn != NULL);
    double common[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    double size[DIG_TRAJECTORY_MAX];
    double z[DIG_STEPS_MAX] = { 0.0 };
    for (size_t k = 0; batch->steps != NULL && k < batch->steps->steps; k++) {
        z[k] = batch->steps->middle[k] + dig_chance_normal(seed);
    }
    for (size_t g = 0; g < batch->groups; g++) {
        double smooth[DIG_FEATURES];
        size[g] = draw_size(batch, g, seed);
        draw_scatter(batch, g, seed, common[g]);
        dig_common_error_draw(&batch->group[g], &error[g], seed, smooth);
        for (size_t k = 0; k < batch->group[g].features; k++) {
            common[g][k] = common[g][k] * size[g] * sqrt(error[g].even) + smooth[k];
        }
        dig_steps_add(batch, z, g, common[g]);
    }
    for (size_t i = 0; i < batch->digs; i++) {
        const size_t g = batch->dig[i].group;
        double       model[DIG_FEATURES];
        double       own[DIG_FEATURES];
        dig_fitted_whitened(batch, fitted, g, &batch->measured[batch->dig[i].measured], model);
        draw_scatter(batch, g, seed, own);
        for (size_t k = 0; k < batch->group[g].features; k++) {
            drawn->dig[i].y[k] = model[k] + common[g][k] + size[g] * own[k];
        }
    }
    dig_batch_summarise(drawn);
}

// True when more draws would not change the answer: the fewer they are, the farther from the level
// must the chance be.
static bool is_answered(const struct dig_null_question *const   asked,
                        const struct dig_null_simulation *const null)
{
    if (asked == NULL || null->draws % AT_A_TIME != 0 || null->draws == 0) {
        return false;
    }
    const double far = 1000.0 / (double)null->draws;
    const double p   = dig_null_simulation_p(null, 2, asked->gain);
    return p > far * asked->level || p < asked->level / (far * far);
}

struct dig_null_simulation
dig_null_simulation_draw(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                         const size_t rivals, const struct dig_hypothesis rival[],
                         const size_t draws, const struct dig_null_question *const asked,
                         uint64_t *const seed)
{
    assert(draws > 1 && rivals <= DIG_RIVALS_MAX);
    struct dig_batch           drawn = *batch;
    struct dig_fitted          again[DIG_RIVALS_MAX + 1];
    struct dig_null_simulation made       = { .draws = 0 };
    double                     squares[3] = { 0.0 };
    struct dig_common_error    error[DIG_TRAJECTORY_MAX];
    dig_hypothesis_errors(batch, fitted, error);
    while (made.draws < draws && !is_answered(asked, &made)) {
        struct dig_statistic s;
        dig_null_simulation_digs(batch, fitted, error, seed, &drawn);
        dig_null_simulation_fit(&drawn, &fitted->hypothesis, rivals, rival, fitted->number,
                                DIG_FIT_BARE, again, &s);
        const double value[3] = { s.misfit, s.about, s.gain };
        made.draws++;
        for (size_t i = 0; i < 3; i++) {
            const double off = value[i] - made.mean[i];
            made.mean[i] += off / (double)made.draws;
            squares[i] += off * (value[i] - made.mean[i]);
            made.variance[i] = squares[i] / fmax((double)made.draws - 1.0, 1.0);
        }
    }
    return made;
}

double dig_null_simulation_p(const struct dig_null_simulation *const null, const size_t index,
                             const double value)
{
    assert(index < 3);
    if (!(null->mean[index] > 0.0) || !(null->variance[index] > 0.0)) {
        return 1.0;
    }
    return dig_chance_gamma_tail(null->mean[index], null->variance[index], value);
}
