#include "closed_loop/model/hypothesis.h"

#include "closed_loop/model/soil_fit.h"
#include "closed_loop/numeric/dense.h"
#include "closed_loop/numeric/levenberg.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    RESIDUALS_MAX = (DIG_TRAJECTORY_MAX + DIG_MEASURED_MAX) * DIG_FEATURES,
    MEMORY        = RESIDUALS_MAX * (DIG_HYPOTHESIS_NUMBERS + 2),
    ROUNDS        = 2, // of fitting and of weighing anew
};

// What our DEM and LIGGGHTS differ by beyond the scatter of both, in variances of one dig:
// docs/numerics/closed_loop.md has the measurement.
static const double discrepancy = 0.05;

// A template is a likeness of what lies in the ground: this share of what it adds is its error.
// Rocks have all shapes: what one of triangles in another code adds to Fz differs by a third from
// what a sphere does (tests/offline_dem/test_ensemble.c).
static const double unlikeness = 0.2, unlikeness_of_rocks = 0.3;

static const double least_pace  = 0.05; // range of log(pace) that can show a dependence
static const size_t least_order = 4;    // digs that can show a trend: two that differ are none
static const double sigmas_90   = 1.645;
static const double beyond_grid = 1.4; // half the grid's width from its middle, times this

// The plain dig that effects are added to: the same for all digs of a trajectory.
struct plain {
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
};

// The same numbers are asked about again and again: what was worked out of the last ones is kept.
struct problem {
    const struct dig_whitened_digs *batch;
    const struct dig_soil          *soil;
    const struct dig_hypothesis    *hypothesis;
    size_t                          numbers;
    bool                            differs; // from dig to dig of a trajectory

    double       place[DIG_AXES]; // of which plain is
    struct plain plain[DIG_TRAJECTORY_MAX];

    double at[DIG_HYPOTHESIS_NUMBERS];             // of which these are
    double mean[DIG_TRAJECTORY_MAX][DIG_FEATURES]; // y of the model, over a group's digs
    double y[DIG_MEASURED_MAX][DIG_FEATURES];      // of each dig, where they differ

    double weighed_at[DIG_HYPOTHESIS_NUMBERS]; // of which these are
    double noise[DIG_TRAJECTORY_MAX];
    double weight[DIG_TRAJECTORY_MAX]; // of a group's mean: 1 / sigma
};

static bool differs_by_dig(const enum dig_effect_id effect)
{
    return effect == DIG_EFFECT_RATE_DEPENDENCE || effect == DIG_EFFECT_WEAR ||
           effect == DIG_EFFECT_COMPACTION;
}

bool dig_hypothesis_differs(const struct dig_hypothesis *const hypothesis)
{
    bool differs = false;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        differs = differs || differs_by_dig(hypothesis->effect[e]);
    }
    return differs;
}

bool dig_hypothesis_possible(const struct dig_whitened_digs *const batch,
                             const struct dig_soil *const soil, const enum dig_effect_id effect)
{
    for (size_t g = 0; g < batch->groups; g++) {
        if (!dig_soil_knows(soil, effect, batch->group[g].trajectory)) {
            return false;
        }
    }
    if (!differs_by_dig(effect)) {
        return true;
    }
    if (effect == DIG_EFFECT_WEAR && batch->digs < least_order) {
        return false;
    }
    double least = INFINITY;
    double most  = -INFINITY;
    for (size_t i = 0; i < batch->digs; i++) {
        const double share = dig_soil_share(effect, &batch->measured[batch->dig[i].measured]);
        least              = fmin(least, share);
        most               = fmax(most, share);
    }
    // Ground dug before differs from the table's even where all digs are of the same pass.
    return effect == DIG_EFFECT_COMPACTION
               ? most > 0.5
               : most - least > (effect == DIG_EFFECT_RATE_DEPENDENCE ? least_pace : 0.5);
}

static struct plain plain_of(const struct dig_soil *const soil, const size_t trajectory,
                             const double number[])
{
    struct plain plain;
    dig_response_surface_features(soil->surface, trajectory, number, plain.feature,
                                  plain.amplitude);
    return plain;
}

