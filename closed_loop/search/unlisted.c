#include "closed_loop/search/unlisted.h"

#include "closed_loop/search/unlisted_regression.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct dig_unlisted dig_unlisted_find(const struct dig_whitened_digs *const batch,
                                      const struct dig_fitted *const        plain)
{
    assert(batch != NULL && plain != NULL);
    const struct dig_regressed means = dig_regress(batch, plain, false);
    const struct dig_regressed digs  = dig_regress(batch, plain, true);
    struct dig_unlisted        found = { .log_evidence = means.log_evidence,
                                         .functions    = means.functions };
    // What decides is what it was; where only that finds anything, it is also what is said.
    const struct dig_regressed *const said = digs.functions > 0 ? &digs : &means;
    for (size_t i = 0; i < said->functions; i++) {
        const size_t used = strlen(found.depends_on);
        (void)snprintf(found.depends_on + used, sizeof found.depends_on - used, "%s%s",
                       i > 0 ? ", " : "", dig_basis_name(said->function[i]));
    }
    return found;
}

// How much of a group's mean residual is more than its noise: 0 … 1.
static double credible(const struct dig_whitened_digs *const batch,
                       const struct dig_fitted *const fitted, const size_t g)
{
    const struct dig_whitened_digs_group *const group = &batch->group[g];
    double                                      model[DIG_FEATURES];
    double                                      squares = 0.0;
    dig_fitted_whitened(batch, fitted, g, dig_whitened_digs_first(batch, g), model);
    for (size_t k = 0; k < group->features; k++) {
        squares += pow(group->mean[k] - model[k], 2.0);
    }
    const double expected =
        (double)group->features * (1.0 / (double)group->digs + fitted->noise[g]);
    return squares > expected ? 1.0 - expected / squares : 0.0;
}

// What is left of a dig's curves.
static void left_of(const struct dig_whitened_digs *const batch,
                    const struct dig_fitted *const fitted, const size_t i,
                    double left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
    double                           curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    dig_fitted_curve(batch->soil, fitted, dig, curve);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            left[c][k] = dig->value[c][k] - dig->machine[c][k] - curve[c][k];
        }
    }
}

// The mean of what is left of a group's digs.
static void mean_left(const struct dig_whitened_digs *const batch,
                      const struct dig_fitted *const fitted, const size_t g,
                      double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    memset(mean, 0, DIG_FORCE_CHANNELS * sizeof mean[0]);
    for (size_t i = 0; i < batch->digs; i++) {
        double left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        if (batch->dig[i].group != g) {
            continue;
        }
        left_of(batch, fitted, i, left);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                mean[c][k] += left[c][k] / (double)batch->group[g].digs;
            }
        }
    }
}

// What is gained, in squares of the moment, when each dig of a group is predicted from the others'
// residuals.
static double gain_of(const struct dig_whitened_digs *const batch,
                      const struct dig_fitted *const fitted, const size_t g)
{
    const double by = credible(batch, fitted, g);
    const double n  = (double)batch->group[g].digs;
    double       mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double       gain = 0.0;
    mean_left(batch, fitted, g, mean);
    for (size_t i = 0; n > 1.0 && i < batch->digs; i++) {
        double left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        if (batch->dig[i].group != g) {
            continue;
        }
        left_of(batch, fitted, i, left);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double own    = left[DIG_CHANNEL_MY_Nm][k];
            const double others = (n * mean[DIG_CHANNEL_MY_Nm][k] - own) / (n - 1.0);
            gain += own * own - pow(own - by * others, 2.0);
        }
    }
    return gain;
}

// Whether a trajectory's mean residual is worth taking off. Digs that differ from each other rather
// than from the table are made worse by it; of a dig alone the other trajectories tell.
static void choose_groups(const struct dig_whitened_digs *const batch,
                          const struct dig_fitted *const fitted, bool helps[DIG_TRAJECTORY_MAX])
{
    bool all = true;
    for (size_t g = 0; g < batch->groups; g++) {
        helps[g] = batch->group[g].digs < 2 || gain_of(batch, fitted, g) > 0.0;
        all      = all && helps[g];
    }
    for (size_t g = 0; g < batch->groups; g++) {
        helps[g] = helps[g] && (all || batch->group[g].digs > 1);
    }
}

void dig_unlisted_correct(const struct dig_whitened_digs *const batch,
                          const struct dig_fitted *const        fitted,
                          struct dig_model_unlisted *const      share)
{
    bool helps[DIG_TRAJECTORY_MAX] = { false };
    memset(share->share, 0, sizeof share->share);
    choose_groups(batch, fitted, helps);
    for (size_t g = 0; g < batch->groups; g++) {
        const size_t t  = batch->group[g].trajectory;
        const double by = helps[g] ? credible(batch, fitted, g) : 0.0;
        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double       mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        mean_left(batch, fitted, g, mean);
        dig_fitted_curve(batch->soil, fitted, dig_whitened_digs_first(batch, g), curve);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double squares = 0.0;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                squares += curve[c][k] * curve[c][k] / DIG_CURVE_POINTS;
            }
            for (size_t k = 0;
                 dig_whitened_digs_first(batch, g)->measured[c] && k < DIG_CURVE_POINTS; k++) {
                share->share[t][c][k] = (float)(by * mean[c][k] / fmax(sqrt(squares), 1e-12));
            }
        }
    }
}
