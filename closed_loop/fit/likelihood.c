#include "closed_loop/fit/likelihood.h"

#include "closed_loop/model/soil_fit.h"
#include "closed_loop/numeric/dense.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// By how much another DEM code's plain dig differs from ours beyond the scatter of both, and what
// lies in the ground from a template's: shares of it, 1 sigma.
static const double of_codes     = 0.01;
static const double of_templates = 0.1; // but where the effect says otherwise

// What of that changes from bin to bin, in variances of one dig.
static const double rough = 0.01;

// What has no name changes a plain dig slowly along it and, by this share of that, from bin to bin.
static const double quick = 0.5;

static bool is_same(const size_t n, const double a[], const double b[])
{
    bool same = true;
    for (size_t i = 0; i < n; i++) {
        same = same && fabs(a[i] - b[i]) <= 0.0;
    }
    return same;
}

// NaN is never the same.
void dig_likelihood_init(struct dig_likelihood *const l, const struct dig_batch *const batch,
                         const struct dig_hypothesis *const hypothesis)
{
    assert(l != NULL && batch != NULL && hypothesis != NULL);
    l->batch      = batch;
    l->hypothesis = hypothesis;
    l->numbers    = DIG_AXES + 2 * hypothesis->effects;
    l->differs    = dig_hypothesis_differs(hypothesis);
    l->steps      = batch->steps != NULL ? batch->steps->steps : 0;
    l->residuals  = l->steps;
    l->means      = 0;
    for (size_t g = 0; g < batch->groups; g++) {
        l->means += batch->group[g].features;
        l->residuals += batch->group[g].features * (1 + (l->differs ? batch->group[g].digs : 0));
    }
    for (size_t i = 0; i < DIG_HYPOTHESIS_NUMBERS; i++) {
        l->at[i]         = (double)NAN;
        l->weighed_at[i] = (double)NAN;
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        l->place[a] = (double)NAN;
    }
}

static const struct dig_plain *plain_at(struct dig_likelihood *const l, const size_t group,
                                        const double x[])
{
    if (!is_same(DIG_AXES, l->place, x)) {
        memcpy(l->place, x, sizeof l->place);
        for (size_t g = 0; g < l->batch->groups; g++) {
            l->plain[g] = dig_plain_of(l->batch->soil, l->batch->group[g].trajectory, x);
        }
    }
    return &l->plain[group];
}

static void model_dig(struct dig_likelihood *const l, const size_t group,
                      const struct dig_measured *const dig, const double x[], double y[])
{
    double feature[DIG_FEATURES];
    dig_forward_add(l->batch->soil, plain_at(l, group, x), l->hypothesis, x, dig, feature, NULL);
    dig_batch_whiten(&l->batch->group[group], feature, y);
}

static void model_digs(struct dig_likelihood *const l, const size_t group, const double x[])
{
    const struct dig_group *const of = &l->batch->group[group];
    memset(l->mean[group], 0, sizeof l->mean[group]);
    for (size_t i = 0; i < l->batch->digs; i++) {
        if (l->batch->dig[i].group == group) {
            model_dig(l, group, &l->batch->measured[l->batch->dig[i].measured], x, l->y[i]);
            for (size_t k = 0; k < of->features; k++) {
                l->mean[group][k] += l->y[i][k] / (double)of->digs;
            }
        }
    }
}

// y of the model at x: where all digs of a trajectory are alike only their mean counts.
static void model_at(struct dig_likelihood *const l, const double x[])
{
    if (is_same(l->numbers, l->at, x)) {
        return;
    }
    memcpy(l->at, x, l->numbers * sizeof x[0]);
    for (size_t g = 0; g < l->batch->groups; g++) {
        if (l->differs) {
            model_digs(l, g, x);
        } else {
            model_dig(l, g, dig_batch_first(l->batch, g), x, l->mean[g]);
        }
    }
}