static void add_effects(const struct dig_soil *const soil, const struct plain *const plain,
                        const struct dig_hypothesis *const hypothesis, const double number[],
                        const struct dig_measured *const dig, double feature[DIG_FEATURES],
                        double *const noise)
{
    memcpy(feature, plain->feature, sizeof plain->feature);
    if (noise != NULL) {
        *noise = 0.0;
    }
    for (size_t e = 0; e < hypothesis->effects; e++) {
        const double share = dig_soil_share(hypothesis->effect[e], dig);
        dig_soil_add(soil, hypothesis->effect[e], (size_t)dig->trajectory, number,
                     number[DIG_AXES + e], share, plain->feature, plain->amplitude, feature, noise);
    }
}

void dig_hypothesis_features(const struct dig_soil *const       soil,
                             const struct dig_hypothesis *const hypothesis, const double number[],
                             const struct dig_measured *const dig, double feature[DIG_FEATURES],
                             double *const noise)
{
    const struct plain plain = plain_of(soil, (size_t)dig->trajectory, number);
    add_effects(soil, &plain, hypothesis, number, dig, feature, noise);
}

void dig_hypothesis_curve(const struct dig_soil *const       soil,
                          const struct dig_hypothesis *const hypothesis, const double number[],
                          const struct dig_measured *const dig,
                          double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const size_t t = (size_t)dig->trajectory;
    double       plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    dig_response_surface_curve(soil->surface, t, number, plain);
    memcpy(curve, plain, sizeof plain);
    for (size_t e = 0; e < hypothesis->effects; e++) {
        const double share = dig_soil_share(hypothesis->effect[e], dig);
        dig_soil_add_curve(soil, hypothesis->effect[e], t, number, number[DIG_AXES + e], share,
                           (const double(*)[DIG_CURVE_POINTS])plain, curve);
    }
}

static bool is_same(const size_t n, const double a[], const double b[])
{
    bool same = true;
    for (size_t i = 0; i < n; i++) {
        same = same && fabs(a[i] - b[i]) <= 0.0;
    }
    return same;
}

// NaN is never the same.
static void forget(struct problem *const p)
{
    for (size_t i = 0; i < DIG_HYPOTHESIS_NUMBERS; i++) {
        p->at[i]         = (double)NAN;
        p->weighed_at[i] = (double)NAN;
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        p->place[a] = (double)NAN;
    }
}

static const struct plain *plain_at(struct problem *const p, const size_t group, const double x[])
{
    if (!is_same(DIG_AXES, p->place, x)) {
        memcpy(p->place, x, sizeof p->place);
        for (size_t g = 0; g < p->batch->groups; g++) {
            p->plain[g] = plain_of(p->soil, p->batch->group[g].trajectory, x);
        }
    }
    return &p->plain[group];
}

static void model_dig(struct problem *const p, const size_t group,
                      const struct dig_measured *const dig, const double x[], double y[])
{
    double feature[DIG_FEATURES];
    add_effects(p->soil, plain_at(p, group, x), p->hypothesis, x, dig, feature, NULL);
    dig_whitened_digs_whiten(&p->batch->group[group], feature, y);
}

static void model_digs(struct problem *const p, const size_t group, const double x[])
{
    const struct dig_whitened_digs_group *const of = &p->batch->group[group];
    memset(p->mean[group], 0, sizeof p->mean[group]);
    for (size_t i = 0; i < p->batch->digs; i++) {
        if (p->batch->dig[i].group == group) {
            model_dig(p, group, &p->batch->measured[p->batch->dig[i].measured], x, p->y[i]);
            for (size_t k = 0; k < of->features; k++) {
                p->mean[group][k] += p->y[i][k] / (double)of->digs;
            }
        }
    }
}

// y of the model at x: where all digs of a trajectory are alike only their mean counts.
static void model_at(struct problem *const p, const double x[])
{
    if (is_same(p->numbers, p->at, x)) {
        return;
    }
    memcpy(p->at, x, p->numbers * sizeof x[0]);
    for (size_t g = 0; g < p->batch->groups; g++) {
        if (p->differs) {
            model_digs(p, g, x);
        } else {
            model_dig(p, g, dig_whitened_digs_first(p->batch, g), x, p->mean[g]);
        }
    }
}

