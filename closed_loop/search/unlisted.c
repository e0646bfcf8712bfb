#include "closed_loop/search/unlisted.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct dig_unlisted dig_unlisted_find(const struct dig_batch *const  batch,
                                      const struct dig_fitted *const plain)
{
    assert(batch != NULL && plain != NULL);
    const struct dig_regressed means = dig_regress(batch, plain, false);
    const struct dig_regressed digs  = dig_regress(batch, plain, true);
    struct dig_unlisted        found = { .log_evidence = means.log_evidence };
    // What decides is what it was; where only that finds anything, it is also what is said.
    const struct dig_regressed *const said = digs.functions > 0 ? &digs : &means;
    for (size_t i = 0; i < said->functions; i++) {
        const size_t used = strlen(found.depends_on);
        (void)snprintf(found.depends_on + used, sizeof found.depends_on - used, "%s%s",
                       i > 0 ? ", " : "", dig_basis_name(said->function[i]));
    }
    return found;
}

// What is left of the digs' curves, dig by dig and in the mean of each group.
struct left {
    double of[DIG_MEASURED_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double mean[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

static void fill_left(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                      struct left *const left)
{
    memset(left->mean, 0, sizeof left->mean);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        const size_t                     g   = batch->dig[i].group;
        double                           curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_fitted_curve(batch->soil, fitted, dig, curve);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                left->of[i][c][k] = dig->value[c][k] - dig->machine[c][k] - curve[c][k];
                left->mean[g][c][k] += left->of[i][c][k] / (double)batch->group[g].digs;
            }
        }
    }
}

// How much of a group's mean residual is more than its noise: 0 … 1.
static double credible(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                       const size_t g)
{
    const struct dig_group *const group = &batch->group[g];
    double                        model[DIG_FEATURES];
    double                        squares = 0.0;
    dig_fitted_whitened(batch, fitted, g, dig_batch_first(batch, g), model);
    for (size_t k = 0; k < group->features; k++) {
        squares += pow(group->mean[k] - model[k], 2.0);
    }
    const double expected =
        (double)group->features * (1.0 / (double)group->digs + fitted->noise[g]);
    return squares > expected ? 1.0 - expected / squares : 0.0;
}

// What is gained, in squares of the moment, when each dig of a group is predicted from so much of
// the others' residuals.
static double gain_of(const struct dig_batch *const batch, const struct left *const left,
                      const double by, const size_t g)
{
    const double n    = (double)batch->group[g].digs;
    double       gain = 0.0;
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t k = 0; batch->dig[i].group == g && k < DIG_CURVE_POINTS; k++) {
            const double own    = left->of[i][DIG_CHANNEL_MY_Nm][k];
            const double others = (n * left->mean[g][DIG_CHANNEL_MY_Nm][k] - own) / (n - 1.0);
            gain += own * own - pow(own - by * others, 2.0);
        }
    }
    return gain;
}

// Leaves a trajectory's mean residual where it is not worth taking off. Digs that differ from each
// other rather than from the table are made worse by it; of a dig alone the other trajectories
// tell.
static void choose_groups(const struct dig_batch *const batch, const struct left *const left,
                          double by[DIG_TRAJECTORY_MAX])
{
    bool all = true;
    for (size_t g = 0; g < batch->groups; g++) {
        if (batch->group[g].digs > 1 && !(gain_of(batch, left, by[g], g) > 0.0)) {
            by[g] = 0.0;
            all   = false;
        }
    }
    for (size_t g = 0; g < batch->groups; g++) {
        by[g] = all || batch->group[g].digs > 1 ? by[g] : 0.0;
    }
}

void dig_unlisted_correct(const struct dig_batch *const    batch,
                          const struct dig_fitted *const   fitted,
                          struct dig_model_unlisted *const share)
{
    struct left left;
    double      by[DIG_TRAJECTORY_MAX];
    memset(share->share, 0, sizeof share->share);
    fill_left(batch, fitted, &left);
    for (size_t g = 0; g < batch->groups; g++) {
        by[g] = credible(batch, fitted, g);
    }
    choose_groups(batch, &left, by);
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_measured *const first = dig_batch_first(batch, g);
        double                           curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_fitted_curve(batch->soil, fitted, first, curve);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double squares = 0.0;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                squares += curve[c][k] * curve[c][k] / DIG_CURVE_POINTS;
            }
            for (size_t k = 0; first->measured[c] && k < DIG_CURVE_POINTS; k++) {
                share->share[batch->group[g].trajectory][c][k] =
                    (float)(by[g] * left.mean[g][c][k] / fmax(sqrt(squares), 1e-12));
            }
        }
    }
}