// Fits z to the whitened residuals of the means, takes off what it explains, and leaves in z how
// far it is from the middle. All steps side by side: no sum waits for another.
DIG_VECTORS static void take_off_steps(const struct dig_likelihood *const l, double mean[],
                                       double z[])
{
    const size_t  steps = l->steps;
    const double *left  = mean;
    if (steps == 0) {
        return;
    }
    memcpy(z, l->batch->steps->middle, steps * sizeof z[0]);
    for (size_t g = 0; g < l->batch->groups; g++) {
        for (size_t f = 0; f < l->batch->group[g].features; f++, left++) {
            for (size_t k = 0; k < steps; k++) {
                z[k] += l->by_feature[g][f][k] * *left;
            }
        }
    }
    dig_cholesky_solve(steps, l->step_lower, z);
    for (size_t k = 0; k < steps; k++) {
        double *r = mean;
        for (size_t g = 0; g < l->batch->groups; r += l->batch->group[g].features, g++) {
            for (size_t f = 0; f < l->batch->group[g].features; f++) {
                r[f] -= z[k] * l->step[k][g][f];
            }
        }
        z[k] -= l->batch->steps->middle[k];
    }
}

// Whitened residuals of the means.
static void residual_of_means(const struct dig_likelihood *const l, double r[])
{
    for (size_t g = 0; g < l->batch->groups; r += l->batch->group[g].features, g++) {
        const struct dig_group *const group = &l->batch->group[g];
        for (size_t k = 0; k < group->features; k++) {
            r[k] = group->mean[k] - l->mean[g][k];
        }
        (void)dig_common_error_squares(group, &l->error[g], r);
    }
}

void dig_likelihood_residual(void *const context, const double x[], double r[])
{
    struct dig_likelihood *const l = context;
    model_at(l, x);
    residual_of_means(l, r);
    take_off_steps(l, r, r + l->residuals - l->steps);
    size_t n = l->means;
    for (size_t i = 0; l->differs && i < l->batch->digs; i++) {
        const size_t                  g     = l->batch->dig[i].group;
        const struct dig_group *const group = &l->batch->group[g];
        for (size_t k = 0; k < group->features; k++) {
            r[n++] = l->batch->dig[i].y[k] - group->mean[k] - (l->y[i][k] - l->mean[g][k]);
        }
    }
}

// The size of a plain dig of the gravel over that of the group's digs, squared: what is known of
// the plain digs' scatter counts for as much less beside digs that are larger.
static double size2_of_plain(struct dig_likelihood *const l, const size_t g, const double x[],
                             double *const factor)
{
    const struct dig_group *const group     = &l->batch->group[g];
    const double *const           amplitude = plain_at(l, g, x)->amplitude;
    *factor = dig_scatter_factor(l->batch->scatter, group->trajectory,
                                 dig_soil_strength(l->batch->soil->surface, x, amplitude));
    return pow(amplitude[DIG_CHANNEL_MY_Nm] / group->amplitude[DIG_CHANNEL_MY_Nm], 2.0);
}

static double likeness_of(const enum dig_effect_id effect)
{
    return fmax(of_templates, dig_effect_of(effect)->likeness);
}

// How large what one of the effects adds to a group is, squared, in plain digs.
static double size2_of_effect(const struct dig_likelihood *const l, const size_t g,
                              const struct dig_plain *const at, const double x[], const size_t e)
{
    const struct dig_hypothesis alone = { .effects = 1, .effect = { l->hypothesis->effect[e] } };
    double                      number[DIG_HYPOTHESIS_NUMBERS];
    double                      added[DIG_FEATURES];
    double                      sum = 0.0;
    memcpy(number, x, DIG_AXES * sizeof number[0]);
    number[DIG_AT_U(0)]        = x[DIG_AT_U(e)];
    number[DIG_AT_CONTRAST(0)] = x[DIG_AT_CONTRAST(e)];
    (void)dig_forward_added(l->batch, g, at, &alone, number, added);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        sum += pow(added[f] / at->amplitude[f / DIG_FEATURE_BINS], 2.0);
    }
    return sum;
}