static void residual(void *const context, const double x[], double r[])
{
    struct problem *const p = context;
    size_t                n = 0;
    model_at(p, x);
    for (size_t g = 0; g < p->batch->groups; g++) {
        const struct dig_whitened_digs_group *const group = &p->batch->group[g];
        for (size_t k = 0; k < group->features; k++) {
            r[n++] = (group->mean[k] - p->mean[g][k]) * p->weight[g];
        }
        for (size_t i = 0; p->differs && i < p->batch->digs; i++) {
            for (size_t k = 0; p->batch->dig[i].group == g && k < group->features; k++) {
                r[n++] = p->batch->dig[i].y[k] - group->mean[k] - (p->y[i][k] - p->mean[g][k]);
            }
        }
    }
}

// How much larger the effects make a dig (with: its y) than it would be plain, in the batch's units
// squared.
static double effect_squares(const struct dig_whitened_digs_group *const group, const double with[],
                             const double plain[])
{
    double sum = 0.0;
    for (size_t k = 0; k < group->features; k++) {
        sum += (with[k] - plain[k]) * (with[k] - plain[k]);
    }
    return sum;
}

// The size of a plain dig of the gravel over that of the group's digs, squared: what is known of
// the plain digs' scatter counts for as much less beside digs that are larger.
static double size2_of_plain(struct problem *const p, const size_t g, const double x[],
                             double *const factor)
{
    const struct dig_whitened_digs_group *const group     = &p->batch->group[g];
    const double *const                         amplitude = plain_at(p, g, x)->amplitude;
    *factor = dig_scatter_factor(p->batch->scatter, group->trajectory,
                                 dig_soil_strength(p->soil->surface, x, amplitude));
    return pow(amplitude[DIG_CHANNEL_MY_Nm] / group->amplitude[DIG_CHANNEL_MY_Nm], 2.0);
}

static double unlikeness_of(const struct dig_hypothesis *const hypothesis)
{
    double most = unlikeness;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        most = hypothesis->effect[e] == DIG_EFFECT_OBSTACLE ? unlikeness_of_rocks : most;
    }
    return most;
}

// What the effects bring along for one dig of a group: of templates, and what they may be unlike.
static double noise_of_dig(struct problem *const p, const size_t g,
                           const struct dig_measured *const dig, const double x[],
                           const double with[], const double plain[], const double size2)
{
    double       feature[DIG_FEATURES];
    double       of_templates;
    const double unlike = unlikeness_of(p->hypothesis);
    add_effects(p->soil, plain_at(p, g, x), p->hypothesis, x, dig, feature, &of_templates);
    return size2 * of_templates + unlike * unlike *
                                      effect_squares(&p->batch->group[g], with, plain) /
                                      (double)p->batch->group[g].features;
}

// The same on average over a group's digs, where they differ.
static double noise_of_effects(struct problem *const p, const size_t g, const double x[],
                               const double size2)
{
    const struct dig_whitened_digs_group *const group = &p->batch->group[g];
    double                                      plain[DIG_FEATURES];
    double                                      sum = 0.0;
    if (p->hypothesis->effects == 0) {
        return 0.0;
    }
    model_at(p, x);
    dig_whitened_digs_whiten(group, plain_at(p, g, x)->feature, plain);
    if (!p->differs) {
        return noise_of_dig(p, g, dig_whitened_digs_first(p->batch, g), x, p->mean[g], plain,
                            size2);
    }
    for (size_t i = 0; i < p->batch->digs; i++) {
        if (p->batch->dig[i].group == g) {
            const struct dig_measured *const dig = &p->batch->measured[p->batch->dig[i].measured];
            sum += noise_of_dig(p, g, dig, x, p->y[i], plain, size2) / (double)group->digs;
        }
    }
    return sum;
}

