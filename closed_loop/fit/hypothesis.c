#include "closed_loop/fit/hypothesis.h"

#include "closed_loop/fit/likelihood.h"
#include "closed_loop/numeric/dense.h"
#include "closed_loop/numeric/levenberg.h"
#include "closed_loop/recordings/lateness.h"
#include "estimator/effects/effect.h"

#include <math.h>
#include <string.h>

enum {
    MEMORY = DIG_LIKELIHOOD_RESIDUALS * (DIG_HYPOTHESIS_NUMBERS + 2),
    ROUNDS = 4, // of fitting and of weighing anew, at most
    HALVES = 5, // of the way to where least squares lead
};

static const double enough = 1e-2; // a fall of the misfit that is none

// Places outside the grid, which is -1 to 1.
static const double least_outside = -2.0, most_outside = 1.4;

// Where outside the grid an axis begins: friction is never less than none.
static double least_place(const struct dig_response_surface *const surface, const size_t axis)
{
    double                  place[DIG_AXES];
    const struct dig_gravel none = { { [DIG_AXIS_DENSITY_kgpm3] = 1e-9 } };
    dig_response_surface_place(surface, &none, place);
    return fmax(least_outside, place[axis]);
}

void dig_hypothesis_bounds(const struct dig_soil *const       soil,
                           const struct dig_hypothesis *const hypothesis, double low[],
                           double high[])
{
    for (size_t a = 0; a < DIG_AXES; a++) {
        const bool is_free = soil->surface->set->axis_count[a] > 1;
        low[a]  = is_free ? (hypothesis->outside ? least_place(soil->surface, a) : -1.0) : 0.0;
        high[a] = is_free ? (hypothesis->outside ? most_outside : 1.0) : 0.0;
    }
    for (size_t e = 0; e < hypothesis->effects; e++) {
        const struct dig_effect *const effect  = dig_effect_of(hypothesis->effect[e]);
        const bool                     is_free = effect != NULL && effect->contrasted;
        low[DIG_AT_U(e)]                       = soil->low[hypothesis->effect[e]];
        high[DIG_AT_U(e)]                      = soil->high[hypothesis->effect[e]];
        low[DIG_AT_CONTRAST(e)]                = is_free ? effect->parameter[1].low : 1.0;
        high[DIG_AT_CONTRAST(e)]               = is_free ? effect->parameter[1].high : 1.0;
    }
}

// The misfit at x, each number weighed as x says.
static double misfit_at(struct dig_likelihood *const      likelihood,
                        const struct dig_levenberg *const l, const double x[],
                        struct dig_fitted *const f)
{
    double *const r = l->memory;
    dig_likelihood_weigh(likelihood, x);
    dig_likelihood_residual(likelihood, x, r);
    memcpy(f->number, x, l->unknowns * sizeof f->number[0]);
    f->misfit = dig_likelihood_misfit(likelihood, r, &f->squares);
    f->means  = dig_product(likelihood->means, r, r);
    for (size_t k = 0; k < likelihood->steps; k++) {
        const double off = r[likelihood->residuals - likelihood->steps + k];
        f->z[k]          = likelihood->batch->steps->middle[k] + off;
        f->means += off * off;
    }
    for (size_t g = 0; g < likelihood->batch->groups; g++) {
        f->noise[g] = likelihood->error[g].noise;
    }
    return f->misfit;
}

// Least squares by the covariance at x; on the way to where they lead, the covariance changes: as
// far is gone as makes the misfit less. Where they lead nowhere, nothing is tried.
static bool improve(struct dig_likelihood *const likelihood, struct dig_levenberg *const l,
                    struct dig_fitted *const f)
{
    double            to[DIG_HYPOTHESIS_NUMBERS];
    double            squares = 0.0;
    struct dig_fitted tried   = *f;
    bool              better  = false;
    memcpy(to, f->number, sizeof to);
    dig_likelihood_weigh(likelihood, to);
    dig_levenberg_run(l, to, &squares);
    const double about = likelihood->differs ? 0.0 : dig_batch_about(likelihood->batch);
    const bool   leads = squares + about < f->squares - enough;
    for (int half = 0; half < HALVES && leads && !better; half++) {
        const double way = ldexp(1.0, -half);
        double       x[DIG_HYPOTHESIS_NUMBERS];
        for (size_t j = 0; j < l->unknowns; j++) {
            x[j] = f->number[j] + way * (to[j] - f->number[j]);
        }
        better = misfit_at(likelihood, l, x, &tried) < f->misfit - enough;
    }
    *f = better ? tried : *f;
    return better;
}