// Of all effects together each has a say by its size: one that adds nothing must not make room for
// what the others leave.
static double likeness_of_all(const struct dig_likelihood *const l, const size_t g,
                              const struct dig_plain *const at, const double x[])
{
    const struct dig_hypothesis *const h = l->hypothesis;
    const double one  = h->effects > 0 ? likeness_of(h->effect[0]) : of_templates;
    bool         same = true;
    double       sum  = 0.0;
    double       all  = 0.0;
    for (size_t e = 1; e < h->effects; e++) {
        same = same && fabs(likeness_of(h->effect[e]) - one) <= 0.0;
    }
    for (size_t e = 0; e < h->effects && !same; e++) {
        const double size2 = size2_of_effect(l, g, at, x, e);
        sum += pow(likeness_of(h->effect[e]), 2.0) * size2;
        all += size2;
    }
    return all > 0.0 ? sqrt(sum / all) : one;
}

// Adds D' C^-1 D of a group to the lower triangle.
DIG_VECTORS static void add_steps(const size_t steps, const size_t features,
                                  const double step[][DIG_STEPS_MAX], double lower[])
{
    for (size_t f = 0; f < features; f++) {
        for (size_t k = 0; k < steps; k++) {
            for (size_t j = 0; j <= k; j++) {
                lower[k * steps + j] += step[f][k] * step[f][j];
            }
        }
    }
}

static void weigh_steps(struct dig_likelihood *const l)
{
    const struct dig_steps *const steps = l->batch->steps;
    memset(l->step_lower, 0, l->steps * l->steps * sizeof l->step_lower[0]);
    for (size_t k = 0; k < l->steps; k++) {
        l->step_lower[k * l->steps + k] = 1.0;
    }
    for (size_t g = 0; g < l->batch->groups && l->steps > 0; g++) {
        const struct dig_group *const group = &l->batch->group[g];
        for (size_t k = 0; k < l->steps; k++) {
            double *const of = l->step[k][g];
            dig_batch_whiten(group, steps->of[k][group->trajectory], of);
            (void)dig_common_error_squares(group, &l->error[g], of);
            for (size_t f = 0; f < group->features; f++) {
                l->by_feature[g][f][k] = of[f];
            }
        }
        add_steps(l->steps, group->features, (const double(*)[DIG_STEPS_MAX])l->by_feature[g],
                  l->step_lower);
    }
    dig_cholesky_sure(l->steps, l->step_lower); // by the 1 on its diagonal
    l->step_log_det = dig_lower_log_det(l->steps, l->step_lower);
}

void dig_likelihood_weigh(struct dig_likelihood *const l, const double x[])
{
    if (is_same(l->numbers, l->weighed_at, x)) {
        return;
    }
    memcpy(l->weighed_at, x, l->numbers * sizeof x[0]);
    const double unlisted = l->hypothesis->unlisted;
    for (size_t g = 0; g < l->batch->groups; g++) {
        const struct dig_group *const  group = &l->batch->group[g];
        struct dig_common_error *const error = &l->error[g];
        double                         factor;
        const double                   size2 = size2_of_plain(l, g, x, &factor);
        const struct dig_plain *const  at    = plain_at(l, g, x);
        double                         added[DIG_FEATURES];
        const double                   unlike = likeness_of_all(l, g, at, x);
        const double templates = dig_forward_added(l->batch, g, at, l->hypothesis, x, added);
        error->even            = rough + group->repeats + group->added_noise + size2 * templates +
                      size2 * factor *
                          dig_response_surface_noise(l->batch->soil->surface, group->trajectory, x);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            error->size[0][f] = hypot(of_codes, unlisted) * at->feature[f];
            error->size[1][f] = unlike * added[f];
            error->size[2][f] = quick * unlisted * at->feature[f];
            error->size[3][f] = group->added_error[f];
        }
        dig_shifts_fill(l->batch, g, l->hypothesis, x, at, added, &error->shift);
        dig_common_error_build(group, error);
    }
    weigh_steps(l);
}

// Digs that a hypothesis takes for alike scatter about their mean.
double dig_likelihood_misfit(const struct dig_likelihood *const l, const double residual[],
                             double *const squares)
{
    double logs = l->step_log_det;
    *squares    = 0.0;
    for (size_t i = 0; i < l->residuals; i++) {
        *squares += residual[i] * residual[i];
    }
    for (size_t g = 0; g < l->batch->groups; g++) {
        *squares += l->differs ? 0.0 : l->batch->group[g].about;
        logs += l->error[g].log_det;
    }
    return dig_batch_misfit(l->batch, *squares) + logs;
}