// v of each group at x. Digs that an effect makes differ share what it brings along on average.
static void weigh(struct problem *const p, const double x[], double noise[])
{
    const bool again = is_same(p->numbers, p->weighed_at, x);
    for (size_t g = 0; g < p->batch->groups && !again; g++) {
        const struct dig_whitened_digs_group *const group = &p->batch->group[g];
        double                                      factor;
        const double                                size2 = size2_of_plain(p, g, x, &factor);
        p->noise[g] =
            discrepancy + noise_of_effects(p, g, x, size2) + group->repeats +
            size2 * factor * dig_response_surface_noise(p->soil->surface, group->trajectory, x);
        p->weight[g] = 1.0 / sqrt(1.0 / (double)group->digs + p->noise[g]);
    }
    memcpy(p->weighed_at, x, p->numbers * sizeof x[0]);
    memcpy(noise, p->noise, p->batch->groups * sizeof noise[0]);
}

static void set_bounds(const struct problem *const p, struct dig_levenberg *const l)
{
    for (size_t a = 0; a < DIG_AXES; a++) {
        const bool   is_free = p->soil->surface->set->axis_count[a] > 1;
        const double reach   = p->hypothesis->outside ? 2.0 : 1.0;
        l->low[a]            = is_free ? -reach : 0.0;
        l->high[a] = is_free ? fmin(reach, p->hypothesis->outside ? beyond_grid : 1.0) : 0.0;
    }
    for (size_t e = 0; e < p->hypothesis->effects; e++) {
        l->low[DIG_AXES + e]  = p->soil->low[p->hypothesis->effect[e]];
        l->high[DIG_AXES + e] = p->soil->high[p->hypothesis->effect[e]];
    }
}

static size_t count_residuals(const struct problem *const p)
{
    size_t n = 0;
    for (size_t g = 0; g < p->batch->groups; g++) {
        n += p->batch->group[g].features * (1 + (p->differs ? p->batch->group[g].digs : 0));
    }
    return n;
}

// The misfit of what was fitted; digs that a hypothesis takes for alike scatter about their mean.
static void judge(const struct problem *const p, const double squares, struct dig_fitted *const f)
{
    f->squares      = squares;
    f->misfit       = 0.0;
    f->observations = 0;
    for (size_t g = 0; g < p->batch->groups; g++) {
        const struct dig_whitened_digs_group *const group = &p->batch->group[g];
        f->squares += p->differs ? 0.0 : group->about;
        f->misfit -= 2.0 * (double)group->features * log(p->weight[g]);
        f->observations += group->features * group->digs;
    }
    f->misfit += f->squares;
}

static void set_interval(const struct dig_levenberg *const l, const double normal[],
                         struct dig_fitted *const f)
{
    const size_t n = l->unknowns;
    double       lower[DIG_LEVENBERG_UNKNOWNS * DIG_LEVENBERG_UNKNOWNS];
    f->free = 0;
    for (size_t j = 0; j < n; j++) {
        f->free += l->high[j] > l->low[j] ? 1 : 0;
        for (size_t i = 0; i < n; i++) {
            // A prior as wide as the bounds: a direction that nothing tells about stays finite.
            const double width = fmax(l->high[j] - l->low[j], 1e-6);
            lower[j * n + i]   = normal[j * n + i] + (i == j ? 3.0 / (width * width) : 0.0);
        }
    }
    const bool known = dig_cholesky(n, lower) == DIG_OK;
    for (size_t j = 0; j < n; j++) {
        double column[DIG_LEVENBERG_UNKNOWNS] = { 0.0 };
        column[j]                             = 1.0;
        dig_lower_solve(n, lower, column);
        double variance = 0.0;
        for (size_t i = 0; i < n; i++) {
            variance += column[i] * column[i];
        }
        const double half = known ? sigmas_90 * sqrt(variance) : l->high[j] - l->low[j];
        f->low[j]         = fmax(f->number[j] - half, l->low[j]);
        f->high[j]        = fmin(f->number[j] + half, l->high[j]);
    }
}

// The misfit at x, each number weighed as x says.
static double misfit_at(struct problem *const p, const struct dig_levenberg *const l,
                        const double x[], struct dig_fitted *const f)
{
    double *const r       = l->memory;
    double        squares = 0.0;
    weigh(p, x, f->noise);
    residual(p, x, r);
    for (size_t i = 0; i < l->residuals; i++) {
        squares += r[i] * r[i];
    }
    memcpy(f->number, x, l->unknowns * sizeof f->number[0]);
    judge(p, squares, f);
    return f->misfit;
}