static void fit_from(struct dig_likelihood *const likelihood, struct dig_levenberg *const l,
                     const double start[], struct dig_fitted *const f)
{
    double x[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    for (size_t j = 0; j < l->unknowns; j++) {
        x[j] = fmin(fmax(start[j], l->low[j]), l->high[j]);
    }
    (void)misfit_at(likelihood, l, x, f);
    for (int round = 0; round < ROUNDS && improve(likelihood, l, f); round++) {
    }
}

void dig_hypothesis_fit(const struct dig_batch *const      batch,
                        const struct dig_hypothesis *const hypothesis, const double start[],
                        const enum dig_fit_care care, struct dig_fitted *const fitted)
{
    static const double places[][DIG_AXES] = {
        { -0.6, -0.6, 0.0 }, { 0.6, -0.6, 0.0 }, { -0.6, 0.6, 0.0 }, { 0.6, 0.6, 0.0 }
    };
    const size_t          more = care == DIG_FIT_THOROUGH ? sizeof places / sizeof places[0] : 0;
    double                memory[MEMORY];
    struct dig_likelihood likelihood;
    dig_likelihood_init(&likelihood, batch, hypothesis);
    struct dig_levenberg l = { .unknowns   = likelihood.numbers,
                               .residuals  = likelihood.residuals,
                               .step       = 1e-4,
                               .iterations = 25,
                               .residual   = dig_likelihood_residual,
                               .context    = &likelihood,
                               .memory     = memory };
    dig_hypothesis_bounds(batch->soil, hypothesis, l.low, l.high);
    struct dig_fitted best = { .misfit = INFINITY };
    for (size_t s = 0; s <= more; s++) {
        double from[DIG_HYPOTHESIS_NUMBERS];
        memcpy(from, start, l.unknowns * sizeof from[0]);
        if (s > 0) {
            memcpy(from, places[s - 1], sizeof places[0]);
        }
        struct dig_fitted tried = { .hypothesis = *hypothesis };
        fit_from(&likelihood, &l, from, &tried);
        if (tried.misfit < best.misfit) {
            best = tried;
        }
    }
    for (size_t j = 0; j < l.unknowns; j++) {
        best.low[j]  = l.low[j];
        best.high[j] = l.high[j];
    }
    *fitted = best;
}

void dig_hypothesis_fit_unlisted(const struct dig_batch *const  batch,
                                 const struct dig_fitted *const beside,
                                 struct dig_fitted *const       fitted)
{
    static const double sizes[] = { 0.1, 0.2, 0.4, 0.8 };
    const size_t        n       = sizeof sizes / sizeof sizes[0];
    struct dig_fitted   best    = { .misfit = INFINITY };
    for (size_t i = 0; i < n; i++) {
        struct dig_hypothesis unlisted = beside->hypothesis;
        struct dig_fitted     tried;
        unlisted.unlisted = sizes[i];
        dig_hypothesis_fit(batch, &unlisted, beside->number, DIG_FIT_BARE, &tried);
        if (tried.misfit < best.misfit) {
            best = tried;
        }
    }
    best.misfit += 2.0 * log((double)n);
    *fitted = best;
}

void dig_hypothesis_errors(const struct dig_batch *const  batch,
                           const struct dig_fitted *const fitted, struct dig_common_error error[])
{
    struct dig_likelihood likelihood;
    dig_likelihood_init(&likelihood, batch, &fitted->hypothesis);
    dig_likelihood_weigh(&likelihood, fitted->number);
    memcpy(error, likelihood.error, batch->groups * sizeof error[0]);
}

void dig_fitted_features(const struct dig_soil *const soil, const struct dig_fitted *const fitted,
                         const struct dig_measured *const dig, double feature[DIG_FEATURES])
{
    const struct dig_plain plain = dig_plain_of(soil, (size_t)dig->trajectory, fitted->number);
    dig_forward_add(soil, &plain, &fitted->hypothesis, fitted->number, dig, feature, NULL);
}

void dig_fitted_whitened(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                         const size_t group, const struct dig_measured *const dig,
                         double y[DIG_FEATURES])
{
    double feature[DIG_FEATURES];
    dig_fitted_features(batch->soil, fitted, dig, feature);
    dig_batch_whiten(&batch->group[group], feature, y);
}

void dig_fitted_curve(const struct dig_soil *const soil, const struct dig_fitted *const fitted,
                      const struct dig_measured *const dig,
                      double                           curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const size_t        t       = (size_t)dig->trajectory;
    const double *const number  = fitted->number;
    double              delay_s = 0.0;
    double              plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    dig_response_surface_curve(soil->surface, t, number, plain);
    memcpy(curve, plain, sizeof plain);
    for (size_t e = 0; e < fitted->hypothesis.effects; e++) {
        const enum dig_effect_id effect = fitted->hypothesis.effect[e];
        delay_s += effect == DIG_EFFECT_SENSOR_DELAY ? number[DIG_AT_U(e)] : 0.0;
        dig_soil_add_curve(soil, effect, t, number, number[DIG_AT_U(e)], number[DIG_AT_CONTRAST(e)],
                           dig_soil_share(effect, dig), (const double(*)[DIG_CURVE_POINTS])plain,
                           curve);
    }
    if (fabs(delay_s) > 0.0) {
        const struct dig_curve_set *const set = soil->surface->set;
        dig_lateness_delay(&set->trajectory[t], set->tooth_m, dig->pace, delay_s, curve);
    }
}