// Least squares with weights that follow: the best of all rounds, and of the start, is kept.
static void fit_from(struct problem *const p, struct dig_levenberg *const l, const double start[],
                     const bool with_interval, struct dig_fitted *const f)
{
    double            x[DIG_HYPOTHESIS_NUMBERS]                               = { 0.0 };
    double            normal[DIG_LEVENBERG_UNKNOWNS * DIG_LEVENBERG_UNKNOWNS] = { 0.0 };
    struct dig_fitted tried                                                   = *f;
    for (size_t j = 0; j < l->unknowns; j++) {
        x[j] = fmin(fmax(start[j], l->low[j]), l->high[j]);
    }
    (void)misfit_at(p, l, x, f);
    for (int round = 0; round < ROUNDS; round++) {
        double squares = 0.0;
        weigh(p, x, tried.noise);
        dig_levenberg_run(l, x, &squares, with_interval && round + 1 == ROUNDS ? normal : NULL);
        if (misfit_at(p, l, x, &tried) < f->misfit) {
            *f = tried;
        }
    }
    if (with_interval) {
        set_interval(l, normal, f);
    }
}

void dig_hypothesis_fit(const struct dig_whitened_digs *const batch,
                        const struct dig_soil *const          soil,
                        const struct dig_hypothesis *const hypothesis, const double start[],
                        const enum dig_fit_care care, struct dig_fitted *const fitted)
{
    static const double places[][DIG_AXES] = {
        { -0.6, -0.6, 0.0 }, { 0.6, -0.6, 0.0 }, { -0.6, 0.6, 0.0 }, { 0.6, 0.6, 0.0 }
    };
    const size_t   more = care == DIG_FIT_THOROUGH ? sizeof places / sizeof places[0] : 0;
    double         memory[MEMORY];
    struct problem p;
    p.batch      = batch;
    p.soil       = soil;
    p.hypothesis = hypothesis;
    p.numbers    = DIG_AXES + hypothesis->effects;
    p.differs    = dig_hypothesis_differs(hypothesis);
    forget(&p);
    struct dig_levenberg l = { .unknowns   = p.numbers,
                               .residuals  = count_residuals(&p),
                               .step       = 1e-4,
                               .iterations = 25,
                               .residual   = residual,
                               .context    = &p,
                               .memory     = memory };
    set_bounds(&p, &l);
    struct dig_fitted best = { .misfit = INFINITY };
    for (size_t s = 0; s <= more; s++) {
        double from[DIG_HYPOTHESIS_NUMBERS];
        memcpy(from, start, l.unknowns * sizeof from[0]);
        if (s > 0) {
            memcpy(from, places[s - 1], sizeof places[0]);
        }
        struct dig_fitted tried = { .hypothesis = *hypothesis };
        fit_from(&p, &l, from, care != DIG_FIT_BARE, &tried);
        if (tried.misfit < best.misfit) {
            best = tried;
        }
    }
    *fitted = best;
}

double dig_hypothesis_squares(const struct dig_whitened_digs *const batch,
                              const struct dig_soil *const          soil,
                              const struct dig_fitted *const fitted, const double noise[])
{
    double sum = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_whitened_digs_group *const group              = &batch->group[g];
        double                                      mean[DIG_FEATURES] = { 0.0 };
        for (size_t i = 0; i < batch->digs; i++) {
            double feature[DIG_FEATURES];
            double y[DIG_FEATURES];
            if (batch->dig[i].group != g) {
                continue;
            }
            dig_hypothesis_features(soil, &fitted->hypothesis, fitted->number,
                                    &batch->measured[batch->dig[i].measured], feature, NULL);
            dig_whitened_digs_whiten(group, feature, y);
            for (size_t k = 0; k < group->features; k++) {
                mean[k] += y[k] / (double)group->digs;
            }
        }
        for (size_t k = 0; k < group->features; k++) {
            sum += (group->mean[k] - mean[k]) * (group->mean[k] - mean[k]) /
                   (1.0 / (double)group->digs + noise[g]);
        }
    }
    return sum;
}
